//! Sixteen `f32`.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Bytes as _, Simd, SimdBase as _, SimdFloat as _, f32x16};

use super::{I32, LANES, Lanes, Mask, U32};

/// One `f32` a lane, with IEEE arithmetic that rounds once per operation.
#[derive(Clone, Copy)]
pub struct F32<L: Lanes> {
    pub(crate) v: f32x16<L::Isa>,
    pub(crate) l: L,
}

impl<L: Lanes> F32<L> {
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn new(l: L, v: f32x16<L::Isa>) -> Self {
        Self { v, l }
    }

    /// The same value in every lane.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn splat(l: L, x: f32) -> Self {
        Self {
            v: f32x16::splat(l.isa(), x),
            l,
        }
    }

    /// Lane `i` is element `i`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn from_array(l: L, a: &[f32; LANES]) -> Self {
        Self {
            v: f32x16::from_slice(l.isa(), a),
            l,
        }
    }

    /// Element `i` is lane `i`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_array(self) -> [f32; LANES] {
        let mut a = [0.0; LANES];
        self.v.store_slice(&mut a);
        a
    }

    /// Writes lane `i` to element `i`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn store(self, a: &mut [f32; LANES]) {
        self.v.store_slice(a);
    }

    /// The level's token.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn lanes(self) -> L {
        self.l
    }

    /// Absolute value; clears the sign bit, of NaN too.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn abs(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v.abs(),
            ),
            l: self.l,
        }
    }

    /// Correctly rounded square root; NaN below zero.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn sqrt(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.l.round(self.v.sqrt()),
            ),
            l: self.l,
        }
    }

    /// Correctly rounded 1/x.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn recip(self) -> Self {
        Self::splat(self.l, 1.0) / self
    }

    /// Largest integer not above.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn floor(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v.floor(),
            ),
            l: self.l,
        }
    }

    /// Smallest integer not below.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn ceil(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v.ceil(),
            ),
            l: self.l,
        }
    }

    /// Nearest integer, ties to even.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn round_ties_even(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v.round_ties_even(),
            ),
            l: self.l,
        }
    }

    /// `if self < o { self } else { o }`: the second operand where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn min(self, o: Self) -> Self {
        self.lt(o).select_f32(self, o)
    }

    /// `if self > o { self } else { o }`: the second operand where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn max(self, o: Self) -> Self {
        self.gt(o).select_f32(self, o)
    }

    /// `self.max(lo).min(hi)`: NaN becomes `lo`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn clamp(self, lo: f32, hi: f32) -> Self {
        self.max(Self::splat(self.l, lo))
            .min(Self::splat(self.l, hi))
    }

    /// `self < o`; false where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn lt(self, o: Self) -> Mask<L> {
        Mask {
            v: self.l.op(
                #[inline(always)]
                || self.v.simd_lt(o.v),
            ),
            l: self.l,
        }
    }

    /// `self <= o`; false where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn le(self, o: Self) -> Mask<L> {
        Mask {
            v: self.l.op(
                #[inline(always)]
                || self.v.simd_le(o.v),
            ),
            l: self.l,
        }
    }

    /// `self > o`; false where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn gt(self, o: Self) -> Mask<L> {
        Mask {
            v: self.l.op(
                #[inline(always)]
                || self.v.simd_gt(o.v),
            ),
            l: self.l,
        }
    }

    /// `self >= o`; false where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn ge(self, o: Self) -> Mask<L> {
        Mask {
            v: self.l.op(
                #[inline(always)]
                || self.v.simd_ge(o.v),
            ),
            l: self.l,
        }
    }

    /// `self == o`; false where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn eq(self, o: Self) -> Mask<L> {
        Mask {
            v: self.l.op(
                #[inline(always)]
                || self.v.simd_eq(o.v),
            ),
            l: self.l,
        }
    }

    /// `self != o`; true where one is NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn ne(self, o: Self) -> Mask<L> {
        !self.eq(o)
    }

    /// Truncates towards zero; saturates; NaN becomes 0 (as Rust's `as`).
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_i32(self) -> I32<L> {
        I32::new(
            self.l,
            self.l.op(
                #[inline(always)]
                || self.v.to_int_precise(),
            ),
        )
    }

    /// The bits of each float; of every NaN those of the canonical one, since the sign
    /// and payload of a NaN that arithmetic makes differ from machine to machine.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_bits(self) -> U32<L> {
        self.canonical_nan().raw_bits()
    }

    /// The bits of each float as they are: for values that are no NaN, or whose bits
    /// nobody gets to see.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn raw_bits(self) -> U32<L> {
        U32::new(self.l, self.v.bitcast())
    }

    /// Replaces every NaN by the canonical one, `0x7fc0_0000`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn canonical_nan(self) -> Self {
        self.eq(self)
            .select_f32(self, Self::splat(self.l, f32::from_bits(0x7fc0_0000)))
    }

    /// Difference in x inside each 2×2 quad (fine derivative): right minus
    /// left, of the lane's own row.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn quad_ddx(self) -> Self {
        let right = permute(self, [1, 1, 3, 3, 5, 5, 7, 7, 9, 9, 11, 11, 13, 13, 15, 15]);
        let left = permute(self, [0, 0, 2, 2, 4, 4, 6, 6, 8, 8, 10, 10, 12, 12, 14, 14]);
        right - left
    }

    /// Difference in y inside each 2×2 quad (fine derivative): lower row minus
    /// upper row, of the lane's own column.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn quad_ddy(self) -> Self {
        let below = permute(
            self,
            [8, 9, 10, 11, 12, 13, 14, 15, 8, 9, 10, 11, 12, 13, 14, 15],
        );
        let above = permute(self, [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7]);
        below - above
    }
}

