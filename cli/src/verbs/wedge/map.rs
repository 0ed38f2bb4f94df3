//! What one edge adds to the visibility of each pixel.

use gnomon_pipeline::measure::visibility_sum::VisibilitySum;
use gnomon_pipeline::world::scene::Scene;

use crate::overlay::each_pixel;

/// Signed coverage by pixel.
pub(super) struct CoverageMap {
    pub(super) size: [u32; 2],
    /// NaN where no surface is seen.
    pub(super) values: Vec<f64>,
}

impl CoverageMap {
    pub(super) fn new(scene: &Scene, sum: &VisibilitySum, edge: usize, size: [u32; 2]) -> Self {
        let values = each_pixel(scene, size, |place| {
            sum.contribution(edge, place.receiver.point)
        });
        let values = values.into_iter().map(|v| v.unwrap_or(f64::NAN));
        Self {
            size,
            values: values.collect(),
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
