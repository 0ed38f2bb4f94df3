//! Scenes as files for other programs: glTF, OBJ with a scene file, and a description of
//! camera, lights and matrices.
//!
//! OBJ and the scene file that names it are read back as the same scene: positions are
//! written so that they have the same bits again, camera and lights in f64. glTF holds f32
//! positions to the bit too, and lights that it has no words for as points.

mod description;
mod gltf;
mod obj;
mod pictures;
mod tables;

use crate::world::light::LightShape;
use crate::world::mesh::{Mesh, Shading};
use crate::world::scene::{Object, Scene};
use crate::world::warning::SceneWarning;

/// A format to export to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// `NAME.glb`.
    Gltf,
    /// `NAME.toml`, `NAME.mtl`, an OBJ file for each object, and pictures on them.
    Obj,
}

/// Files of a scene, and what they do not hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exported {
    /// Names and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// Codes `lights-as-points`, `without-backdrop`, `texture-samplers`.
    pub warnings: Vec<SceneWarning>,
}

/// The files of `scene`, seen in a picture of `size`; `name` is what they are called. A
/// description `NAME.json` is always among them.
pub fn export(scene: &Scene, size: [u32; 2], name: &str, formats: &[ExportFormat]) -> Exported {
    let mut out = Exported::default();
    let objects = objects(scene, name);
    let with_obj = formats.contains(&ExportFormat::Obj);
    let description = description::describe(scene, size, &objects, with_obj);
    out.add(format!("{name}.json"), pretty(&description));
    if with_obj {
        let pictures = pictures::pictures(&objects);
        out.add(
            format!("{name}.mtl"),
            obj::materials(&objects, name, &pictures),
        );
        for (k, picture) in pictures.iter().enumerate() {
            let file = pictures::file(name, k, picture);
            out.files.push((file, picture.encoded().to_vec()));
        }
        out.warnings.extend(other_samplers(&objects));
        for object in &objects {
            let text = obj::model(object, &format!("{name}.mtl"));
            out.add(object.file.clone(), text);
        }
        out.add(
            format!("{name}.toml"),
            tables::scene_file(scene, size, name, &objects),
        );
    }
    if formats.contains(&ExportFormat::Gltf) {
        out.files
            .push((format!("{name}.glb"), gltf::glb(scene, size, &objects)));
        out.warnings.extend(points_instead(scene));
    }
    out.warnings.extend(without_backdrop(scene));
    out
}

impl Exported {
    fn add(&mut self, name: String, text: String) {
        self.files.push((name, text.into_bytes()));
    }
}

/// An object that has something to draw.
struct Exporting<'a> {
    object: &'a Object,
    /// Number in the scene.
    number: usize,
    /// Its OBJ file.
    file: String,
}

fn objects<'a>(scene: &'a Scene, name: &str) -> Vec<Exporting<'a>> {
    let drawn = scene.objects.iter().enumerate();
    let drawn = drawn.filter(|(_, o)| !o.mesh.triangles().is_empty());
    drawn
        .map(|(number, object)| Exporting {
            object,
            number,
            file: format!("{name}-{number}.obj"),
        })
        .collect()
}

/// Degrees above which an edge of the mesh is sharp.
fn crease(mesh: &Mesh) -> f64 {
    match mesh.shading() {
        Shading::Flat => 0.0,
        Shading::Smooth => 180.0,
        Shading::Crease { degrees } => degrees,
    }
}

fn pretty(value: &serde_json::Value) -> String {
    // Writing JSON to memory cannot fail.
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

fn points_instead(scene: &Scene) -> Option<SceneWarning> {
    let point = |shape: &&LightShape| gltf::is_point_instead(shape);
    let shapes = scene.lights.iter().map(|l| &l.shape);
    let count = shapes.filter(point).count();
    (count > 0).then(|| SceneWarning {
        code: "lights-as-points",
        count,
        message:
            "glTF has no spheres, polygons and parallelograms as lights; these are points in it"
                .to_owned(),
    })
}

fn other_samplers(objects: &[Exporting<'_>]) -> Option<SceneWarning> {
    let count = pictures::other_samplers(objects);
    (count > 0).then(|| SceneWarning {
        code: "texture-samplers",
        count,
        message: "OBJ has no words for how these textures are filtered or mirrored; they are \
                  linear and repeated in it"
            .to_owned(),
    })
}

fn without_backdrop(scene: &Scene) -> Option<SceneWarning> {
    (scene.backdrop.is_some() || scene.environment.is_some()).then(|| SceneWarning {
        code: "without-backdrop",
        count: 1,
        message: "the environment is exported as the lights that were fitted to it; the map behind the scene \
                  and how the rest of its light varies are not"
            .to_owned(),
    })
}

#[cfg(test)]
mod tests;
