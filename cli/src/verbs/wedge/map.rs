//! What one edge adds to the visibility of each pixel.

use glam::DVec3;
use gnomon_pipeline::measure::visibility_sum::VisibilitySum;
use gnomon_pipeline::truth::oracle::surfaces::Surfaces;
use gnomon_pipeline::world::scene::Scene;
use rayon::prelude::*;

/// Signed coverage by pixel.
pub(super) struct CoverageMap {
    pub(super) size: [u32; 2],
    /// NaN where no surface is seen.
    pub(super) values: Vec<f64>,
}

impl CoverageMap {
    pub(super) fn new(scene: &Scene, sum: &VisibilitySum, edge: usize, size: [u32; 2]) -> Self {
        let surfaces = Surfaces::new(scene);
        let rays = scene.camera.eye_rays(size[0], size[1]);
        let pixels = size[0] as usize * size[1] as usize;
        let value = |i: usize| {
            let x = (i % size[0] as usize) as f64 + 0.5;
            let y = (i / size[0] as usize) as f64 + 0.5;
            let receiver = surfaces.receiver(&rays, x, y);
            receiver.map_or(f64::NAN, |r| sum.contribution(edge, r.point))
        };
        Self {
            size,
            values: (0..pixels).into_par_iter().map(value).collect(),
        }
    }

    /// Pixels at which the edge adds, and takes, with the most of each.
    pub(super) fn totals(&self) -> Totals {
        let mut totals = Totals::default();
        for &value in self.values.iter().filter(|v| !v.is_nan()) {
            if value > 0.0 {
                totals.adding += 1;
                totals.most_added = totals.most_added.max(value);
            } else if value < 0.0 {
                totals.taking += 1;
                totals.most_taken = totals.most_taken.max(-value);
            }
        }
        totals
    }
}

/// What a map holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Totals {
    pub(super) adding: usize,
    pub(super) most_added: f64,
    pub(super) taking: usize,
    pub(super) most_taken: f64,
}

/// A point of an array.
pub(super) fn array(p: DVec3) -> [f64; 3] {
    p.to_array()
}
