//! Reciprocal square root.

use super::real::Real;

/// 1/√x, two correctly rounded operations: ±∞ at ±0, NaN below.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn rsqrt<R: Real>(x: R) -> R {
    (x.lit(1.0) / x.sqrt()).one_nan()
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, bits};
    use super::super::{self as math, scalar};

    fn reference(x: f64) -> f64 {
        1.0 / x.sqrt()
    }

    crate::math::check::sweep! {
        rsqrt: Claim { error: 1.5, from: 0.0, to: f32::INFINITY }, reference;
    }

    #[test]
    fn special_arguments() {
        assert_eq!(scalar::rsqrt(4.0), 0.5);
        assert_eq!(scalar::rsqrt(0.0), f32::INFINITY);
        assert_eq!(scalar::rsqrt(-0.0), f32::NEG_INFINITY);
        assert_eq!(scalar::rsqrt(f32::INFINITY), 0.0);
        assert_eq!(bits(scalar::rsqrt(-1.0)), 0x7fc0_0000);
    }
}
