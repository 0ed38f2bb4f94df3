//! Scenes that show the two known errors of soft shadow volumes: silhouettes of
//! one point of the light only, and penumbrae that are summed where they overlap
//! (docs/papers.md, scenes).

use glam::DVec3;

use super::palette::{CLAY, MOSS, STEEL, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape;

/// A unit cube 0.3 above the floor under a 3 x 3 light 1.5 above its top. Seen
/// from the light's centre its silhouette is the top face, whose umbra ends 2.25
/// below the light; the floor is at 2.8, and the umbra of the bottom face lasts to
/// 3.75: below the cube it is dark, and the silhouette says that it is not.
pub(super) fn single_silhouette() -> Scene {
    let light = Light::horizontal_square(DVec3::Y * 2.8, 3.0);
    let cube = solid("cube", shape::cuboid(DVec3::Y * 0.8, DVec3::ONE), STEEL);
    let camera = Camera::look_at([2.0, 1.1, 4.6], [0.0, 0.2, 0.0]);
    Scene::new(camera, vec![light], vec![floor(4.0), cube])
}

/// Two bars that cross, seen from the light, at different heights.
pub(super) fn overlap() -> Scene {
    let light = Light::horizontal_square(DVec3::Y * 4.0, 1.0);
    let bar = |y: f64, size: [f64; 3]| shape::cuboid(DVec3::Y * y, DVec3::from(size));
    let low = solid("low bar", bar(1.0, [2.4, 0.1, 0.3]), CLAY);
    let high = solid("high bar", bar(1.7, [0.3, 0.1, 2.4]), MOSS);
    let camera = Camera::look_at([1.6, 2.6, 3.4], [0.0, 0.3, 0.0]);
    Scene::new(camera, vec![light], vec![floor(4.0), low, high])
}
