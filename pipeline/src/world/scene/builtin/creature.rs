//! A character of overlapping closed parts, the papers' alien or knight.

use glam::DVec3;

use super::palette::{MOSS, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape;

/// The biped in mid-stride, turned a little from the eye.
pub(super) fn scene() -> Scene {
    let body = shape::placed_creature(1.1, 0.5, DVec3::ZERO);
    let light = Light::horizontal_square(DVec3::new(2.2, 4.6, 2.4), 1.0);
    Scene::new(
        Camera::look_at([0.6, 2.0, 4.6], [-0.2, 0.9, 0.0]),
        vec![light],
        vec![floor(6.0), solid("creature", body, MOSS)],
    )
}
