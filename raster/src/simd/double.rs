//! Sixteen `f64`, for triangle set-up.

use core::ops::{Add, Div, Mul, Sub};

use fearless_simd::{
    Bytes as _, Simd, SimdBase as _, SimdFloat as _, SimdMask as _, f64x8, i32x16, i64x8, u32x16,
};

use super::{F32, I32, LANES, Lanes, Mask, U32};

/// Added to a double below 2⁵¹ it leaves the nearest integer, ties to even, in
/// the low bits of the mantissa.
pub(crate) const ROUND_MAGIC: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²

/// Nearest integer, ties to even, of a double of magnitude below 2³¹.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
pub(crate) fn round_to_i32(v: f64) -> i32 {
    (v + ROUND_MAGIC).to_bits() as i32
}

/// One `f64` a lane.
#[derive(Clone, Copy)]
pub(crate) struct F64<L: Lanes> {
    lo: f64x8<L::Isa>,
    hi: f64x8<L::Isa>,
    l: L,
}

impl<L: Lanes> F64<L> {
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn splat(l: L, x: f64) -> Self {
        let v = f64x8::splat(l.isa(), x);
        Self { lo: v, hi: v, l }
    }

    /// Exact.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn from_f32(x: F32<L>) -> Self {
        x.l.op(
            #[inline(always)]
            || {
                let (lo, hi) = x.l.isa().widen_f32x16(x.v);
                Self { lo, hi, l: x.l }
            },
        )
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn from_array(l: L, a: &[f64; LANES]) -> Self {
        Self {
            lo: f64x8::from_slice(l.isa(), &a[..8]),
            hi: f64x8::from_slice(l.isa(), &a[8..]),
            l,
        }
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn to_f32(self) -> F32<L> {
        self.l.op(
            #[inline(always)]
            || F32::new(self.l, self.l.isa().narrow_f64x8(self.lo, self.hi)),
        )
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn to_array(self) -> [f64; LANES] {
        let mut a = [0.0; LANES];
        self.lo.store_slice(&mut a[..8]);
        self.hi.store_slice(&mut a[8..]);
        a
    }

    /// Low and high words of each lane's bits.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn words(self) -> (U32<L>, U32<L>) {
        self.l.op(
            #[inline(always)]
            || {
                let (lo, hi): (u32x16<L::Isa>, u32x16<L::Isa>) =
                    (self.lo.bitcast(), self.hi.bitcast());
                let (even, odd) = lo.deinterleave(hi);
                (U32::new(self.l, even), U32::new(self.l, odd))
            },
        )
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn lanes(self) -> L {
        self.l
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn floor(self) -> Self {
        self.l.op(
            #[inline(always)]
            || Self {
                lo: self.lo.floor(),
                hi: self.hi.floor(),
                l: self.l,
            },
        )
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn lt(self, o: Self) -> Mask<L> {
        self.l.op(
            #[inline(always)]
            || {
                let lo = self.lo.simd_lt(o.lo).to_bitmask();
                let hi = self.hi.simd_lt(o.hi).to_bitmask();
                Mask::from_bits(self.l, (lo | hi << 8) as u16)
            },
        )
    }

    /// Nearest integer, ties to even, of lanes limited to ±`limit` < 2³¹.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn round_to_i32(self, limit: f64) -> I32<L> {
        self.l.op(
            #[inline(always)]
            || {
                let isa = self.l.isa();
                let (max, min) = (f64x8::splat(isa, limit), f64x8::splat(isa, -limit));
                let magic = f64x8::splat(isa, ROUND_MAGIC);
                let lo = isa.select_f64x8(self.lo.simd_lt(max), self.lo, max);
                let lo = isa.select_f64x8(lo.simd_gt(min), lo, min);
                let hi = isa.select_f64x8(self.hi.simd_lt(max), self.hi, max);
                let hi = isa.select_f64x8(hi.simd_gt(min), hi, min);
                let (lo, hi): (i64x8<L::Isa>, i64x8<L::Isa>) =
                    ((lo + magic).bitcast(), (hi + magic).bitcast());
                let v: i32x16<L::Isa> = isa.narrow_i64x8(lo, hi);
                I32::new(self.l, v)
            },
        )
    }
}

macro_rules! op {
    ($trait:ident, $method:ident) => {
        impl<L: Lanes> $trait for F64<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn $method(self, o: Self) -> Self {
                self.l.op(
                    #[inline(always)]
                    || Self {
                        lo: $trait::$method(self.lo, o.lo),
                        hi: $trait::$method(self.hi, o.hi),
                        l: self.l,
                    },
                )
            }
        }

        impl<L: Lanes> $trait<f64> for F64<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn $method(self, o: f64) -> Self {
                $trait::$method(self, Self::splat(self.l, o))
            }
        }
    };
}
op!(Add, add);
op!(Sub, sub);
op!(Mul, mul);
op!(Div, div);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{SimdLevel, with_lanes};

    #[test]
    fn rounding_to_integers_is_half_even_at_every_level() {
        let x: [f32; LANES] = [
            0.5, 1.5, 2.5, -0.5, -1.5, 1e6, -1e6, 3e9, -3e9, 0.0, 7.49, 7.51, 1e-9, 2e9, 123.5,
            124.5,
        ];
        let expect: [i32; LANES] =
            core::array::from_fn(|i| f64::from(x[i]).clamp(-2e9, 2e9).round_ties_even() as i32);
        for level in SimdLevel::available() {
            let got = with_lanes!(level, l => F64::from_f32(F32::from_array(l, &x)).round_to_i32(2e9).to_array());
            assert_eq!(got, expect, "{level}");
        }
        for (v, e) in x.iter().zip(expect) {
            if v.abs() < 2e9 {
                assert_eq!(round_to_i32(f64::from(*v)), e);
            }
        }
    }
}
