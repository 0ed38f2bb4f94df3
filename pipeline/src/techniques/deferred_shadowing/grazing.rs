//! Small lights near the horizon of surfaces.
//!
//! A few bands of harmonics know no kink of max(ω·n, 0): where a light sinks below a
//! surface, six leave it 1/4 - 5/32 - 9/256 = 0.059 of what a facing surface has. What the
//! bands leave out of an open surface's transport depends on the angle alone, and on how
//! wide the light is: bands that a disc of its solid angle has not cannot be missed. Times
//! what the vertex leaves visible it is added to the transport towards the light, and to
//! L_s. (The paper has bands alone.)

use std::f64::consts::PI;

use glam::DVec3;

use super::bodies::{Evaluation, Towards};
use super::settings::{Grazing, Settings};
use super::sources::Source;
use crate::geometry::harmonics::{cosine_power, dot};

/// Luminance of linear Rec. 709 RGB.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Cosines at which a remainder is known; the horizon is one of them.
const STEPS: usize = 512;
/// The last band of which is asked how much a disc has of it.
const LAST_BAND: usize = 64;
/// Remainders below this share of a facing surface's transport are none.
const LEAST: f64 = 1e-4;

/// What bands leave out of an open surface's transport towards a light, by the cosine
/// between its normal and the light.
pub(super) struct Remainder(Vec<f64>);

/// Of each light where any is left out; none where the bands are to do.
pub(super) fn remainders(sources: &[Source], settings: &Settings) -> Vec<Remainder> {
    if settings.grazing == Grazing::Bands {
        return Vec::new();
    }
    let of = |s: &Source| Remainder::new(settings.transport.bands, s.solid_angle(DVec3::ZERO));
    sources.iter().map(of).collect()
}

impl Remainder {
    /// After `bands` bands, of a disc of a solid angle, 0 being a direction.
    fn new(bands: usize, angle: f64) -> Self {
        let away = (angle / (2.0 * PI)).min(1.0); // 1 - cos of the disc's half angle
        let lobe = cosine_power(1.0, bands.max(2));
        let zonal = |l: usize, v: f64| v * (2 * l + 1) as f64 / (4.0 * PI * PI);
        let kept = lobe.iter().enumerate().map(|(l, v)| (l, zonal(l, *v)));
        // Of odd bands the cosine has the first alone.
        let missing = even_lobe().skip_while(|(l, _)| *l < bands.max(2));
        let shares = legendre(1.0 - away);
        let lost = missing.map(|(l, v)| (l, zonal(l, v) * (1.0 - cap_share(l, away, &shares))));
        let taken: Vec<(usize, f64)> = kept.chain(lost).collect();
        let at = |k: usize| {
            let cosine = 2.0 * k as f64 / STEPS as f64 - 1.0;
            let values = legendre(cosine);
            let sum: f64 = taken.iter().map(|(l, c)| c * values[*l]).sum();
            cosine.max(0.0) / PI - sum
        };
        let mut table: Vec<f64> = (0..=STEPS).map(at).collect();
        if table.iter().all(|r| r.abs() < LEAST / PI) {
            table.clear();
        }
        Self(table)
    }

    /// At a cosine, between two that are known.
    fn at(&self, cosine: f64) -> f64 {
        let Some(last) = self.0.len().checked_sub(2) else {
            return 0.0;
        };
        let place = (cosine.clamp(-1.0, 1.0) + 1.0) * (STEPS as f64 / 2.0);
        let k = (place as usize).min(last);
        let [low, high] = [self.0[k], self.0[k + 1]];
        low + (high - low) * (place - k as f64)
    }
}

/// Even bands of the cosine from 2 to [`LAST_BAND`], as [`cosine_power`] has them, which
/// loses its digits in high bands.
fn even_lobe() -> impl Iterator<Item = (usize, f64)> {
    let mut central = 1.0;
    (2..=LAST_BAND).step_by(2).map(move |l| {
        central *= (l - 1) as f64 / l as f64;
        let sign = if l % 4 == 2 { 1.0 } else { -1.0 };
        let value = 2.0 * PI * sign * central / ((l + 2) * (l - 1)) as f64;
        (l, value)
    })
}

