//! Natural and binary logarithm.
//!
//! x = m·2^k, √½ ≤ m < √2, f = m − 1 (exact), s = f/(2 + f), so that
//! ln m = f − f²/2 + s·(f²/2 + R(s²)), the form of Ng and Sun's `log.c` (fdlibm);
//! R is our own minimax polynomial.

use super::exponential::LN_2;
use super::real::{NAN, Real};

/// (ln((1+s)/(1−s)) − 2s)/s³ in s², |s| ≤ 0.172, error of the logarithm 2⁻³⁵.
const LOG: [f32; 4] = [0.666_666_6, 0.400_009_72, 0.284_987_93, 0.242_788_57];
/// 1/ln 2 in 12 bits, and the rest.
const LOG2_E: [f32; 2] = [1.442_871_1, -0.000_176_052_85];
const TWO_25: f32 = 33_554_432.0;

/// `x = m·2^k` with √½ ≤ m < √2, for any positive finite x.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
pub(super) fn split_any<R: Real>(x: R) -> (R, R) {
    let small = x.lt(x.lit(f32::MIN_POSITIVE));
    let (m, k) = R::pick(small, x * TWO_25, x).split();
    (m, R::pick(small, k - 25.0, k))
}

/// f, f²/2 and s·(f²/2 + R) of m = 1 + f; ln m = f − f²/2 + the last.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn parts<R: Real>(m: R) -> [R; 3] {
    let f = m - 1.0;
    let s = f / (f + 2.0);
    let z = s * s;
    let r = (((z * LOG[3] + LOG[2]) * z + LOG[1]) * z + LOG[0]) * z;
    let half_square = f * f * 0.5;
    [f, half_square, s * (half_square + r)]
}

/// The logarithm's value at 0, ∞, below 0 and NaN; `y` elsewhere.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn ends<R: Real>(x: R, y: R) -> R {
    let zero = x.lit(0.0);
    let infinite = x.lit(f32::INFINITY);
    let y = R::pick(x.eq(zero), -infinite, y);
    let y = R::pick(x.eq(infinite), infinite, y);
    R::pick(x.lt(zero) | !x.eq(x), x.lit(NAN), y)
}

/// Binary logarithm, exact for powers of two: −∞ at ±0, NaN below.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn log2<R: Real>(x: R) -> R {
    let (m, k) = split_any(x);
    let [f, half_square, rest] = parts(m);
    let high = (f - half_square).head();
    let low = ((f - high) - half_square) + rest;
    let y = (((low + high) * LOG2_E[1] + low * LOG2_E[0]) + high * LOG2_E[0]) + k;
    ends(x, y)
}

/// Natural logarithm: −∞ at ±0, NaN below.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn ln<R: Real>(x: R) -> R {
    let (m, k) = split_any(x);
    let [f, half_square, rest] = parts(m);
    let y = k * LN_2[0] - ((half_square - (rest + k * LN_2[1])) - f);
    ends(x, y)
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, bits};
    use super::super::{self as math, scalar};

    crate::math::check::sweep! {
        log2: Claim { error: 1.0, from: 0.0, to: f32::INFINITY }, libm::log2;
        ln: Claim { error: 1.0, from: 0.0, to: f32::INFINITY }, libm::log;
    }

    #[test]
    fn powers_of_two_are_exact_and_ends_are_right() {
        for k in -149..=127 {
            let x = f64::from_bits(((k + 1023) as u64) << 52) as f32;
            assert_eq!(scalar::log2(x), k as f32, "2^{k}");
        }
        for f in [scalar::ln as fn(f32) -> f32, scalar::log2] {
            assert_eq!(bits(f(1.0)), 0);
            assert_eq!(f(0.0), f32::NEG_INFINITY);
            assert_eq!(f(-0.0), f32::NEG_INFINITY);
            assert_eq!(f(f32::INFINITY), f32::INFINITY);
            for x in [
                -1.0,
                f32::NEG_INFINITY,
                -f32::from_bits(1),
                f32::NAN,
                -f32::NAN,
            ] {
                assert_eq!(bits(f(x)), 0x7fc0_0000, "{x}");
            }
        }
    }
}
