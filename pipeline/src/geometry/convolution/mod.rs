//! The Fourier expansion of the shadow test in f64, and what suppresses its ringing
//! (Annen et al. 2008, §3.3 and appendix; docs/papers.md, Annen et al. 2008).
//!
//! `S(x) = ½ + 2 Σ sin(c_k x)/c_k, c_k = π(2k − 1)`, is 1 where the receiver is
//! farther than the blocker (x = d − z > 0) and 0 where it is nearer. It has period
//! 2 and is back at ½ for x = 1: depths are scaled so that |x| ≤ 1 − 1/(2M), where
//! the last plateau ends, less what the offset takes. (Eq. 11 prints 2/c_k outside the sum; it belongs inside.)
//!
//! # Ringing
//!
//! The paper gives no constants. On its plateau S swings about 1 with maxima at odd
//! and minima at even multiples of 1/(2M), the lowest being the first, at 1/M. Scaled
//! about ½ by `α = ½/(S(1/M) − ½)` no minimum is below 1, so that limiting to 0..=1
//! leaves no ringing. A lit surface has x = 0 and S = ½, so that half of the
//! transition is taken off its depth, after which it is exactly lit: that is the
//! smallest x with S(x) = S(1/M). Numerator and denominator of the average blocker
//! depth use the same α and offset.

mod fixed;

pub use fixed::{FixedPoint, MAX_FIXED_BITS};

use std::f64::consts::PI;

use gnomon_shaders::convolution::{Expansion, MAX_TERMS};

/// How ringing is kept out of visibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suppression {
    /// Not at all.
    None,
    /// Scaled about ½ until no minimum of the plateau is below 1.
    Scale,
    /// Twice what exceeds ½, as an existing demonstration does: lit surfaces are lit
    /// without an offset, and ringing in shadow is doubled.
    Double,
}

/// The expansion of order M.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series {
    terms: usize,
    suppression: Suppression,
    offset_share: f64,
}

impl Series {
    /// Of `terms` terms, limited to 1..=[`MAX_TERMS`]; `offset_share` of the
    /// half-transition is taken off receivers' depths.
    pub fn new(terms: usize, suppression: Suppression, offset_share: f64) -> Self {
        Self {
            terms: terms.clamp(1, MAX_TERMS),
            suppression,
            offset_share,
        }
    }

    /// c_k, from k = 1.
    pub fn frequency(k: usize) -> f64 {
        PI * (2.0 * k as f64 - 1.0)
    }

    /// Largest depth, and largest |d − z|, that the period has room for: the last
    /// plateau's end, 1 − 1/(2M), or what the offset leaves of it. With the offset x
    /// is as low as −(reach + offset), and a half-transition before −1 the farthest
    /// blockers would begin to darken the nearest receivers.
    pub fn reach(&self) -> f64 {
        /// Depths need some room, however much is taken off them.
        const LEAST: f64 = 0.125;
        let plateau = 1.0 - 0.5 / self.terms as f64;
        let left = 1.0 - self.half_transition() - self.offset();
        plateau.min(left).max(LEAST)
    }

    /// S(x), as it is.
    pub fn step(&self, x: f64) -> f64 {
        let term = |k| {
            let c = Self::frequency(k);
            2.0 * libm::sin(c * x) / c
        };
        0.5 + (1..=self.terms).map(term).sum::<f64>()
    }

    /// S at the plateau's first and lowest minimum. One term has a single maximum and
    /// no minimum; there 1 stands for it.
    pub fn plateau_minimum(&self) -> f64 {
        if self.terms == 1 {
            return 1.0;
        }
        self.step(1.0 / self.terms as f64)
    }

    /// α: what S − ½ is scaled by.
    pub fn scale(&self) -> f64 {
        0.5 / (self.plateau_minimum() - 0.5)
    }

