//! Which surface the oracle's eye rays meet, as a depth buffer would tell it.

use rayon::prelude::*;

use crate::oracle::area::VisibilityImage;
use crate::oracle::surfaces::Surfaces;
use crate::scene::{EyeRays, Scene};

/// How far an image point may move, in pixels, before the depth found there is
/// taken for another surface's. Vertices snap to 1/256 pixel, so that surfaces
/// move by at most 1/512 in each direction.
const MOVE: f64 = 0.05;
/// Depth that rounding may add: some steps of a 24-bit buffer.
const STEPS: f64 = 8.0 / 16_777_216.0;

/// What one pixel's centre shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// In 0..1, as in a depth buffer: `1 - near / planar depth`.
    pub(super) depth: f64,
    /// How much a depth buffer may differ and still show this surface.
    tolerance: f64,
    /// Whether shadow falls on the surface.
    receives: bool,
}

/// What every pixel's centre shows; `None` where no surface is seen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sight(Vec<Option<Seen>>);

impl Sight {
    pub(super) fn new(scene: &Scene, surfaces: &Surfaces, [width, height]: [u32; 2]) -> Self {
        let rays = scene.camera.eye_rays(width, height);
        let pixels = width as usize * height as usize;
        let at = |i: usize| {
            let (x, y) = (i % width as usize, i / width as usize);
            Seen::at(scene, surfaces, &rays, [x as f64 + 0.5, y as f64 + 0.5])
        };
        Self((0..pixels).into_par_iter().map(at).collect())
    }

    /// Where shadow falls on nothing, all of the light arrives.
    pub(super) fn light_what_takes_no_shadow(&self, image: &mut VisibilityImage) {
        for (value, seen) in image.values.iter_mut().zip(&self.0) {
            if seen.is_some_and(|s| !s.receives) {
                *value = 1.0;
            }
        }
    }

    /// Whether `depth` of a depth buffer shows the surface seen at `pixel`.
    pub(super) fn agrees(&self, pixel: usize, depth: f32) -> bool {
        match self.0[pixel] {
            Some(seen) => (f64::from(depth) - seen.depth).abs() <= seen.tolerance,
            None => depth >= 1.0,
        }
    }
}

impl Seen {
    fn at(scene: &Scene, surfaces: &Surfaces, rays: &EyeRays, [x, y]: [f64; 2]) -> Option<Self> {
        let near = scene.camera.near;
        let hit = surfaces.hit(rays, x, y)?;
        let object = &scene.objects[hit.object as usize];
        let [a, b, c] = object.mesh.corners(hit.triangle as usize);
        // The reciprocal of planar depth is linear over a facet's image.
        let normal = (b - a).cross(c - a);
        let off = normal.dot(a - rays.origin);
        let centre = rays.direction(x, y);
        let steps = [rays.direction(x + 1.0, y), rays.direction(x, y + 1.0)];
        let slope: f64 = steps
            .iter()
            .map(|d| (normal.dot(*d - centre) / off).abs())
            .sum();
        let slope = if slope.is_finite() { near * slope } else { 0.0 };
        Some(Self {
            depth: 1.0 - near / hit.depth,
            tolerance: STEPS + MOVE * slope,
            receives: object.receives,
        })
    }
}
