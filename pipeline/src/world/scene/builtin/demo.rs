//! The default scene: casters of different kinds, arranged to be looked at.

use glam::DVec3;

use super::palette::{BRASS, CLAY, FLOOR, MOSS, STEEL, STONE, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape::{self, Shape};

/// A creature walks among columns past a knot on a pedestal and some balls.
pub(super) fn scene() -> Scene {
    let mut light = Light::horizontal_square(DVec3::new(3.4, 6.2, 2.6), 1.0);
    light.colour = [1.0, 0.95, 0.86];
    let camera = Camera {
        fov_y_degrees: 34.0,
        ..Camera::look_at([-1.2, 3.0, 7.6], [0.05, 0.95, 0.0])
    };
    let mut scene = Scene::new(camera, vec![light], objects());
    scene.ambient = [0.16, 0.18, 0.23];
    scene.background = [0.34, 0.44, 0.58];
    scene
}

fn objects() -> Vec<Object> {
    let creature = shape::placed_creature(1.1, 0.45, DVec3::new(-1.3, 0.0, 1.3));
    let knot = shape::torus_knot(2, 3, 0.56, 0.14, 0.085, 256, 20, DVec3::new(0.7, 1.2, 0.4));
    vec![
        solid("ground", shape::plane(30.0, 0.0), FLOOR).receiver_only(),
        solid("columns", columns(), STONE),
        solid(
            "pedestal",
            shape::cuboid(DVec3::new(0.7, 0.35, 0.4), DVec3::new(1.1, 0.7, 1.1)),
            CLAY,
        ),
        solid("knot", knot, BRASS),
        solid("creature", creature, MOSS),
        solid("balls", balls(), STEEL),
    ]
}

/// A row of five columns under a beam.
fn columns() -> Shape {
    let column = |k: u32| {
        let place = DVec3::new(1.5 * f64::from(k) - 3.4, 0.0, -1.8);
        let base = shape::cuboid(place + DVec3::Y * 0.08, DVec3::new(0.66, 0.16, 0.66));
        let shaft = shape::cylinder(24, 0.22, 0.12, 2.25).translated(place);
        Shape::merged([base, shaft])
    };
    let beam = shape::cuboid(DVec3::new(-0.4, 2.36, -1.8), DVec3::new(7.0, 0.3, 0.6));
    Shape::merged((0..5).map(column).chain([beam]))
}

fn balls() -> Shape {
    let places = [
        ([2.35, 0.42, 1.0], 0.42),
        ([2.15, 0.24, 1.95], 0.24),
        ([1.45, 0.16, 2.0], 0.16),
    ];
    Shape::merged(places.map(|(centre, radius)| shape::icosphere(3, radius, DVec3::from(centre))))
}
