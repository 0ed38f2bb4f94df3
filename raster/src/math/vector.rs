//! Small vectors. The order of the additions is part of the definition:
//! from the first component to the last.

use super::real::Real;

/// `a·b`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn dot2<R: Real>(a: [R; 2], b: [R; 2]) -> R {
    a[0] * b[0] + a[1] * b[1]
}

/// `a·b`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn dot3<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// `a·b`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn dot4<R: Real>(a: [R; 4], b: [R; 4]) -> R {
    ((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) + a[3] * b[3]
}

/// Cross product.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// √(a·a).
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn length<R: Real>(a: [R; 3]) -> R {
    dot3(a, a).sqrt()
}

/// Each component times 1/√(a·a); zero where a·a is not positive.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn normalize<R: Real>(a: [R; 3]) -> [R; 3] {
    let square = dot3(a, a);
    let zero = square.lit(0.0);
    let scale = R::pick(square.gt(zero), square.lit(1.0) / square.sqrt(), zero);
    [a[0] * scale, a[1] * scale, a[2] * scale]
}

/// `i − 2·(n·i)·n`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn reflect<R: Real>(i: [R; 3], n: [R; 3]) -> [R; 3] {
    let twice = dot3(n, i) * 2.0;
    [
        i[0] - twice * n[0],
        i[1] - twice * n[1],
        i[2] - twice * n[2],
    ]
}

/// `a + t·(b − a)`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn mix<R: Real>(a: R, b: R, t: R) -> R {
    a + t * (b - a)
}

/// To 0..=1; NaN becomes 0.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn saturate<R: Real>(x: R) -> R {
    x.limit(0.0, 1.0)
}

/// 0 below `from`, 1 above `to`, `t²·(3 − 2t)` between.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
#[must_use]
pub fn smoothstep<R: Real>(from: R, to: R, x: R) -> R {
    let t = saturate((x - from) / (to - from));
    t * t * (-(t * 2.0) + 3.0)
}

#[cfg(test)]
mod tests {
    use super::super::{self as math, scalar};
    use crate::simd::{F32, LANES, SimdLevel, with_lanes};

    #[test]
    fn known_values() {
        assert_eq!(scalar::dot2([1.0, 2.0], [3.0, 4.0]), 11.0);
        assert_eq!(scalar::dot3([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]), 32.0);
        assert_eq!(scalar::dot4([1.0, 2.0, 3.0, 4.0], [1.0; 4]), 10.0);
        assert_eq!(
            scalar::cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            [0.0, 0.0, 1.0]
        );
        assert_eq!(scalar::length([3.0, 4.0, 12.0]), 13.0);
        assert_eq!(scalar::normalize([0.0, 4.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(scalar::normalize([0.0; 3]), [0.0; 3]);
        assert_eq!(
            scalar::reflect([1.0, -1.0, 0.0], [0.0, 1.0, 0.0]),
            [1.0, 1.0, 0.0]
        );
        assert_eq!(scalar::mix(2.0, 4.0, 0.5), 3.0);
        assert_eq!(scalar::saturate(f32::NAN), 0.0);
        assert_eq!(scalar::smoothstep(0.0, 2.0, 1.0), 0.5);
    }

    #[test]
    fn lanes_and_scalars_agree() {
        let at = |k: u32| {
            core::array::from_fn::<f32, LANES, _>(|i| (i as f32 + 0.3) * (k as f32 - 1.7) + 0.1)
        };
        let (a, b) = ([at(0), at(1), at(5)], [at(3), at(2), at(9)]);
        for level in SimdLevel::available() {
            let (n, r) = with_lanes!(level, l => {
                let (a, b) = (a.map(|v| F32::from_array(l, &v)), b.map(|v| F32::from_array(l, &v)));
                let n = math::normalize(a);
                (n.map(F32::to_array), math::reflect(math::cross(a, b), n).map(F32::to_array))
            });
            for i in 0..LANES {
                let (a, b) = (a.map(|v| v[i]), b.map(|v| v[i]));
                let want = scalar::normalize(a);
                assert_eq!(n.map(|v| v[i]), want);
                assert_eq!(r.map(|v| v[i]), scalar::reflect(scalar::cross(a, b), want));
            }
        }
    }
}
