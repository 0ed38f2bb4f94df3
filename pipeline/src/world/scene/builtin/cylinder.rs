//! The papers' first test: one cylinder on a floor.

use glam::DVec3;

use super::palette::{CLAY, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape;

/// 32 sides, radius 0.5, height 1.5, on a 10 x 10 floor; 1 x 1 light at height 4.
pub(super) fn scene() -> Scene {
    let light = Light::horizontal_square(DVec3::new(1.6, 4.0, 1.0), 1.0);
    let cylinder = solid("cylinder", shape::cylinder(32, 0.5, 0.0, 1.5), CLAY);
    let camera = Camera::look_at([0.8, 2.6, 4.6], [-0.3, 0.55, 0.0]);
    Scene::new(camera, vec![light], vec![floor(5.0), cylinder])
}
