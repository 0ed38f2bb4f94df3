//! Sine and cosine.
//!
//! |x| is reduced to r in about −π/4..=π/4 by Cody–Waite subtraction of k·π/2:
//! π/2 is written as five parts of 8 bits and one of 24, so that for k ≤ 2¹⁶
//! (|x| ≤ [`CODY_WAITE_LIMIT`]) each of the first five products is exact, and
//! the roundings of the subtractions are carried along in a second word.
//! Beyond, the lanes that need it take 2/π to 256 bits in integers (Payne and
//! Hanek 1983), so that every finite argument is reduced properly.

use super::real::Real;

/// π/2 ≈ the sum; 8 significant bits each but the last.
const PI_2: [f32; 6] = [
    1.570_312_5,
    0.000_482_559_2,
    1.266_598_7e-6,
    9.895_302e-10,
    2.557_953_8e-12,
    5.390_303e-15,
];
const TWO_OVER_PI: f32 = 0.636_619_75;
/// Largest |x| that the subtractions reduce: 65535.5·π/2, rounded down.
pub(super) const CODY_WAITE_LIMIT: f32 = 102_940.0;

/// (sin r − r)/r³ in r², |r| ≤ 0.7955, relative error of sin r 2⁻²⁷·⁸.
const SIN: [f32; 3] = [-0.166_666_54, 0.008_332_102, -0.000_195_068_47];
/// (cos r − 1 + r²/2)/r⁴ in r², error 2⁻³²·⁶.
const COS: [f32; 3] = [0.041_666_646, -0.001_388_729_4, 2.442_941e-5];

/// |x| = (4n + quadrant)·π/2 + (r + low).
struct Reduced<R> {
    quadrant: R,
    r: R,
    low: R,
}

