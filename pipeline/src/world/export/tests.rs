//! What is written is read back as the same scene.

use super::*;
use crate::world::files::Outside;
use crate::world::scene::{SceneSource, builtin, file, load_and_frame};
use crate::world::scratch::Scratch;

/// The scene in all formats in a folder of its own.
fn written(scene: &Scene, test: &str) -> (Scratch, Exported) {
    let folder = Scratch::made(&format!("export-{test}"));
    let formats = [ExportFormat::Gltf, ExportFormat::Obj];
    let exported = export(scene, [64, 48], "it", &formats);
    for (name, bytes) in &exported.files {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    (folder, exported)
}

/// Triangles as the places of their corners, which no numbering changes.
fn triangles(object: &Object) -> Vec<[[u32; 3]; 3]> {
    let bits = |i: u32| object.mesh.positions()[i as usize].map(|c| (c + 0.0).to_bits());
    let triangles = object.mesh.triangles().iter();
    let mut all: Vec<_> = triangles.map(|t| t.map(bits)).collect();
    all.iter_mut().for_each(|t| {
        let least = (0..3).min_by_key(|k| t[*k]).unwrap();
        t.rotate_left(least);
    });
    all.sort_unstable();
    all
}

/// Those that have three corners.
fn proper(object: &Object) -> Vec<[[u32; 3]; 3]> {
    let mut all = triangles(object);
    all.retain(|[a, b, c]| a != b && b != c && c != a);
    all
}

#[test]
fn scene_files_hold_everything_to_the_bit() {
    for entry in builtin::SCENES {
        let scene = entry.build();
        let (folder, _) = written(&scene, &format!("toml-{}", entry.name));
        let read = file::load(&folder.join("it.toml")).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(read.camera, scene.camera, "{}", entry.name);
        assert_eq!(read.lights, scene.lights, "{}", entry.name);
        let own = (scene.ambient, scene.background, Some([64, 48]));
        assert_eq!((read.ambient, read.background, read.size), own);
        let drawn = scene
            .objects
            .iter()
            .filter(|o| !o.mesh.triangles().is_empty());
        for (own, read) in drawn.zip(&read.objects) {
            assert_eq!(proper(own), proper(read), "{} {}", entry.name, own.name);
            let parts = |o: &Object| (o.casts, o.receives, o.open);
            assert_eq!(parts(own), parts(read));
            let paint = |o: &Object| {
                o.painted()
                    .into_iter()
                    .map(|p| p.material)
                    .collect::<Vec<_>>()
            };
            assert_eq!(paint(own), paint(read));
        }
    }
}

#[test]
fn gltf_holds_geometry_to_the_bit_and_camera_and_lights_nearly() {
    for entry in builtin::SCENES {
        let scene = entry.build();
        let (folder, exported) = written(&scene, &format!("glb-{}", entry.name));
        let read = load_and_frame(&folder.join("it.glb"), Outside::Refused).unwrap();
        let drawn = scene
            .objects
            .iter()
            .filter(|o| !o.mesh.triangles().is_empty());
        for (own, read) in drawn.zip(&read.objects) {
            assert_eq!(proper(own), proper(read), "{} {}", entry.name, own.name);
            let albedo = |o: &Object| {
                o.painted()
                    .into_iter()
                    .map(|p| p.material.albedo)
                    .collect::<Vec<_>>()
            };
            assert_eq!(albedo(own), albedo(read));
        }
        let [own, other] = [&scene.camera, &read.camera];
        let sight = |c: &crate::world::scene::Camera| (c.target - c.eye).normalize();
        assert!((own.eye - other.eye).length() <= 1e-9 * (1.0 + own.eye.length()));
        assert!((sight(own) - sight(other)).length() < 1e-9);
        assert!((own.fov_y_degrees - other.fov_y_degrees).abs() < 1e-12);
        assert!((own.near - other.near).abs() <= 1e-12 * own.near);
        let as_points = exported
            .warnings
            .iter()
            .any(|w| w.code == "lights-as-points");
        let brightest = scene
            .lights
            .iter()
            .flat_map(|l| l.colour)
            .fold(0.0, f32::max);
        // All lights but their common factor; no order is changed.
        for (own, other) in scene.lights.iter().zip(&read.lights) {
            for (a, b) in own.colour.iter().zip(other.colour) {
                assert!((a / brightest - b).abs() < 1e-5, "{} {a} {b}", entry.name);
            }
            if !as_points {
                same_shape(&own.shape, &other.shape);
            }
        }
        assert_eq!(read.lights.len(), scene.lights.len());
    }
}

fn same_shape(a: &LightShape, b: &LightShape) {
    use crate::world::light::HardLight::{Directional, Point};
    let light = |shape: &LightShape| crate::world::light::Light {
        shape: shape.clone(),
        colour: [1.0; 3],
    };
    match (light(a).hard(), light(b).hard()) {
        (Point(a), Point(b)) => assert!((a - b).length() < 1e-9, "{a} {b}"),
        (Directional(a), Directional(b)) => {
            assert!((a.normalize() - b.normalize()).length() < 1e-9, "{a} {b}");
        }
        other => panic!("{other:?}"),
    }
    if let (
        LightShape::Rectangle {
            edge_u: u,
            edge_v: v,
            ..
        },
        LightShape::Rectangle { edge_u, edge_v, .. },
    ) = (a, b)
    {
        let same = |a: glam::DVec3, b: glam::DVec3| (a - b).length().min((a + b).length());
        assert!(same(*u, *edge_u) < 1e-9 && same(*v, *edge_v) < 1e-9);
    }
}

#[test]
fn open_casters_are_open_when_they_are_read_back() {
    let mut scene = builtin::build("cylinder").unwrap();
    let sheet = crate::world::shape::plane(1.0, 0.5);
    let mesh = sheet.into_mesh(Shading::Flat).unwrap();
    let mut object = Object::new(
        "sheet",
        mesh,
        crate::world::material::Material::matt([0.5; 3]),
    );
    object.open = true;
    scene.objects.push(object);
    let (folder, _) = written(&scene, "open");
    let read = file::load(&folder.join("it.toml")).unwrap();
    let open = |s: &Scene| {
        s.objects
            .iter()
            .map(|o| (o.casts, o.open))
            .collect::<Vec<_>>()
    };
    assert_eq!(open(&read), open(&scene));
    assert_eq!(open(&read).last(), Some(&(true, true)));
}

/// A light in the middle of the scene is as bright as one outside it.
#[test]
fn lights_in_the_middle_are_not_black_in_gltf() {
    let mut scene = builtin::build("cylinder").unwrap();
    let bounds = scene.objects.iter().filter_map(|o| o.mesh.bounds());
    let (low, high) = bounds
        .reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
        .unwrap();
    let middle = (low + high) / 2.0;
    let light = |position, colour| crate::world::light::Light {
        shape: LightShape::Point { position },
        colour,
    };
    scene.lights = vec![
        light(middle, [1.0, 0.5, 0.25]),
        light(middle + glam::DVec3::Y * 9.0, [0.5; 3]),
    ];
    let (folder, _) = written(&scene, "middle");
    let read = load_and_frame(&folder.join("it.glb"), Outside::Refused).unwrap();
    for (own, other) in scene.lights.iter().zip(&read.lights) {
        for (a, b) in own.colour.iter().zip(other.colour) {
            assert!((a - b).abs() < 1e-5, "{a} {b}");
        }
    }
}

#[test]
fn names_cannot_break_lines_or_tables() {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.objects[1].name = "a\n[[lights]]\n\"'#\\".to_owned();
    let (folder, _) = written(&scene, "names");
    let mut source = SceneSource::open(folder.join("it.toml").to_str().unwrap()).unwrap();
    let read = source.at(0.0).unwrap();
    assert_eq!(read.objects[1].name, "a [[lights]] \"'#\\");
    // A backslash at the end of a line of OBJ would take the first vertex away.
    assert_eq!(proper(&scene.objects[1]), proper(&read.objects[1]));
}

#[test]
fn the_description_names_only_files_that_are_written() {
    let scene = builtin::build("cylinder").unwrap();
    for (formats, named) in [
        (&[ExportFormat::Gltf][..], false),
        (&[ExportFormat::Obj], true),
    ] {
        let exported = export(&scene, [64, 48], "it", formats);
        let (name, text) = &exported.files[0];
        assert_eq!(name, "it.json");
        let description: serde_json::Value = serde_json::from_slice(text).unwrap();
        for object in description["objects"].as_array().unwrap() {
            let file = object["mesh"]["obj"].as_str();
            assert_eq!(file.is_some(), named, "{object}");
            let written = |f: &str| exported.files.iter().any(|(name, _)| name == f);
            assert!(file.is_none_or(written), "{object}");
            assert!(object["triangles"].as_u64().unwrap() > 0);
        }
    }
}

/// Pictures, where they lie and how they are read come back from both formats.
#[test]
fn textures_are_read_back() {
    use crate::world::texture::{Picture, REPEATED, SurfaceTexture};
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_raw(2, 1, vec![255, 0, 0, 0, 0, 255]).unwrap();
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let picture = std::sync::Arc::new(Picture::decode(&bytes.into_inner()).unwrap());
    let mut scene = builtin::build("cylinder").unwrap();
    for (k, object) in scene.objects.iter_mut().enumerate() {
        let count = object.mesh.triangles().len() as u32;
        let mut texture = SurfaceTexture::repeated(picture.clone());
        if k == 0 {
            texture.sampler.address = [gnomon_raster::AddressMode::ClampToEdge; 3];
        }
        object.parts = vec![crate::world::material::MaterialPart {
            material: object.material,
            texture: Some(texture),
            triangles: (0..count).collect(),
        }];
        let corner = |t: u32, c: u32| [(t * 3 + c) as f32 / 7.0, c as f32 - 0.3];
        let of = |t| [0, 1, 2].map(|c| corner(t, c));
        object.coordinates = Some((0..count).map(of).collect());
    }
    let (folder, exported) = written(&scene, "textures");
    assert!(exported.files.iter().any(|(name, _)| name == "it-0.png"));
    assert!(
        exported
            .warnings
            .iter()
            .all(|w| w.code != "texture-samplers")
    );
    let from_toml = file::load(&folder.join("it.toml")).unwrap();
    let from_glb = load_and_frame(&folder.join("it.glb"), Outside::Refused).unwrap();
    assert_eq!(from_toml.warnings, []);
    for read in [from_toml, from_glb] {
        for (own, read) in scene.objects.iter().zip(&read.objects) {
            let lies = |o: &Object| {
                let triangles = o.mesh.triangles().iter().enumerate();
                let mut all: Vec<_> = triangles
                    .map(|(t, corners)| {
                        let places = corners.map(|i| o.mesh.positions()[i as usize]);
                        let at = o.coordinates_of(t as u32);
                        [0, 1, 2].map(|k| (places[k].map(f32::to_bits), at[k].map(f32::to_bits)))
                    })
                    .collect();
                all.sort_unstable();
                all
            };
            assert_eq!(lies(own), lies(read), "{}", own.name);
            let [a, b] = [own, read].map(|o| o.parts[0].texture.clone().unwrap());
            assert_eq!(a.picture, b.picture);
            assert_eq!(a.sampler.address[..2], b.sampler.address[..2]);
            let without_address = |s: gnomon_raster::Sampler| gnomon_raster::Sampler {
                address: REPEATED.address,
                ..s
            };
            assert_eq!(without_address(a.sampler), without_address(b.sampler));
        }
    }
    let part = scene.objects[1].parts[0].texture.as_mut().unwrap();
    part.sampler.mag = gnomon_raster::FilterMode::Nearest;
    let other = export(&scene, [64, 48], "it", &[ExportFormat::Obj]);
    assert!(other.warnings.iter().any(|w| w.code == "texture-samplers"));
}
