//! Two boxes above each other over a floor: the lower one takes the upper one's shadow and
//! casts its own (Chan and Durand 2003).

use glam::DVec3;

use super::palette::{BRASS, CLAY, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape;

/// A small box at height 2 above a larger one at 1; a light of side 0.5 at 5.
pub(super) fn scene() -> Scene {
    let light = Light::horizontal_square(DVec3::new(1.8, 5.0, -0.6), 0.5);
    let upper = shape::cuboid(DVec3::new(0.25, 2.0, 0.15), DVec3::new(0.7, 0.2, 0.7));
    let lower = shape::cuboid(DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.6, 0.3, 1.4));
    let camera = Camera::look_at([1.4, 3.4, 4.6], [-0.25, 0.7, -0.1]);
    Scene::new(
        camera,
        vec![light],
        vec![
            floor(6.0),
            solid("upper box", upper, BRASS),
            solid("lower box", lower, CLAY),
        ],
    )
}
