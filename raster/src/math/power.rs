//! x^y for x ≥ 0.
//!
//! 2^(y·log₂ x) with the logarithm in two words of together about 36 bits, in
//! the manner of `e_pow.c` (fdlibm, Ng and Sun): leading parts are cut to 12
//! bits, so that their products are exact without a fused multiply-add.

use super::exponential::{exp2_near, scale};
use super::logarithm::split_any;
use super::real::{NAN, Real};

/// (3·ln((1+s)/(1−s))/(2s) − 3 − s²)/s⁴ in s², |s| ≤ 0.172; error of the
/// logarithm 2⁻⁴³.
const POW: [f32; 4] = [0.599_999_96, 0.428_579_6, 0.332_694_23, 0.293_391_94];
/// 2/(3·ln 2): in one word; and as 12 bits with the rest.
const TWO_THIRDS_LOG2_E: f32 = 0.961_796_7;
const TWO_THIRDS_LOG2_E_PARTS: [f32; 2] = [0.961_914_06, -0.000_117_368_574];
/// Exponents beyond ±2⁶⁰ give the same result as these: 0, 1 or ∞.
const EXPONENT_LIMIT: f32 = 1_152_921_504_606_846_976.0;

/// log₂ of a positive finite x, as a head of 12 bits and a rest.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn log2_in_two<R: Real>(x: R) -> [R; 2] {
    let (m, k) = split_any(x);
    // s = (m − 1)/(m + 1) = s_h + s_l.
    let u = m - 1.0;
    let v = u.lit(1.0) / (m + 1.0);
    let s = u * v;
    let s_h = s.head();
    let t_h = (m + 1.0).head();
    let t_l = m - (t_h - 1.0);
    let s_l = v * ((u - s_h * t_h) - s_h * t_l);
    // 3 + s² + s⁴·P(s²) = t_h + t_l.
    let z = s * s;
    let p = ((z * POW[3] + POW[2]) * z + POW[1]) * z + POW[0];
    let r = (z * z) * p + s_l * (s_h + s);
    let square = s_h * s_h;
    let t_h = ((square + 3.0) + r).head();
    let t_l = r - ((t_h - 3.0) - square);
    // The product with s, then with 2/(3·ln 2).
    let u = s_h * t_h;
    let v = s_l * t_h + t_l * s;
    let p_h = (u + v).head();
    let p_l = v - (p_h - u);
    let z_h = p_h * TWO_THIRDS_LOG2_E_PARTS[0];
    let z_l = p_h * TWO_THIRDS_LOG2_E_PARTS[1] + p_l * TWO_THIRDS_LOG2_E;
    let head = ((z_h + z_l) + k).head();
    [head, z_l - ((head - k) - z_h)]
}

/// 2^(y·(head + rest)).
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn raise<R: Real>(y: R, [head, rest]: [R; 2]) -> R {
    let y_h = y.head();
    let high = y_h * head;
    let low = (y - y_h) * head + y * rest;
    let z = high + low;
    let k = z.limit(-151.0, 129.0).rint();
    let near = scale(exp2_near((high - k) + low), k);
    let near = R::pick(z.gt(z.lit(129.0)), z.lit(f32::INFINITY), near);
    R::pick(z.lt(z.lit(-151.0)), z.lit(0.0), near)
}

/// x^y for x ≥ 0, where −0 counts as 0; NaN for x < 0. As in IEEE 754, 1 where
/// y = 0 or x = 1, whatever the other is.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn pow<R: Real>(x: R, y: R) -> R {
    let (zero, one, infinite) = (x.lit(0.0), x.lit(1.0), x.lit(f32::INFINITY));
    let exponent = y.limit(-EXPONENT_LIMIT, EXPONENT_LIMIT);
    let p = raise(exponent, log2_in_two(x));
    let rising = y.gt(zero);
    let p = R::pick(x.eq(zero), R::pick(rising, zero, infinite), p);
    let p = R::pick(x.eq(infinite), R::pick(rising, infinite, zero), p);
    let p = R::pick(x.lt(zero) | !x.eq(x) | !y.eq(y), x.lit(NAN), p);
    R::pick(x.eq(one) | y.eq(zero), one, p)
}

#[cfg(test)]
mod tests {
    use super::super::check::{Claim, Pairs, bits};
    use super::super::{self as math, scalar};

    crate::math::check::sweep_pairs! {
        pow: Claim { error: 1.25, from: 0.0, to: f32::INFINITY }, libm::pow, Pairs::powers;
    }

    #[test]
    fn special_arguments() {
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        let cases = [
            (nan, 0.0, 1.0),
            (-2.0, -0.0, 1.0),
            (1.0, nan, 1.0),
            (1.0, inf, 1.0),
            (1.0, -inf, 1.0),
            (0.0, 2.0, 0.0),
            (-0.0, 3.0, 0.0),
            (0.0, -2.0, inf),
            (-0.0, -3.0, inf),
            (0.0, inf, 0.0),
            (0.0, -inf, inf),
            (inf, 2.0, inf),
            (inf, -2.0, 0.0),
            (2.0, inf, inf),
            (2.0, -inf, 0.0),
            (0.5, inf, 0.0),
            (0.5, -inf, inf),
            (-2.0, 2.0, nan),
            (-inf, 1.0, nan),
            (nan, 1.0, nan),
            (2.0, nan, nan),
            (2.0, 10.0, 1024.0),
            (3.0, 3.0, 27.0),
            (4.0, 0.5, 2.0),
            (2.0, -149.0, f32::from_bits(1)),
            (f32::from_bits(1), 1.0, f32::from_bits(1)),
            (f32::MAX, 1.0, f32::MAX),
            (f32::MAX, f32::MAX, inf),
            (f32::from_bits(0x3f7f_ffff), f32::MAX, 0.0),
            (f32::from_bits(0x3f80_0001), -f32::MAX, 0.0),
        ];
        for (x, y, want) in cases {
            assert_eq!(bits(scalar::pow(x, y)), bits(want), "{x}^{y}");
        }
    }
}
