//! Points of the unit disc, Poisson-distributed with Gaussian density, and the weights
//! that make their sum that of an integral over the disc.
//!
//! A Poisson disc pattern of even density, by best candidates (Mitchell 1991), is drawn
//! towards the middle: the share of points within a radius becomes that of a normal
//! distribution that ends at 1. The paper names both, and neither constants nor weights.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::truth::oracle::sampled::jitter;

/// Places tried for each point.
const CANDIDATES: u64 = 32;

/// Place and weight 1/(N·p) of `count` points with a standard deviation of `spread`
/// radii.
pub(super) fn gaussian_poisson(count: u32, spread: f64, seed: u64) -> Arc<[[f32; 3]]> {
    let density = Density::new(spread);
    let point = |[radius, angle]: [f64; 2]| {
        let radius = density.radius(radius * radius);
        let [x, y] = [libm::cos(angle), libm::sin(angle)].map(|a| (radius * a) as f32);
        let weight = 1.0 / (f64::from(count) * density.at(radius));
        [x, y, weight as f32]
    };
    poisson_disc(count, seed).into_iter().map(point).collect()
}

/// Radius and angle of points of even density that keep away from each other. Each has a
/// ring of its own, all of one area, so that none crowd at the rim, and is the farthest of
/// some candidates in it from all before.
fn poisson_disc(count: u32, seed: u64) -> Vec<[f64; 2]> {
    let mut rings: Vec<u64> = (0..u64::from(count)).collect();
    rings.sort_by(|a, b| {
        let [a, b] = [a, b].map(|ring| jitter(seed, ring << 32 | 1));
        a.total_cmp(&b)
    });
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(count as usize);
    let mut places: Vec<[f64; 2]> = Vec::with_capacity(count as usize);
    for ring in rings {
        let (mut best, mut farthest) = ([0.0; 2], f64::NEG_INFINITY);
        for candidate in 0..CANDIDATES {
            let key = ring << 32 | (candidate + 1) << 2;
            let share = (ring as f64 + jitter(seed, key)) / f64::from(count);
            let point = [share.sqrt(), TAU * jitter(seed, key | 2)];
            let near = nearest(&places, place(point));
            if near > farthest {
                (best, farthest) = (point, near);
            }
        }
        points.push(best);
        places.push(place(best));
    }
    points
}

fn place([radius, angle]: [f64; 2]) -> [f64; 2] {
    [radius * libm::cos(angle), radius * libm::sin(angle)]
}

/// Square of the distance to the nearest of `places`.
fn nearest(places: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let squares = places
        .iter()
        .map(|[u, v]| (u - x) * (u - x) + (v - y) * (v - y));
    squares.fold(f64::INFINITY, f64::min)
}

/// A normal distribution round the middle of the unit disc, and nothing outside.
struct Density {
    /// Twice the variance.
    scale: f64,
    /// Share of it in the disc.
    inside: f64,
}

/// Spreads beyond this are even densities, to f32.
const EVEN: f64 = 1e4;
/// Spreads below this leave the rim without a chance that f32 could say.
const NARROWEST: f64 = 0.15;

impl Density {
    fn new(spread: f64) -> Self {
        let spread = spread.clamp(NARROWEST, EVEN);
        let scale = 2.0 * spread * spread;
        Self {
            scale,
            inside: -libm::expm1(-1.0 / scale),
        }
    }

    /// The radius within which this share of the points is.
    fn radius(&self, share: f64) -> f64 {
        (-self.scale * libm::log1p(-share * self.inside))
            .sqrt()
            .min(1.0)
    }

    /// Points over area, of one point in all.
    fn at(&self, radius: f64) -> f64 {
        libm::exp(-radius * radius / self.scale) / (PI * self.scale * self.inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sum of f over the disc, as the points have it.
    fn estimate(points: &[[f32; 3]], f: impl Fn(f64, f64) -> f64) -> f64 {
        let each = points.iter().map(|p| p.map(f64::from));
        each.map(|[x, y, weight]| f(x, y) * weight).sum()
    }

    #[test]
    fn weights_make_integrals_over_the_disc() {
        for spread in [0.3, 0.6, 2.0, 1e9] {
            let points = gaussian_poisson(4096, spread, 1);
            let area = estimate(&points, |_, _| 1.0);
            assert!((area - PI).abs() < 0.1, "{spread}: {area}");
            let moment = estimate(&points, |x, y| x * x + y * y);
            assert!((moment - PI / 2.0).abs() < 0.1, "{spread}: {moment}");
            let half = estimate(&points, |x, _| if x > 0.0 { 1.0 } else { 0.0 });
            assert!((half - PI / 2.0).abs() < 0.1, "{spread}: {half}");
            // Negative control: without weights the density is not even.
            let plain = points.iter().map(|[x, y, _]| f64::from(x * x + y * y));
            let plain = plain.sum::<f64>() / 4096.0;
            assert_eq!(
                (plain - 0.5).abs() > 0.03,
                spread < 1.0,
                "{spread}: {plain}"
            );
        }
    }

    /// Their radii are those of a normal distribution, and no two are close.
    #[test]
    fn points_are_normal_and_keep_apart() {
        let spread = 0.5;
        let points = gaussian_poisson(88, spread, 7);
        let within = |r: f32| {
            points
                .iter()
                .filter(|[x, y, _]| x * x + y * y < r * r)
                .count()
        };
        let inside = 1.0 - libm::exp(-1.0 / (2.0 * spread * spread));
        for r in [0.3f32, 0.5, 0.8, 1.0] {
            let share = libm::exp(-f64::from(r * r) / (2.0 * spread * spread));
            let expected = 88.0 * (1.0 - share) / inside;
            assert!(
                (within(r) as f64 - expected).abs() < 7.0,
                "{r}: {}",
                within(r)
            );
        }
        let gaps = |points: &[[f64; 2]]| {
            let gap = |k: usize| nearest(&points[..k], points[k]).sqrt();
            (1..points.len()).map(gap).fold(f64::INFINITY, f64::min)
        };
        let even: Vec<_> = poisson_disc(88, 7).into_iter().map(place).collect();
        // Of 88 random points some two are closer than 0.03.
        assert!(gaps(&even) > 0.07, "{}", gaps(&even));
        assert_ne!(points, gaussian_poisson(88, spread, 8));
        assert_eq!(points, gaussian_poisson(88, spread, 7));
    }
}
