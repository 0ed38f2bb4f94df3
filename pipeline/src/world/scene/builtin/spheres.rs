//! A lattice of spheres: overlapping shadows, 27 convex parts.

use glam::DVec3;

use super::palette::{STEEL, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape::{self, Shape};

/// 3 x 3 x 3 icospheres of 320 triangles, radius 0.3, spacing 1.
pub(super) fn scene() -> Scene {
    let centre = |n: u32| {
        let [i, j, k] = [n % 3, n / 9, n / 3 % 3].map(f64::from);
        DVec3::new(i - 1.0, j + 0.8, k - 1.0)
    };
    let spheres = Shape::merged((0..27).map(|n| shape::icosphere(2, 0.3, centre(n))));
    let light = Light::horizontal_square(DVec3::new(3.0, 7.0, 2.0), 1.0);
    let camera = Camera::look_at([2.2, 4.4, 6.8], [-0.3, 1.2, 0.0]);
    Scene::new(
        camera,
        vec![light],
        vec![floor(7.0), solid("spheres", spheres, STEEL)],
    )
}
