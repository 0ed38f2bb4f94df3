//! A lone model on a ground plane, lit and framed.

use std::path::Path;

use glam::DVec3;

use super::{Camera, Material, Object, Scene, SceneWarning};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::files::Outside;
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
/// file's name, and its faces the materials that they use, of libraries in its
/// folder or, if allowed, outside.
///
/// # Errors
/// The file cannot be read or holds no valid mesh.
pub fn load_and_frame(path: &Path, outside: Outside) -> Result<Scene, ObjError> {
    let read = obj::load_given(path, outside)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = frame_model(&stem, read.shape);
    for object in scene.objects.iter_mut().filter(|o| o.casts) {
        object.parts.clone_from(&read.parts);
    }
    scene.warnings.extend(read.warnings);
    Ok(scene)
}

/// Scales `model` to a largest extent of 2, stands it on a ground plane at
/// y = 0, and sets a light and a camera round it. A mesh that is not closed
/// stays a caster, with an `open-mesh` warning: a technique may refuse it.
///
/// # Panics
/// A coordinate is not finite or beyond f32.
pub fn frame_model(name: &str, model: Shape) -> Scene {
    let (low, high) = model.bounds().unwrap_or_default();
    let extent = high - low;
    let scale = scale_of(extent);
    let height = extent.y * scale;
    let model = placed(model, (low + high) / 2.0, low.y, scale);
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

/// The factor that makes the largest extent that of a framed model; 1 for models
/// that are a point, or smaller than a factor can mend.
fn scale_of(extent: DVec3) -> f64 {
    let scale = MODEL_SIZE / extent.max_element();
    if scale.is_finite() { scale } else { 1.0 }
}

/// The model with `centre` over the origin and `base` just above the ground, in
/// f64 and rounded once. The offset goes first: what is far from its origin has
/// digits only for what is left then.
fn placed(mut model: Shape, centre: DVec3, base: f64, scale: f64) -> Mesh {
    let foot = DVec3::new(centre.x, base, centre.z);
    for p in &mut model.positions {
        *p = (*p - foot) * scale + DVec3::Y * LIFT;
    }
    let creased = model.into_mesh(Shading::Crease { degrees: 60.0 });
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

    use glam::DMat4;

    fn framed(shape: Shape) -> Scene {
        frame_model("thing", shape)
    }

    #[test]
    fn where_a_model_was_does_not_matter() {
        let tower = || shape::cylinder(16, 0.5, -3.0, 1.0);
        let far = DVec3::new(512_345.25, 12.5, 5_432_109.75);
        let mesh = |scene: &Scene| scene.objects[1].mesh.positions().to_vec();
        let [here, there] = [DVec3::ZERO, far].map(|d| mesh(&framed(tower().translated(d))));
        for (a, b) in here.iter().zip(&there) {
            (0..3).for_each(|k| assert!((a[k] - b[k]).abs() < 1e-8, "{a:?} {b:?}"));
        }
    }

    #[test]
    fn points_and_specks_are_framed_too() {
        let triangle = |size: f64| Shape {
            positions: vec![DVec3::ZERO, DVec3::X * size, DVec3::Z * size],
            triangles: vec![[0, 1, 2]],
        };
        for size in [0.0, 1e-320, 1e-300, 3e38] {
            assert_eq!(framed(triangle(size)).objects.len(), 2, "{size}");
        }
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
