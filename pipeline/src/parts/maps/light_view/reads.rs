//! What of a picture receivers read when they filter over what lies between them and
//! the light.

use glam::DVec3;

use super::convex::place_of;
use super::fit::{Fitted, receivers_beyond};
use super::frame::LightExtent;
use super::surroundings::Surroundings;

/// Bounds of filters' kernels in a picture, in its coordinates, 0..1 over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reads {
    pub(crate) low: [f64; 2],
    pub(crate) high: [f64; 2],
    /// The largest half width and half height.
    pub(crate) half: [f64; 2],
}

/// How much wider bounds are than in exact arithmetic, for shaders in f32.
const ROUNDING: f64 = 1e-3;

impl Fitted {
    /// The kernels of all receivers seen, at the near distance, where they are widest;
    /// `None` without receivers.
    pub(crate) fn reads(&self, around: &Surroundings<'_>, extent: LightExtent) -> Option<Reads> {
        let scale = 0.5 / self.half;
        let near = self.range[0];
        let light = [0, 1].map(|k| extent.half_along(self.frame.axes[k]) * scale);
        let mut reads: Option<Reads> = None;
        receivers_beyond(around, &self.frame, self.region, near, |polygon| {
            let farthest = polygon.iter().map(|p| p.z).fold(near, f64::max);
            let reach = (1.0 / near - 1.0 / farthest) * (1.0 + ROUNDING);
            let half = light.map(|l| l * reach);
            for p in polygon {
                let place = place_of(*p, self.frame.projection);
                let at = [0, 1].map(|k| 0.5 + (place[k] - self.middle[k]) * scale);
                let grown = [0, 1].map(|k| half[k] + ROUNDING * (1.0 + at[k].abs()));
                let own = Reads {
                    low: [0, 1].map(|k| at[k] - grown[k]),
                    high: [0, 1].map(|k| at[k] + grown[k]),
                    half,
                };
                reads = Some(reads.map_or(own, |r| r.joined(&own)));
            }
        });
        reads
    }
}

impl Fitted {
    /// How much wider than it is a ball of this radius would have to be, so that where
    /// cones from receivers to it cut planes across the view follows from similar
    /// triangles: the largest 1/cos(ψ + θ) of angles off the view's axis and half angles
    /// of cones, no more than `most`.
    pub(crate) fn widening(&self, around: &Surroundings<'_>, radius: f64, most: f64) -> f64 {
        let mut widening = 1.0f64;
        receivers_beyond(around, &self.frame, self.region, self.range[0], |polygon| {
            let nearest = polygon.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            let sine = radius / nearest;
            let tangent = |p: &DVec3| p.truncate().length() / p.z;
            let steepest = polygon.iter().map(tangent).fold(0.0, f64::max);
            if polygon.is_empty() {
                return;
            }
            let cosine = 1.0 / (1.0 + steepest * steepest).sqrt();
            // cos ψ cos θ − sin ψ sin θ.
            let both = cosine * ((1.0 - sine * sine).max(0.0).sqrt() - steepest * sine);
            let own = if sine < 1.0 && both > 0.0 {
                1.0 / both
            } else {
                most
            };
            widening = widening.max(own);
        });
        widening.min(most)
    }
}

impl Reads {
    fn joined(&self, other: &Self) -> Self {
        Self {
            low: [0, 1].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1].map(|k| self.high[k].max(other.high[k])),
            half: [0, 1].map(|k| self.half[k].max(other.half[k])),
        }
    }
}
