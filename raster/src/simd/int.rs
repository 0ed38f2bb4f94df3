//! Sixteen 32-bit integers, signed and unsigned; all arithmetic wraps.

use core::ops::{Add, BitAnd, BitOr, BitXor, Mul, Not, Shl, Shr, Sub};

use fearless_simd::{Bytes as _, Simd, SimdBase as _, SimdCvtFloat as _, f32x16, i32x16, u32x16};

use super::{F32, LANES, Lanes, Mask};

macro_rules! int_lanes {
    ($name:ident, $vec:ident, $elem:ty, $select:ident, $select_intrinsic:ident, $doc:literal) => {
        #[doc = $doc]
        #[derive(Clone, Copy)]
        pub struct $name<L: Lanes> {
            pub(crate) v: $vec<L::Isa>,
            pub(crate) l: L,
        }

        impl<L: Lanes> $name<L> {
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub(crate) fn new(l: L, v: $vec<L::Isa>) -> Self {
                Self { v, l }
            }

            /// The same value in every lane.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn splat(l: L, x: $elem) -> Self {
                Self { v: $vec::splat(l.isa(), x), l }
            }

            /// Lane `i` is element `i`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn from_array(l: L, a: &[$elem; LANES]) -> Self {
                Self { v: $vec::from_slice(l.isa(), a), l }
            }

            /// Element `i` is lane `i`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn to_array(self) -> [$elem; LANES] {
                let mut a = [0; LANES];
                self.v.store_slice(&mut a);
                a
            }

            /// Writes lane `i` to element `i`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn store(self, a: &mut [$elem; LANES]) {
                self.v.store_slice(a);
            }

            /// The smaller of the two.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn min(self, o: Self) -> Self {
                Self { v: self.l.op(#[inline(always)] || self.v.min(o.v)), l: self.l }
            }

            /// The larger of the two.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn max(self, o: Self) -> Self {
                Self { v: self.l.op(#[inline(always)] || self.v.max(o.v)), l: self.l }
            }

            /// `self == o`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn eq(self, o: Self) -> Mask<L> {
                Mask { v: self.l.op(#[inline(always)] || self.v.simd_eq(o.v)), l: self.l }
            }

            /// `self < o`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn lt(self, o: Self) -> Mask<L> {
                Mask { v: self.l.op(#[inline(always)] || self.v.simd_lt(o.v)), l: self.l }
            }

            /// `self <= o`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn le(self, o: Self) -> Mask<L> {
                Mask { v: self.l.op(#[inline(always)] || self.v.simd_le(o.v)), l: self.l }
            }

            /// `self > o`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn gt(self, o: Self) -> Mask<L> {
                Mask { v: self.l.op(#[inline(always)] || self.v.simd_gt(o.v)), l: self.l }
            }

            /// `self >= o`.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn ge(self, o: Self) -> Mask<L> {
                Mask { v: self.l.op(#[inline(always)] || self.v.simd_ge(o.v)), l: self.l }
            }

            /// Smallest of the sixteen lanes.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn reduce_min(self) -> $elem {
                self.l.op(#[inline(always)] || self.v.reduce_min())
            }

            /// Largest of the sixteen lanes.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn reduce_max(self) -> $elem {
                self.l.op(#[inline(always)] || self.v.reduce_max())
            }
        }

        impl<L: Lanes> Mask<L> {
            /// `if mask { yes } else { no }`, per lane.
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            pub fn $select(self, yes: $name<L>, no: $name<L>) -> $name<L> {
                $name { v: self.l.op(#[inline(always)] || self.l.isa().$select_intrinsic(self.v, yes.v, no.v)), l: self.l }
            }
        }

        int_lanes!(@op $name, Add, add);
        int_lanes!(@op $name, Sub, sub);
        int_lanes!(@op $name, Mul, mul);
        int_lanes!(@op $name, BitAnd, bitand);
        int_lanes!(@op $name, BitOr, bitor);
        int_lanes!(@op $name, BitXor, bitxor);

        impl<L: Lanes> Not for $name<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn not(self) -> Self {
                Self { v: self.l.op(#[inline(always)] || !self.v), l: self.l }
            }
        }

        impl<L: Lanes> Shl<u32> for $name<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn shl(self, n: u32) -> Self {
                Self { v: self.l.op(#[inline(always)] || self.v << n), l: self.l }
            }
        }

        impl<L: Lanes> Shr<u32> for $name<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn shr(self, n: u32) -> Self {
                Self { v: self.l.op(#[inline(always)] || self.v >> n), l: self.l }
            }
        }
    };
    (@op $name:ident, $trait:ident, $method:ident) => {
        impl<L: Lanes> $trait for $name<L> {
            type Output = Self;
            #[cfg_attr(not(gnomon_unoptimised), inline(always))]
            fn $method(self, o: Self) -> Self {
                Self { v: self.l.op(#[inline(always)] || $trait::$method(self.v, o.v)), l: self.l }
            }
        }
    };
}

int_lanes!(
    I32,
    i32x16,
    i32,
    select_i32,
    select_i32x16,
    "One `i32` a lane; `>>` keeps the sign."
);
int_lanes!(
    U32,
    u32x16,
    u32,
    select_u32,
    select_u32x16,
    "One `u32` a lane."
);

impl<L: Lanes> I32<L> {
    /// Nearest float, ties to even.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_f32(self) -> F32<L> {
        F32::new(
            self.l,
            self.l.op(
                #[inline(always)]
                || f32x16::float_from(self.v),
            ),
        )
    }

    /// The same bits, unsigned.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_u32(self) -> U32<L> {
        U32::new(self.l, self.v.bitcast())
    }
}

impl<L: Lanes> U32<L> {
    /// The same bits, signed.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_i32(self) -> I32<L> {
        I32::new(self.l, self.v.bitcast())
    }

    /// `(a0, b0, a1, b1, …, b7)` and `(a8, b8, …, b15)`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn interleave(self, o: Self) -> (Self, Self) {
        let (a, b) = self.l.op(
            #[inline(always)]
            || self.v.interleave(o.v),
        );
        (Self::new(self.l, a), Self::new(self.l, b))
    }

    /// The float with these bits.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn to_f32_bits(self) -> F32<L> {
        F32::new(self.l, self.v.bitcast())
    }
}