/// Lane `i` of the result is lane `order[i]` of `x`.
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn permute<L: Lanes>(x: F32<L>, order: [u8; LANES]) -> F32<L> {
    let mut bytes = [0u8; 64];
    for (i, o) in order.into_iter().enumerate() {
        for k in 0..4 {
            bytes[4 * i + k] = 4 * o + k as u8;
        }
    }
    let idx = fearless_simd::u8x64::from_slice(x.l.isa(), &bytes);
    F32 {
        v: x.l.op(
            #[inline(always)]
            || x.l.isa().swizzle_dyn_precise_f32x16(x.v, idx),
        ),
        l: x.l,
    }
}

impl<L: Lanes> Mask<L> {
    /// `if mask { yes } else { no }`, per lane.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn select_f32(self, yes: F32<L>, no: F32<L>) -> F32<L> {
        F32 {
            v: self.l.op(
                #[inline(always)]
                || self.l.isa().select_f32x16(self.v, yes.v, no.v),
            ),
            l: self.l,
        }
    }
}

impl<L: Lanes> F32<L> {
    /// The larger of the operands' bits as unsigned integers: at most that of
    /// 1.0 exactly where all operands lie in 0..=1 and none is −0 or NaN.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn all_in_unit(v: &[Self; 4]) -> Mask<L> {
        let largest = v[0]
            .raw_bits()
            .max(v[1].raw_bits())
            .max(v[2].raw_bits().max(v[3].raw_bits()));
        largest.le(U32::splat(v[0].l, 1.0f32.to_bits()))
    }
}

macro_rules! float_op {
    ($trait:ident, $method:ident) => {
        impl<L: Lanes> $trait for F32<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn $method(self, o: Self) -> Self {
                Self {
                    v: self.l.op(
                        #[inline(always)]
                        || self.l.round($trait::$method(self.v, o.v)),
                    ),
                    l: self.l,
                }
            }
        }

        impl<L: Lanes> $trait<f32> for F32<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn $method(self, o: f32) -> Self {
                $trait::$method(self, Self::splat(self.l, o))
            }
        }
    };
}
float_op!(Add, add);
float_op!(Sub, sub);
float_op!(Mul, mul);
float_op!(Div, div);

impl<L: Lanes> Neg for F32<L> {
    type Output = Self;
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn neg(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || -self.v,
            ),
            l: self.l,
        }
    }
}
