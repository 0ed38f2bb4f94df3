//! A large receiver: floating solids over a fractal landscape.

use glam::DVec3;

use super::palette::{BRASS, MOSS, STEEL, solid};
use crate::world::light::Light;
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape;

/// Diamond-square 257 x 257 cropped to 225 x 225 vertices: 100,352 triangles.
/// A height field is not closed, so the landscape only receives.
pub(super) fn scene() -> Scene {
    let land = shape::diamond_square(8, 224, 6.0, 1.6, 2005);
    let land = land.into_mesh(Shading::Smooth).expect("heights are finite");
    let ring = shape::torus_knot(1, 0, 0.8, 0.0, 0.26, 96, 32, DVec3::new(-0.5, 2.6, 0.2));
    let ball = shape::icosphere(3, 0.45, DVec3::new(1.7, 2.3, 0.8));
    let light = Light::horizontal_square(DVec3::new(2.0, 7.0, 1.5), 1.0);
    Scene::new(
        Camera::look_at([0.0, 4.6, 7.2], [0.0, 0.8, 0.0]),
        vec![light],
        vec![
            Object::new("landscape", land, MOSS).receiver_only(),
            solid("ring", ring, BRASS),
            solid("ball", ball, STEEL),
        ],
    )
}
