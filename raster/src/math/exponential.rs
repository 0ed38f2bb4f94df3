//! e^x and 2^x.
//!
//! The argument is split into an integer k, which goes to the exponent in two
//! exact steps (so that results below the normal range are rounded once more,
//! and only once), and a rest of at most ½ (·ln 2) for a polynomial.

use core::f32::consts::LOG2_E;

use super::real::Real;

/// ln 2 in 16 bits, and the rest.
pub(super) const LN_2: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];

/// (2^f − 1)/f, |f| ≤ ½, error of 2^f 2⁻²⁷.
const EXP2: [f32; 6] = [
    core::f32::consts::LN_2,
    0.240_226_5,
    0.055_503_573,
    0.009_618_238,
    0.001_339_076,
    0.000_154_035_36,
];
/// (e^r − 1 − r)/r², |r| ≤ ½·ln 2, error of e^r 2⁻²⁸.
const EXP: [f32; 5] = [
    0.499_999_94,
    0.166_665_17,
    0.041_668_113,
    0.008_369_213,
    0.001_383_821_5,
];

/// `p·2^k` for an integer −151 ≤ k ≤ 129, the last product rounded.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
pub(super) fn scale<R: Real>(p: R, k: R) -> R {
    let half = (k * 0.5).floor();
    (p * R::pow2(half)) * R::pow2(k - half)
}

/// 2^f, |f| ≤ ½ (a little more does no harm).
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
pub(super) fn exp2_near<R: Real>(f: R) -> R {
    let [a, b, c, d, e, g] = EXP2;
    let p = (((f * g + e) * f + d) * f + c) * f + b;
    let one = f.lit(1.0);
    let linear = f * a;
    let s = one + linear;
    let lost = (one - s) + linear;
    s + (p * (f * f) + lost)
}

/// 2^x, exact for integers.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn exp2<R: Real>(x: R) -> R {
    let t = x.limit(-151.0, 129.0);
    let k = t.rint();
    let y = scale(exp2_near(t - k), k);
    R::pick(x.eq(x), y, x.lit(super::real::NAN))
}

/// e^x.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn exp<R: Real>(x: R) -> R {
    let t = x.limit(-104.5, 89.25);
    let k = (t * LOG2_E).rint();
    let high = t - k * LN_2[0];
    let low = k * LN_2[1];
    let r = high - low;
    let lost = (high - r) - low;
    let [a, b, c, d, e] = EXP;
    let p = (((r * e + d) * r + c) * r + b) * r + a;
    let near = (r + (p * (r * r) + lost)) + 1.0;
    R::pick(x.eq(x), scale(near, k), x.lit(super::real::NAN))
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, bits};
    use super::super::{self as math, scalar};

    crate::math::check::sweep! {
        exp: Claim { error: 1.0, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::exp;
        exp2: Claim { error: 1.0, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::exp2;
    }

    #[test]
    fn powers_of_two_are_exact_and_ends_are_right() {
        for k in -149..=127 {
            let exact = f64::from_bits(((k + 1023) as u64) << 52) as f32;
            assert_eq!(scalar::exp2(k as f32), exact, "2^{k}");
        }
        for f in [scalar::exp as fn(f32) -> f32, scalar::exp2] {
            assert_eq!(f(0.0), 1.0);
            assert_eq!(f(-0.0), 1.0);
            assert_eq!(f(f32::INFINITY), f32::INFINITY);
            assert_eq!(f(200.0), f32::INFINITY);
            assert_eq!(bits(f(f32::NEG_INFINITY)), 0);
            assert_eq!(bits(f(-200.0)), 0);
            assert_eq!(bits(f(-f32::NAN)), 0x7fc0_0000);
        }
    }
}