    /// Half the width of the scaled transition: the smallest x with S(x) equal to the
    /// plateau's minimum. S rises from 0 to its first maximum, at 1/(2M).
    pub fn half_transition(&self) -> f64 {
        let target = self.plateau_minimum();
        let (mut low, mut high) = (0.0, 0.5 / self.terms as f64);
        for _ in 0..64 {
            let middle = 0.5 * (low + high);
            if self.step(middle) < target {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// What is taken off receivers' depths.
    pub fn offset(&self) -> f64 {
        self.half_transition() * self.offset_share
    }

    /// Bias and gain of the suppressed expansion, `bias + gain · (S − ½)`.
    pub fn bias_and_gain(&self) -> [f64; 2] {
        match self.suppression {
            Suppression::None => [0.5, 1.0],
            Suppression::Scale => [0.5, self.scale()],
            Suppression::Double => [0.0, 2.0],
        }
    }

    /// 1 − s of one blocker at depth `z` for a receiver at `d`, suppressed and offset,
    /// not limited.
    pub fn blocked(&self, d: f64, z: f64) -> f64 {
        let [bias, gain] = self.bias_and_gain();
        bias + gain * (self.step(d - self.offset() - z) - 0.5)
    }

    /// 1 − s and Eq. 8's numerator, means over blockers at equal weight: what shaders
    /// find from filtered images. `None` without blockers.
    pub fn means(&self, d: f64, blockers: &[f64]) -> Option<[f64; 2]> {
        let sum = |weight: fn(f64) -> f64| {
            let terms = blockers.iter().map(|z| self.blocked(d, *z) * weight(*z));
            terms.sum::<f64>() / blockers.len() as f64
        };
        (!blockers.is_empty()).then(|| [sum(|_| 1.0), sum(|z| z)])
    }

    /// The expansion as shaders use it, rounded once.
    pub fn expansion(&self) -> Expansion {
        let [bias, gain] = self.bias_and_gain();
        let mut frequencies = [0.0; MAX_TERMS];
        for (k, c) in frequencies.iter_mut().enumerate() {
            *c = Self::frequency(k + 1) as f32;
        }
        Expansion {
            terms: self.terms,
            frequencies,
            bias: bias as f32,
            gain: gain as f32,
            offset: self.offset() as f32,
            reach: self.reach() as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scaled(terms: usize) -> Series {
        Series::new(terms, Suppression::Scale, 1.0)
    }

    /// The table of docs/papers.md, Annen et al. 2008, derived.
    #[test]
    fn the_constants_are_those_of_the_minimum() {
        for (terms, alpha) in [(2, 1.178), (4, 1.1214), (8, 1.111), (16, 1.108)] {
            let found = scaled(terms).scale();
            assert!((found - alpha).abs() < 6e-4, "M={terms}: {found}");
        }
        for (terms, offset) in [(4, 0.064), (16, 0.016)] {
            let found = scaled(terms).half_transition();
            assert!((found - offset).abs() < 5e-4, "M={terms}: {found}");
        }
        assert_eq!(Series::new(4, Suppression::Scale, 0.0).reach(), 0.875);
        assert!((scaled(4).reach() - 0.872).abs() < 1e-3);
    }

    /// The first minimum is the lowest of a fine scan of the plateau, up to where
    /// depths reach.
    #[test]
    fn no_minimum_is_lower() {
        for terms in 2..=MAX_TERMS {
            let series = scaled(terms);
            let from = 0.5 / terms as f64;
            let steps = 4000;
            let at = |i: i32| from + (series.reach() - from) * f64::from(i) / f64::from(steps);
            let lowest = (0..=steps).map(|i| series.step(at(i)));
            let lowest = lowest.fold(f64::INFINITY, f64::min);
            let minimum = series.plateau_minimum();
            assert!(
                (lowest - minimum).abs() < 1e-5 && lowest >= minimum - 1e-12,
                "M={terms}: {lowest} {minimum}"
            );
        }
    }

    /// Scaled, offset and limited, the step is 0 on and before the surface and 1
    /// beyond twice the half-transition: no ringing anywhere, only a ramp.
    #[test]
    fn suppression_leaves_a_monotone_ramp() {
        for terms in 1..=MAX_TERMS {
            let series = scaled(terms);
            let width = 2.0 * series.half_transition();
            let limited = |x: f64| series.blocked(x, 0.0).clamp(0.0, 1.0);
            let mut before = 0.0;
            for i in 0..=2000 {
                let x = series.reach() * (f64::from(i) / 1000.0 - 1.0);
                let value = limited(x);
                assert!(x > 0.0 || value < 1e-12, "M={terms}: {value} at {x}");
                assert!(
                    x < width || value > 1.0 - 1e-12,
                    "M={terms}: {value} at {x}"
                );
                assert!(value >= before - 1e-12, "M={terms} at {x}");
                before = value;
            }
        }
        // Without, it rings.
        let plain = Series::new(4, Suppression::None, 0.0);
        assert!(plain.blocked(-0.25, 0.0) > 0.05 && plain.blocked(0.0, 0.0) == 0.5);
    }

    /// One period is wasted on no depth: at the end of the reach a blocker blocks,
    /// and where depths would reach 1 it would half light.
    #[test]
    fn scaled_depths_stay_on_the_plateau() {
        for terms in 1..=MAX_TERMS {
            let plain = Series::new(terms, Suppression::None, 0.0);
            assert!(plain.step(plain.reach()) > 0.99, "M={terms}");
            assert!((plain.step(1.0) - 0.5).abs() < 1e-12, "M={terms}");
        }
    }

    /// Means with the same expansion above and below give the blockers' depth.
    #[test]
    fn the_average_depth_is_that_of_the_blockers() {
        let series = scaled(8);
        let d = 0.8;
        let [blocked, weighted] = series.means(d, &[0.2, 0.3]).unwrap();
        assert!((weighted / blocked - 0.25).abs() < 5e-3);
        // Half of what is seen is the receiver itself: it rings, but by α.
        let mixed = series.means(d, &[0.2, 0.2, d, d]).unwrap();
        assert!((mixed[1] / mixed[0] - 0.2).abs() < 0.02, "{mixed:?}");
        // The numerator from another expansion is off by far more.
        let other = Series::new(8, Suppression::None, 1.0);
        let [_, weighted] = other.means(d, &[0.2, 0.2, d, d]).unwrap();
        assert!((weighted / mixed[0] - 0.2).abs() > 0.02);
        assert_eq!(series.means(d, &[]), None);
    }
}
