//! A lone model as a scene: on a ground plane, lit and framed, or with its own camera.

use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};

use super::{Camera, Material, Object, Scene, SceneWarning};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::files::Outside;
use crate::world::light::{Light, LightShape};
use crate::world::mesh::{Mesh, Shading};
use crate::world::model::{self, Model, ModelCamera, ModelError, Piece};
use crate::world::shape::{self, Shape};

/// Largest extent of a framed model, scene units.
const MODEL_SIZE: f64 = 2.0;

/// Gap between model and ground, so that a flat base does not fight with it.
const LIFT: f64 = 0.002;

/// Name of the ground.
const GROUND_NAME: &str = "ground";

const MODEL: Material = Material::glossy([0.72, 0.66, 0.58], 0.2, 24.0);
/// How models are shaded.
const CREASES: Shading = Shading::Crease { degrees: 60.0 };

const GROUND: Material = Material::matt([0.6, 0.62, 0.65]);

/// Reads a model and makes a scene of it, which has the file's name. A file with a camera
/// is a scene by itself; any other is framed as by [`frame_model`], with its own lights if
/// it has any. Faces have the materials that they use; what the file names in turn must lie
/// in its folder or, if allowed, outside.
///
/// # Errors
/// The file cannot be read or holds no valid mesh.
pub fn load_and_frame(path: &Path, outside: Outside) -> Result<Scene, ModelError> {
    Ok(load_at(path, outside, 0.0)?.0)
}

