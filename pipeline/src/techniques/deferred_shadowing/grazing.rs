//! Small lights near the horizon of surfaces.
//!
//! A few bands of harmonics know no kink of max(ω·n, 0): where a light sinks below a
//! surface, six leave it 1/4 - 5/32 - 9/256 = 0.059 of what a facing surface has. A light
//! that is small is as good as one direction, and there the cosine is known: transport
//! towards it becomes the cosine times what the vertex leaves visible of it, and L_s gets
//! the difference. How much of it depends on the light's width: wide lights have nothing
//! in the bands that are missing. (The paper has bands alone.)

use std::f64::consts::PI;

use glam::DVec3;

use super::bodies::{Evaluation, Towards};
use super::settings::{Grazing, Settings};
use super::sources::Source;
use crate::geometry::harmonics::dot;

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// How far transport towards each light is that of a direction, 0..=1.
pub(super) fn weights(sources: &[Source], settings: &Settings) -> Vec<f64> {
    let missing = first_missing(settings.transport.bands);
    let weight = |s: &Source| cap_share(missing, s.solid_angle(DVec3::ZERO));
    match settings.grazing {
        Grazing::Exact => sources.iter().map(weight).collect(),
        Grazing::Bands => Vec::new(),
    }
}

/// The first band from `bands` on that the cosine has: of odd ones it has the first alone.
fn first_missing(bands: usize) -> usize {
    bands.max(2).next_multiple_of(2)
}

/// What band `l` of a disc of light of a solid angle has, of what it has of a direction.
fn cap_share(l: usize, angle: f64) -> f64 {
    let away = angle / (2.0 * PI); // 1 - cos of the disc's half angle
    if away < 1e-9 {
        return 1.0;
    }
    let (before, after) = legendre(l, 1.0 - away.min(1.0));
    ((before - after) / ((2 * l + 1) as f64 * away)).clamp(0.0, 1.0)
}

/// Legendre polynomials `l - 1` and `l + 1`, for `l` of 1 or more.
fn legendre(l: usize, x: f64) -> (f64, f64) {
    let (mut before, mut at) = (1.0, x);
    for k in 1..l {
        let k = k as f64;
        (before, at) = (at, ((2.0 * k + 1.0) * x * at - k * before) / (k + 1.0));
    }
    let k = l as f64;
    (before, ((2.0 * k + 1.0) * x * at - k * before) / (k + 1.0))
}

/// A vertex, as far as small lights are concerned.
pub(super) struct Facing {
    normal: DVec3,
    /// Coefficients of T where nothing is hidden.
    open: Vec<f64>,
}

impl Facing {
    /// One with a normal in the body's axes.
    pub(super) fn new(normal: DVec3, evaluation: &Evaluation) -> Self {
        Self {
            normal,
            open: evaluation.open(normal),
        }
    }

    /// T towards a light of weight `weight` in direction `own` of the body's axes, where
    /// bands give `t`; and how much more than they an open surface has.
    pub(super) fn transport(&self, t: f64, weight: f64, own: DVec3, at: &Towards) -> [f64; 2] {
        let cosine = self.normal.dot(own).max(0.0) / PI;
        let open = at.diffuse(&self.open);
        let exact = cosine * Evaluation::share(t, open);
        [t + weight * (exact - t), weight * (cosine - open)]
    }
}

/// What L_s of a vertex gains, by colour, and the luminance that an open surface gains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Gain {
    pub(super) light: [f64; 3],
    pub(super) open: f64,
}

impl Gain {
    /// Adds a light's.
    pub(super) fn add(&mut self, energy: [f64; 3], transport: f64, open: f64) {
        for (sum, e) in self.light.iter_mut().zip(energy) {
            *sum += e * transport;
        }
        self.open += dot(&LUMINANCE, &energy) * open;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_all_of_a_band_and_hemispheres_nothing_of_even_ones() {
        assert_eq!(cap_share(6, 0.0), 1.0);
        // A sun of half a degree.
        assert!(cap_share(6, 6e-5) > 0.999);
        assert!(cap_share(6, 2.0 * PI).abs() < 1e-12);
        // Band 1 of a cap is (1 + cos) / 2.
        let half = cap_share(1, PI);
        assert!((half - 0.75).abs() < 1e-12, "{half}");
        // Band 2: cos (1 + cos) / 2.
        let second = cap_share(2, PI);
        assert!((second - 0.375).abs() < 1e-12, "{second}");
    }

    #[test]
    fn missing_bands_are_even() {
        assert_eq!(
            [2, 3, 4, 5, 6, 7, 8].map(first_missing),
            [2, 4, 4, 6, 6, 8, 8]
        );
    }
}