/// What band `l` of a disc of light has, of what it has of a direction.
fn cap_share(l: usize, away: f64, at_edge: &[f64]) -> f64 {
    if away < 1e-9 {
        return 1.0;
    }
    let between = at_edge[l - 1] - at_edge[l + 1];
    (between / ((2 * l + 1) as f64 * away)).clamp(0.0, 1.0)
}

/// Legendre polynomials up to [`LAST_BAND`] + 1.
fn legendre(x: f64) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for l in 1..=LAST_BAND {
        let k = l as f64;
        let next = ((2.0 * k + 1.0) * x * values[l] - k * values[l - 1]) / (k + 1.0);
        values.push(next);
    }
    values
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

    /// What T towards a light in direction `own` of the body's axes, `t` by the bands,
    /// lacks; and what it lacks where nothing is hidden.
    pub(super) fn lacks(&self, t: f64, own: DVec3, (left, at): (&Remainder, &Towards)) -> [f64; 2] {
        let open = left.at(self.normal.dot(own));
        if open == 0.0 {
            return [0.0; 2];
        }
        let visible = Evaluation::share(t, at.diffuse(&self.open));
        [open * visible, open]
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
    pub(super) fn add(&mut self, energy: [f64; 3], [transport, open]: [f64; 2]) {
        for (sum, e) in self.light.iter_mut().zip(energy) {
            *sum += e * transport;
        }
        self.open += dot(&LUMINANCE, &energy) * open;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(l: usize, angle: f64) -> f64 {
        let away = angle / (2.0 * PI);
        cap_share(l, away, &legendre(1.0 - away))
    }

    #[test]
    fn directions_have_all_of_a_band_and_hemispheres_nothing_of_even_ones() {
        assert_eq!(share(6, 0.0), 1.0);
        // A sun of half a degree.
        assert!(share(6, 6e-5) > 0.999);
        assert!(share(6, 2.0 * PI).abs() < 1e-12);
        // Band 1 of a cap is (1 + cos) / 2, band 2 is cos (1 + cos) / 2.
        assert!((share(1, PI) - 0.75).abs() < 1e-12);
        assert!((share(2, PI) - 0.375).abs() < 1e-12);
    }

    #[test]
    fn bands_of_the_cosine_are_those_of_the_lobe() {
        let lobe = cosine_power(1.0, 13);
        for (l, value) in even_lobe().take(6) {
            assert!((value - lobe[l]).abs() < 1e-9, "{l}: {value} {}", lobe[l]);
        }
    }

    /// Bands and their remainder are the cosine, of a direction; of a wide light nothing
    /// remains.
    #[test]
    fn the_remainder_makes_bands_the_cosine() {
        let left = Remainder::new(6, 0.0);
        assert!(
            (left.at(0.0) * PI + 0.0586).abs() < 1e-4,
            "{}",
            left.at(0.0)
        );
        let lobe = cosine_power(1.0, 6);
        for cosine in [-0.93, -0.2, -0.01, 0.02, 0.3, 1.0] {
            let values = legendre(cosine);
            let bands = lobe
                .iter()
                .enumerate()
                .map(|(l, v)| v * (2 * l + 1) as f64 / (4.0 * PI * PI) * values[l]);
            let all = bands.sum::<f64>() + left.at(cosine);
            assert!((all * PI - cosine.max(0.0)).abs() < 1e-3, "{cosine}: {all}");
        }
        let of = |angle: f64| {
            let left = Remainder::new(6, angle);
            left.0.iter().fold(0.0f64, |most, r| most.max(r.abs() * PI))
        };
        let most = [0.0, 6e-5, 0.01, 0.1, 0.5, 2.0 * PI].map(of);
        assert!(most.windows(2).all(|w| w[1] <= w[0] + 1e-6), "{most:?}");
        assert!(
            most[1] > 0.055 && most[4] < 0.02 && most[5] < 0.006,
            "{most:?}"
        );
    }
}
