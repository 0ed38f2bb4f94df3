//! Area lights by stratified shadow rays: a second opinion on [`super::area`].
//!
//! Rays run from the receiver to points of the light through the same BVH, but
//! by its ray queries; nothing is clipped, and no triangle is left out: the
//! receiver's own one is missed because the receiver is lifted off it. Sample k
//! of a pixel lies in cell k of a square grid, jittered by a hash of seed, pixel
//! and k. So an image depends on the seed alone.

use glam::DVec3;

use super::area::VisibilityImage;
use super::area::emitter::{Emitter, FlatLight};
use super::bvh::{Bvh, Ray};
use super::surfaces::{Receiver, Surfaces};
use crate::error::LightError;
use crate::light::{HardLight, LightShape};
use crate::scene::Scene;

/// What the samples of one receiver say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Samples that reached the light.
    pub seen: u32,
    /// All samples.
    pub samples: u32,
}

impl Estimate {
    /// Estimated share of the light that is seen.
    pub fn share(&self) -> f64 {
        f64::from(self.seen) / f64::from(self.samples)
    }

    /// Whether `truth` survives a test at level `risk`: were it the share, an
    /// estimate as far off as this one would come up with at most that
    /// probability. See [`half_width`].
    pub fn is_consistent_with(&self, truth: f64, risk: f64) -> bool {
        (self.share() - truth).abs() <= half_width(truth, f64::from(self.samples), risk)
    }
}

/// Half width of an interval about `truth` that `samples` independent samples'
/// mean leaves with probability at most `risk`: Bernstein's inequality, with the
/// variance of a plain coin, which strata only lower. It holds for any count,
/// not just for large ones.
pub fn half_width(truth: f64, samples: f64, risk: f64) -> f64 {
    let log = libm::log(2.0 / risk);
    let linear = log / (3.0 * samples);
    let variance = (truth * (1.0 - truth)).max(0.0);
    linear + (linear * linear + 2.0 * log * variance / samples).sqrt()
}

/// Shadow rays to one light; build once, query often.
#[derive(Clone, Debug)]
pub struct SampledOracle {
    emitter: Emitter,
    casters: Bvh,
    side: u32,
    seed: u64,
}

impl SampledOracle {
    /// Prepares `side * side` rays per receiver.
    ///
    /// # Errors
    /// The light should have an extent and has none.
    pub fn new(
        surfaces: &Surfaces,
        light: &LightShape,
        side: u32,
        seed: u64,
    ) -> Result<Self, LightError> {
        let triangles: Vec<_> = surfaces.casters().map(|(_, t)| t).collect();
        Self::of_triangles(&triangles, light, side, seed)
    }

    /// The same with any triangles as casters.
    ///
    /// # Errors
    /// As [`SampledOracle::new`].
    pub fn of_triangles(
        triangles: &[[DVec3; 3]],
        light: &LightShape,
        side: u32,
        seed: u64,
    ) -> Result<Self, LightError> {
        Ok(Self {
            emitter: Emitter::new(light)?,
            casters: Bvh::new(triangles),
            side: side.max(1),
            seed,
        })
    }

    /// Casts the rays of one receiver; `pixel` chooses their jitter.
    pub fn estimate(&self, receiver: &Receiver, pixel: u32) -> Estimate {
        let samples = self.side * self.side;
        let seen = match self.emitter.seen_from(receiver.point) {
            Some(light) => {
                let seen = |k: &u32| self.reaches(&light, receiver.point, pixel, *k);
                (0..samples).filter(seen).count() as u32
            }
            None if self.hard_reaches(receiver.point) => samples,
            None => 0,
        };
        Estimate { seen, samples }
    }

    /// Whether sample `k` reaches the light.
    fn reaches(&self, light: &FlatLight<'_>, p: DVec3, pixel: u32, k: u32) -> bool {
        let place = |cell: u32, axis: u64| {
            let key = (u64::from(pixel) << 32 | u64::from(k)) ^ (axis << 63);
            (f64::from(cell) + jitter(self.seed, key)) / f64::from(self.side)
        };
        let unit = [place(k % self.side, 0), place(k / self.side, 1)];
        let target = light.frame.at(on_light(light, unit));
        !self.casters.any(&Ray::new(p, target - p), 0.0..1.0)
    }

    fn hard_reaches(&self, p: DVec3) -> bool {
        let Emitter::Hard(light) = self.emitter else {
            return true; // in a spherical light
        };
        let end = match light {
            HardLight::Point(_) => 1.0,
            HardLight::Directional(_) => f64::INFINITY,
        };
        !self
            .casters
            .any(&Ray::new(p, light.towards_from(p)), 0.0..end)
    }

    /// Estimates every pixel of an image; see [`VisibilityImage::of_scene`].
    pub fn image(
        &self,
        surfaces: &Surfaces,
        scene: &Scene,
        size: [u32; 2],
        row_done: &(dyn Fn() + Sync),
    ) -> VisibilityImage {
        let per_row = || |receiver: &Receiver, pixel| self.estimate(receiver, pixel).share();
        VisibilityImage::of_pixels(surfaces, scene, size, row_done, per_row)
    }
}

/// Carries the unit square onto the light; equal areas stay equal.
fn on_light(light: &FlatLight<'_>, [a, b]: [f64; 2]) -> [f64; 2] {
    if light.is_disc() {
        let (radius, angle) = (a.sqrt(), std::f64::consts::TAU * b);
        return [radius * libm::cos(angle), radius * libm::sin(angle)];
    }
    let apex = light.outline[0];
    let twice = |e: &[[f64; 2]]| {
        let [p, q] = [e[0], e[1]].map(|p| [p[0] - apex[0], p[1] - apex[1]]);
        (p[0] * q[1] - p[1] * q[0], p, q)
    };
    let fan: Vec<_> = light.outline[1..].windows(2).map(twice).collect();
    let mut left = a * fan.iter().map(|(area, ..)| area).sum::<f64>();
    let mut at = 0; // the last triangle takes what rounding leaves
    while at + 1 < fan.len() && left > fan[at].0 {
        left -= fan[at].0;
        at += 1;
    }
    let (area, p, q) = fan[at];
    let along = (left / area).clamp(0.0, 1.0).sqrt();
    [0, 1].map(|k| apex[k] + along * (p[k] * (1.0 - b) + q[k] * b))
}

/// A number in 0..1 from a hash (splitmix64's finaliser, twice).
fn jitter(seed: u64, key: u64) -> f64 {
    let mixed = mix(mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)) ^ key);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
