//! A lone model on a ground plane, lit and framed.

use std::path::Path;

use glam::{DMat4, DVec3};

use super::{Camera, Material, Object, Scene, SceneWarning};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::Light;
use crate::world::mesh::{Mesh, Shading};
use crate::world::obj::{self, ObjError};
use crate::world::shape::{self, Shape};

/// Largest extent of a framed model, scene units.
const MODEL_SIZE: f64 = 2.0;

/// Gap between model and ground, so that a flat base does not fight with it.
const LIFT: f64 = 0.002;

const MODEL: Material = Material::glossy([0.72, 0.66, 0.58], 0.2, 24.0);
const GROUND: Material = Material::matt([0.6, 0.62, 0.65]);

/// Reads an OBJ file and frames it with [`frame_model`]; the scene has the
/// file's name, and its faces the materials that they use.
///
/// # Errors
/// The file cannot be read or holds no valid mesh.
pub fn load_and_frame(path: &Path) -> Result<Scene, ObjError> {
    let read = obj::load(path, Shading::Flat)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = frame_model(&stem, &read.mesh);
    for object in scene.objects.iter_mut().filter(|o| o.casts) {
        object.parts.clone_from(&read.parts);
    }
    scene.warnings.extend(read.warnings);
    Ok(scene)
}

/// Scales `mesh` to a largest extent of 2, stands it on a ground plane at
/// y = 0, and sets a light and a camera round it. A mesh that is not closed
/// stays a caster, with an `open-mesh` warning: a technique may refuse it.
pub fn frame_model(name: &str, mesh: &Mesh) -> Scene {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let extent = high - low;
    let largest = extent.max_element();
    let scale = if largest > 0.0 {
        MODEL_SIZE / largest
    } else {
        1.0
    };
    let height = extent.y * scale;
    let model = placed(mesh, (low + high) / 2.0, low.y, scale);
    let warnings = open_warning(&model).into_iter().collect();
    let ground = shape::plane(12.0, 0.0).into_mesh(Shading::Flat);
    let ground = ground.expect("the ground is finite");
    let mut scene = Scene::new(
        camera(height),
        vec![Light::horizontal_square(
            DVec3::new(2.4, height + 3.2, 2.2),
            0.8,
        )],
        vec![
            Object::new("ground", ground, GROUND).receiver_only(),
            Object::new(name, model, MODEL),
        ],
    );
    name.clone_into(&mut scene.name);
    scene.warnings = warnings;
    scene
}

/// The mesh with `centre` over the origin and `base` just above the ground,
/// transformed in f64 and rounded once.
fn placed(mesh: &Mesh, centre: DVec3, base: f64, scale: f64) -> Mesh {
    let foot = DVec3::new(centre.x, base, centre.z);
    let place = DMat4::from_translation(DVec3::Y * LIFT)
        * DMat4::from_scale(DVec3::splat(scale))
        * DMat4::from_translation(-foot);
    let shape = Shape::from_mesh(mesh).transformed(place);
    let creased = shape.into_mesh(Shading::Crease { degrees: 60.0 });
    creased.expect("the model fits a box of size 2")
}

/// Looks down at the model's middle, far enough to see it and its shadow.
fn camera(height: f64) -> Camera {
    let target = DVec3::new(-0.15, 0.42 * height, 0.0);
    Camera {
        fov_y_degrees: 36.0,
        ..Camera::look_at(target + DVec3::new(1.1, 1.7, 4.3), target)
    }
}

fn open_warning(mesh: &Mesh) -> Option<SceneWarning> {
    let report = EdgeAdjacency::new(mesh.triangles()).closedness(mesh);
    let offenders =
        report.boundary + report.over_shared + report.flipped + report.degenerate_triangles;
    (!report.is_closed()).then(|| SceneWarning {
        code: "open-mesh",
        count: offenders,
        message: format!("the model is not closed: {report}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(shape: Shape) -> Scene {
        frame_model("thing", &shape.into_mesh(Shading::Flat).unwrap())
    }

    #[test]
    fn a_model_of_any_size_stands_on_the_ground_in_view() {
        for scale in [1e-4, 1.0, 1e4] {
            let place =
                DMat4::from_scale(DVec3::splat(scale)) * DMat4::from_translation(DVec3::ONE);
            let scene = framed(shape::cylinder(16, 0.5, -3.0, 1.0).transformed(place));
            let (low, high) = scene.objects[1].mesh.bounds().unwrap();
            assert!((low.y - LIFT).abs() < 1e-5 && (high.y - 2.0 - LIFT).abs() < 1e-5);
            assert!((low.x + high.x).abs() < 1e-5);
            assert_eq!(scene.warnings, []);
            let clip = scene.camera.clip_from_world(1.0).map(|r| r.map(f64::from));
            for p in [low, high] {
                let at =
                    |r: usize| clip[r][0] * p.x + clip[r][1] * p.y + clip[r][2] * p.z + clip[r][3];
                assert!(at(0).abs() < at(3) && at(1).abs() < at(3), "out of view");
            }
        }
    }

    #[test]
    fn an_open_model_is_kept_and_flagged() {
        let scene = framed(shape::plane(3.0, 0.0));
        assert!(scene.objects[1].casts);
        assert_eq!(
            (scene.warnings[0].code, scene.warnings[0].count),
            ("open-mesh", 4)
        );
    }
}
