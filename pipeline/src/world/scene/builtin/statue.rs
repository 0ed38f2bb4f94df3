//! A finely tessellated figure on a pedestal, for the Buddha of Annen et al. 2008.

use glam::DVec3;

use super::palette::{BRASS, STONE, floor, solid};
use crate::world::light::Light;
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape;

/// The figure, 70,000 triangles, sunk a little into a 48-gon pedestal.
pub(super) fn scene() -> Scene {
    let figure = shape::statue().translated(DVec3::new(0.0, 1.28, 0.0));
    let figure = figure.into_mesh(Shading::Smooth);
    let figure = figure.expect("built-in shapes are finite");
    let light = Light::horizontal_square(DVec3::new(2.2, 4.8, 2.6), 1.0);
    Scene::new(
        Camera::look_at([0.7, 2.3, 4.6], [-0.1, 1.05, 0.0]),
        vec![light],
        vec![
            floor(6.0),
            solid("pedestal", shape::cylinder(48, 0.72, 0.0, 0.32), STONE),
            Object::new("figure", figure, BRASS),
        ],
    )
}
