//! Many volumes behind one another: a colonnade seen from low.

use glam::DVec3;

use super::palette::{CLAY, STONE, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape::{self, Shape};

/// 5 x 4 columns of 16 sides, each with a box on top.
pub(super) fn scene() -> Scene {
    let places =
        || (0..20).map(|n| DVec3::new(f64::from(n % 5) - 2.0, 0.0, f64::from(n / 5) - 1.5) * 1.4);
    let columns = places().map(|p| shape::cylinder(16, 0.22, 0.0, 1.8).translated(p));
    let boxes = places().map(|p| shape::cuboid(p + DVec3::Y * 1.93, DVec3::new(0.62, 0.24, 0.62)));
    let light = Light::horizontal_square(DVec3::new(-4.2, 5.2, 4.1), 1.0);
    Scene::new(
        Camera::look_at([2.6, 1.3, 6.4], [-0.4, 0.8, 0.0]),
        vec![light],
        vec![
            floor(8.0),
            solid("columns", Shape::merged(columns), STONE),
            solid("boxes", Shape::merged(boxes), CLAY),
        ],
    )
}