/// `a − b` and what the rounding lost (Knuth's two-sum).
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn exact_difference<R: Real>(a: R, b: R) -> (R, R) {
    let d = a - b;
    let bb = a - d;
    let aa = d + bb;
    (d, (a - aa) - (b - bb))
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn reduce<R: Real>(x: R) -> Reduced<R> {
    let k = (x * TWO_OVER_PI).rint();
    let d = (x - k * PI_2[0]) - k * PI_2[1];
    let (d, e2) = exact_difference(d, k * PI_2[2]);
    let (d, e3) = exact_difference(d, k * PI_2[3]);
    let (d, e4) = exact_difference(d, k * PI_2[4]);
    let low = ((e2 + e3) + e4) - k * PI_2[5];
    let r = d + low;
    let low = (d - r) + low;
    let quadrant = k - (k * 0.25).floor() * 4.0;
    let far = x.gt(x.lit(CODY_WAITE_LIMIT)) & x.lt(x.lit(f32::INFINITY));
    let [quadrant, r, low] = x.patch(far, [quadrant, r, low], reduce_far);
    Reduced { quadrant, r, low }
}

/// 2/π after the point, most significant word first.
const TWO_OVER_PI_BITS: [u32; 8] = [
    0xa2f9_836e,
    0x4e44_1529,
    0xfc27_57d1,
    0xf534_ddc0,
    0xdb62_9599,
    0x3c43_9041,
    0xfe51_63ab,
    0xdebb_c561,
];
/// Bits after the point that are kept of x·2/π.
const FRACTION: u32 = 94;

/// 96 bits of 2/π, the first one worth 2^−(skip+1).
fn window(skip: u32) -> u128 {
    let word = |i: u32| u128::from(TWO_OVER_PI_BITS.get(i as usize).copied().unwrap_or(0));
    let (first, shift) = (skip / 32, skip % 32);
    let four = (0..4).fold(0, |w, i| w << 32 | word(first + i));
    (four << shift) >> 32
}

/// Quadrant, r and low part of a finite x > [`CODY_WAITE_LIMIT`]: the integer
/// product of the mantissa with the bits of 2/π that matter modulo 4.
fn reduce_far(x: f32) -> [f32; 3] {
    let mantissa = u128::from(x.to_bits() & 0x007f_ffff | 0x0080_0000);
    // x = mantissa·2^exponent, −7 ≤ exponent ≤ 104.
    let exponent = (x.to_bits() >> 23) as i32 - 150;
    // x·2/π·2⁹⁴ modulo 2⁹⁶: needs the bits of 2/π worth 2^(1−exponent) downwards.
    let product = match u32::try_from(exponent - 2) {
        Ok(skip) => mantissa * window(skip),
        Err(_) => (mantissa * window(0)) >> (2 - exponent),
    };
    let turned = product + (1 << (FRACTION - 1));
    let quadrant = (turned >> FRACTION & 3) as f32;
    let fraction = (turned & ((1 << FRACTION) - 1)) as i128 - (1 << (FRACTION - 1));
    let scale = f64::from_bits(u64::from(1023 - FRACTION) << 52);
    let r = (fraction as f64 * scale) * core::f64::consts::FRAC_PI_2;
    let high = r as f32;
    [quadrant, high, (r - f64::from(high)) as f32]
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn sin_near<R: Real>(r: R, low: R) -> R {
    let z = r * r;
    let p = ((z * SIN[2] + SIN[1]) * z + SIN[0]) * z;
    r + (p * r + low * (-(z * 0.5) + 1.0))
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn cos_near<R: Real>(r: R, low: R) -> R {
    let z = r * r;
    let half = z * 0.5;
    let one = z.lit(1.0);
    let w = one - half;
    let p = ((z * COS[2] + COS[1]) * z + COS[0]) * (z * z);
    w + (((one - w) - half) + (p - r * low))
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn is<R: Real>(quadrant: R, q: f32) -> R::Test {
    quadrant.eq(quadrant.lit(q))
}

/// [`sin`] and [`cos`] of x, for the price of one.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn sin_cos<R: Real>(x: R) -> [R; 2] {
    let Reduced { quadrant, r, low } = reduce(x.abs());
    let (s, c) = (sin_near(r, low), cos_near(r, low));
    let (first, second, third) = (is(quadrant, 1.0), is(quadrant, 2.0), is(quadrant, 3.0));
    let sin = R::pick(first | third, c, s);
    let sin = R::pick(second | third, -sin, sin).flip_by(x);
    let cos = R::pick(first | third, s, c);
    let cos = R::pick(first | second, -cos, cos);
    [sin.one_nan(), cos.one_nan()]
}

/// Sine of x radians, for every finite x; NaN for ±∞.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn sin<R: Real>(x: R) -> R {
    sin_cos(x)[0]
}

/// Cosine of x radians, for every finite x; NaN for ±∞.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn cos<R: Real>(x: R) -> R {
    sin_cos(x)[1]
}

/// Tangent of x radians, the quotient of [`sin`] and [`cos`].
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn tan<R: Real>(x: R) -> R {
    let [s, c] = sin_cos(x);
    (s / c).one_nan()
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, bits};
    use super::super::{self as math, scalar};
    use super::*;

    crate::math::check::sweep! {
        sin: Claim { error: 0.85, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::sin;
        cos: Claim { error: 0.85, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::cos;
        tan: Claim { error: 2.5, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::tan;
    }

    #[test]
    fn special_arguments() {
        assert_eq!(bits(scalar::sin(-0.0)), bits(-0.0));
        assert_eq!(scalar::cos(0.0), 1.0);
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -f32::NAN] {
            assert_eq!(bits(scalar::sin(x)), 0x7fc0_0000);
            assert_eq!(bits(scalar::cos(x)), 0x7fc0_0000);
        }
        assert_eq!(scalar::sin(f32::from_bits(1)), f32::from_bits(1));
    }

    #[test]
    fn both_reductions_meet_at_the_limit() {
        for i in 0..2000 {
            let x = f32::from_bits(CODY_WAITE_LIMIT.to_bits() - i);
            let near = reduce(x);
            let far = reduce_far(x);
            if near.r.abs() > 0.78 {
                continue; // Either quadrant would do.
            }
            assert_eq!(near.quadrant, far[0], "{x}");
            assert!(
                (near.r - far[1]).abs() <= 6e-8,
                "{x}: {} {}",
                near.r,
                far[1]
            );
        }
    }
}