/// The same at a time of the model's animation, in seconds, and whether it is another at
/// another time. What is chosen for a model is that of time 0: it moves in the frame, not
/// the frame with it, and lights keep their brightness.
///
/// # Errors
/// As [`load_and_frame`].
pub(super) fn load_at(
    path: &Path,
    outside: Outside,
    time: f64,
) -> Result<(Scene, bool), ModelError> {
    let mut read = model::load_given_at(path, outside, time)?;
    let first = match read.moves && time != 0.0 {
        true => model::load_given(path, outside)?,
        false => read.clone(),
    };
    for (light, first) in read.lights.iter_mut().zip(&first.lights) {
        light.colour = first.colour;
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let scene = match &read.camera {
        Some(camera) => as_written(&stem, camera.into(), (&read, &first)),
        None => framed(&stem, &read, Frame::of(&first)),
    };
    Ok((scene, read.moves))
}

/// Scales `model` to a largest extent of 2, stands it on a ground plane at
/// y = 0, and sets a light and a camera round it. A mesh that is not closed
/// stays a caster by its generalised silhouette, with an `open-mesh` warning.
///
/// # Panics
/// A coordinate is not finite or beyond f32.
pub fn frame_model(name: &str, model: Shape) -> Scene {
    let piece = Piece {
        name: name.to_owned(),
        shape: model,
        parts: Vec::new(),
        coordinates: Vec::new(),
    };
    let model = Model::of(piece, Vec::new());
    framed(name, &model, Frame::of(&model))
}

/// The model on a ground plane.
fn framed(name: &str, model: &Model, frame: Frame) -> Scene {
    let height = frame.height;
    let camera = camera(height);
    let ground = ground_across(camera.target - camera.eye);
    let mut objects = vec![Object::new(GROUND_NAME, ground, GROUND).receiver_only()];
    let creased = |shape: Shape| {
        let creased = shape.into_mesh(CREASES);
        creased.expect("the model fits a box of size 2")
    };
    let pieces = model.pieces.iter();
    objects.extend(pieces.map(|p| object(p, creased(frame.placed(p.shape.clone())))));
    let above = DVec3::new(2.4, height + 3.2, 2.2);
    let mut lights: Vec<Light> = model.lights.iter().map(|l| frame.light(l)).collect();
    if lights.is_empty() {
        lights.push(Light::horizontal_square(above, 0.8));
    }
    finished(name, Scene::new(camera, lights, objects), model)
}

/// The ground of a framed model, turned so that its far end is level in a picture along
/// `sight`.
fn ground_across(sight: DVec3) -> Mesh {
    let away = DVec3::new(sight.x, 0.0, sight.z);
    // Straight down any turn will do.
    let [sin, cos] = match away.length() {
        length if length > 0.0 => [away.x / length, away.z / length],
        _ => [0.0, 1.0],
    };
    let turn = DMat3::from_cols(
        DVec3::new(cos, 0.0, -sin),
        DVec3::Y,
        DVec3::new(sin, 0.0, cos),
    );
    let ground = shape::plane(12.0, 0.0).transformed(DMat4::from_mat3(turn));
    ground
        .into_mesh(Shading::Flat)
        .expect("the ground is finite")
}

/// Turns the ground of a framed model to the scene's camera.
pub(super) fn turn_ground(scene: &mut Scene) {
    let sight = scene.camera.target - scene.camera.eye;
    let mut grounds = scene.objects.iter_mut();
    if let Some(ground) = grounds.find(|o| o.name == GROUND_NAME && !o.casts) {
        ground.mesh = Arc::new(ground_across(sight));
    }
}

/// The file's own scene, in its own units.
fn as_written(name: &str, camera: Camera, (model, first): (&Model, &Model)) -> Scene {
    let creased = |shape: Shape| shape.into_mesh(CREASES).expect("the reader bounds it");
    let pieces = model.pieces.iter();
    let objects = pieces
        .map(|p| object(p, creased(p.shape.clone())))
        .collect();
    let mut lights = model.lights.clone();
    if lights.is_empty() {
        lights.push(light_above(first));
    }
    finished(name, Scene::new(camera, lights, objects), model)
}

/// The light that a framed model has, for one in other units.
fn light_above(model: &Model) -> Light {
    let (low, high) = model.bounds().unwrap_or_default();
    let extent = (high - low).max_element().max(f64::MIN_POSITIVE) / MODEL_SIZE;
    let top = DVec3::new((low.x + high.x) / 2.0, high.y, (low.z + high.z) / 2.0);
    Light::horizontal_square(top + DVec3::new(2.4, 3.2, 2.2) * extent, 0.8 * extent)
}

fn object(piece: &Piece, mesh: Mesh) -> Object {
    let mut object = Object::new(piece.name.clone(), mesh, MODEL);
    object.open = true;
    object.parts.clone_from(&piece.parts);
    if piece.parts.iter().any(|p| p.texture.is_some()) {
        object.coordinates = Some(piece.coordinates.as_slice().into());
    }
    object
}

/// The scene with its name, and what is to be said of it.
fn finished(name: &str, mut scene: Scene, model: &Model) -> Scene {
    name.clone_into(&mut scene.name);
    scene.warnings.extend(open_warning(scene.casters()));
    scene.warnings.extend(model.warnings.iter().cloned());
    scene
}

/// Where a framed model is.
#[derive(Clone, Copy)]
struct Frame {
    /// Of the model: what comes to lie under the origin, on the ground.
    foot: DVec3,
    scale: f64,
    /// Scaled.
    height: f64,
}

impl Frame {
    fn of(model: &Model) -> Self {
        let (low, high) = model.bounds().unwrap_or_default();
        let extent = high - low;
        let scale = scale_of(extent);
        let centre = (low + high) / 2.0;
        Self {
            foot: DVec3::new(centre.x, low.y, centre.z),
            scale,
            height: extent.y * scale,
        }
    }

    /// A point of the model. The offset goes first: what is far from its origin has digits
    /// only for what is left then.
    fn point(&self, p: DVec3) -> DVec3 {
        (p - self.foot) * self.scale + DVec3::Y * LIFT
    }

    /// In f64, to be rounded once.
    fn placed(&self, mut shape: Shape) -> Shape {
        for p in &mut shape.positions {
            *p = self.point(*p);
        }
        shape
    }

    /// A light of the model.
    fn light(&self, light: &Light) -> Light {
        let mut light = light.clone();
        match &mut light.shape {
            LightShape::Point { position } => *position = self.point(*position),
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => {
                *centre = self.point(*centre);
                *edge_u *= self.scale;
                *edge_v *= self.scale;
            }
            LightShape::Disc { centre, radius, .. } | LightShape::Sphere { centre, radius } => {
                *centre = self.point(*centre);
                *radius *= self.scale;
            }
            // Of no model file.
            LightShape::Polygon(_) | LightShape::Directional { .. } => {}
        }
        light
    }
}

/// The factor that makes the largest extent that of a framed model; 1 for models
/// that are a point, or smaller than a factor can mend.
fn scale_of(extent: DVec3) -> f64 {
    let scale = MODEL_SIZE / extent.max_element();
    if scale.is_finite() { scale } else { 1.0 }
}

/// Looks down at the model's middle, far enough to see it and its shadow.
fn camera(height: f64) -> Camera {
    let target = DVec3::new(-0.15, 0.42 * height, 0.0);
    Camera {
        fov_y_degrees: 36.0,
        ..Camera::look_at(target + DVec3::new(1.1, 1.7, 4.3), target)
    }
}

impl From<&ModelCamera> for Camera {
    fn from(of: &ModelCamera) -> Self {
        Self {
            eye: of.eye,
            target: of.target,
            up: of.up,
            fov_y_degrees: of.fov_y_degrees,
            near: of.near,
        }
    }
}

fn open_warning<'a>(casters: impl Iterator<Item = &'a Object>) -> Option<SceneWarning> {
    let mut found: Option<SceneWarning> = None;
    for object in casters {
        let report = EdgeAdjacency::new(object.mesh.triangles()).closedness(&object.mesh);
        if report.is_closed() {
            continue;
        }
        let offenders =
            report.boundary + report.over_shared + report.flipped + report.degenerate_triangles;
        let first = found.get_or_insert_with(|| SceneWarning {
            code: "open-mesh",
            count: 0,
            message: format!(
                "the model is not closed: {report}; where shadows are made of volumes, they are of its \
                 generalised silhouette (refuse it with --set open-casters=refuse)"
            ),
        });
        first.count += offenders;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_far_end_of_the_ground_is_level() {
        for (x, z) in [(1.1, 4.3), (-3.0, 0.5), (0.0, -2.0)] {
            let mut scene = framed(shape::cylinder(16, 0.5, 0.0, 1.0));
            scene.camera.eye = DVec3::new(x, 2.0, z);
            scene.camera.target = DVec3::Y * 0.25;
            turn_ground(&mut scene);
            let [right, ..] = scene.camera.basis();
            let sight = DVec3::new(-x, 0.0, -z);
            let far = scene.objects[0]
                .mesh
                .positions()
                .iter()
                .map(|p| DVec3::from(p.map(f64::from)));
            let far: Vec<DVec3> = far.filter(|p| p.dot(sight) > 0.0).collect();
            assert_eq!(far.len(), 2);
            let along = (far[1] - far[0]).normalize();
            assert!(
                (along.dot(right).abs() - 1.0).abs() < 1e-6,
                "{along} {right}"
            );
        }
    }

    #[test]
    fn an_open_model_is_kept_and_flagged() {
        let scene = framed(shape::plane(3.0, 0.0));
        assert!(scene.objects[1].casts && scene.objects[1].open);
        assert_eq!(
            (scene.warnings[0].code, scene.warnings[0].count),
            ("open-mesh", 4)
        );
    }
}
