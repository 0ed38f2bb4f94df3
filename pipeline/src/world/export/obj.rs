//! OBJ models with a library of materials. Numbers are the shortest that have the same bits
//! when they are read.

use std::fmt::Write as _;
use std::sync::Arc;

use gnomon_raster::AddressMode;

use super::{Exporting, pictures};
use crate::world::material::Material;
use crate::world::texture::{CornerCoordinates, Picture, SurfaceTexture};

/// Writing to a String cannot fail.
macro_rules! line {
    ($text:expr, $($rest:tt)*) => {
        let _ = writeln!($text, $($rest)*);
    };
}

/// The name of part `k` of an object.
fn name(object: &Exporting<'_>, k: usize) -> String {
    format!("m{}-{k}", object.number)
}

/// A name without what ends lines or, being last in one, joins the next.
fn word(name: &str) -> String {
    super::tables::word(name).replace('\\', "_")
}

/// The library of all materials.
pub(super) fn materials(
    objects: &[Exporting<'_>],
    scene: &str,
    pictures: &[Arc<Picture>],
) -> String {
    let mut text = String::new();
    for object in objects {
        for (k, part) in object.object.painted().iter().enumerate() {
            line!(text, "newmtl {}", name(object, k));
            write_material(&mut text, &part.material);
            if let Some(texture) = &part.texture {
                write_map(&mut text, texture, scene, pictures);
            }
        }
    }
    text
}

fn write_material(text: &mut String, m: &Material) {
    let [r, g, b] = m.albedo;
    line!(text, "Kd {r} {g} {b}");
    let [r, g, b] = m.specular;
    line!(text, "Ks {r} {g} {b}");
    line!(text, "Ns {}\nillum 2", m.shininess);
}

fn write_map(text: &mut String, texture: &SurfaceTexture, scene: &str, pictures: &[Arc<Picture>]) {
    let Some(k) = pictures::number(pictures, &texture.picture) else {
        return;
    };
    let clamped = texture.sampler.address[0] == AddressMode::ClampToEdge;
    let option = if clamped { "-clamp on " } else { "" };
    let file = pictures::file(scene, k, &texture.picture);
    line!(text, "map_Kd {option}{file}");
}

/// An object, whose materials are in `library`.
pub(super) fn model(object: &Exporting<'_>, library: &str) -> String {
    let mesh = &object.object.mesh;
    let mut text = format!("mtllib {library}\n");
    line!(text, "o {}", word(&object.object.name));
    for [x, y, z] in mesh.positions() {
        line!(text, "v {x} {y} {z}");
    }
    for (k, part) in object.object.painted().iter().enumerate() {
        line!(text, "usemtl {}", name(object, k));
        for &triangle in &part.triangles {
            let [a, b, c] = mesh.triangles()[triangle as usize].map(|i| i + 1);
            if part.texture.is_some() {
                write_texels(&mut text, object.object.coordinates_of(triangle));
                line!(text, "f {a}/-3 {b}/-2 {c}/-1");
            } else {
                line!(text, "f {a} {b} {c}");
            }
        }
    }
    text
}

/// Corners of a triangle; v counts from below in OBJ.
fn write_texels(text: &mut String, corners: CornerCoordinates) {
    for [u, v] in corners {
        line!(text, "vt {u} {}", 1.0 - f64::from(v));
    }
}
