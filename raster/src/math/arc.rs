//! Inverse trigonometric functions, all from one arctangent of a quotient.
//!
//! atan2 folds (x, y) into the octant 0 ≤ b ≤ a; beyond tan(π/8) it turns by
//! π/4, (b − a)/(b + a), so that one division and an odd polynomial on
//! |t| ≤ √2 − 1 suffice. The multiples of π/4 are added in two words.

use super::real::Real;

/// (atan t − t)/t³ in t², |t| ≤ √2 − 1, relative error of atan t 2⁻³⁰.
const ATAN: [f32; 5] = [
    -0.333_333_16,
    0.199_985_28,
    -0.142_443_78,
    0.105_989_456,
    -0.060_891_65,
];
const TAN_PI_8: f32 = 0.414_213_57;
const PI_4: [f32; 2] = [core::f32::consts::FRAC_PI_4, -2.185_569_4e-8];
const PI_2: [f32; 2] = [core::f32::consts::FRAC_PI_2, -4.371_139e-8];
const PI: [f32; 2] = [core::f32::consts::PI, -8.742_278e-8];
const TWO_126: f32 = f32::from_bits(253 << 23);

/// atan(b/a) for 0 ≤ b ≤ a; 0/0 counts as 0, ∞/∞ as 1.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn first_octant<R: Real>(b: R, a: R) -> R {
    let (zero, one) = (a.lit(0.0), a.lit(1.0));
    let none = a.eq(zero);
    let both_infinite = b.eq(b.lit(f32::INFINITY));
    let scale = R::pick(a.gt(a.lit(TWO_126)), a.lit(0.25), one);
    let b = R::pick(both_infinite, one, b * scale);
    let a = R::pick(none | both_infinite, one, a * scale);
    let turn = b.gt(a * TAN_PI_8);
    let t = R::pick(turn, b - a, b) / R::pick(turn, b + a, a);
    let z = t * t;
    let p = ((((z * ATAN[4] + ATAN[3]) * z + ATAN[2]) * z + ATAN[1]) * z + ATAN[0]) * z;
    let r = t + p * t;
    R::pick(turn, (r + PI_4[1]) + PI_4[0], r)
}

/// `c − a` with c in two words.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn less<R: Real>(c: [f32; 2], a: R) -> R {
    (a.lit(c[0]) - a) + c[1]
}

/// Angle of the point (x, y) in −π..=π, with the signs and special cases of
/// IEEE 754.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    let (ay, ax) = (y.abs(), x.abs());
    let steep = ay.gt(ax);
    let t = first_octant(R::pick(steep, ax, ay), R::pick(steep, ay, ax));
    let t = R::pick(steep, less(PI_2, t), t);
    let t = R::pick(x.negative(), less(PI, t), t).flip_by(y);
    R::pick(x.eq(x) & y.eq(y), t, x.lit(super::real::NAN))
}

/// Arc tangent in −π/2..=π/2.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn atan<R: Real>(x: R) -> R {
    atan2(x, x.lit(1.0))
}

/// √(1 − x²), as a product that keeps its accuracy near ±1.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn other_leg<R: Real>(x: R) -> R {
    ((-x + 1.0) * (x + 1.0)).sqrt()
}

/// Arc sine in −π/2..=π/2; NaN outside −1..=1.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn asin<R: Real>(x: R) -> R {
    atan2(x, other_leg(x))
}

/// Arc cosine in 0..=π; NaN outside −1..=1.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn acos<R: Real>(x: R) -> R {
    atan2(other_leg(x), x)
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, Pairs, bits};
    use super::super::{self as math, scalar};

    crate::math::check::sweep! {
        atan: Claim { error: 2.5, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::atan;
        asin: Claim { error: 4.0, from: -1.0, to: 1.0 }, libm::asin;
        acos: Claim { error: 4.0, from: -1.0, to: 1.0 }, libm::acos;
    }

    crate::math::check::sweep_pairs! {
        atan2: Claim { error: 2.5, from: f32::NEG_INFINITY, to: f32::INFINITY }, libm::atan2, Pairs::angles;
    }

    #[test]
    fn special_arguments_follow_ieee() {
        let inf = f32::INFINITY;
        let values = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            inf,
            -inf,
            f32::MAX,
            -f32::MAX,
            f32::from_bits(1),
            -1e-30,
        ];
        for y in values {
            for x in values {
                let want = libm::atan2(f64::from(y), f64::from(x)) as f32;
                let got = scalar::atan2(y, x);
                let near = bits(got).abs_diff(bits(want)) <= 1;
                assert!(near, "atan2({y}, {x}) = {got}, not {want}");
            }
        }
        assert_eq!(bits(scalar::atan2(f32::NAN, 1.0)), 0x7fc0_0000);
        assert_eq!(bits(scalar::atan2(1.0, -f32::NAN)), 0x7fc0_0000);
        assert_eq!(bits(scalar::asin(1.5)), 0x7fc0_0000);
        assert_eq!(bits(scalar::acos(-2.0)), 0x7fc0_0000);
    }
}
