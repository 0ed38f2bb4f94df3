//! Sixteen booleans.

use core::ops::{BitAnd, BitOr, BitXor, Not};

use fearless_simd::{SimdMask as _, mask32x16};

use super::Lanes;

/// One boolean a lane.
#[derive(Clone, Copy)]
pub struct Mask<L: Lanes> {
    pub(crate) v: mask32x16<L::Isa>,
    pub(super) l: L,
}

impl<L: Lanes> Mask<L> {
    /// All lanes true, or all false.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn splat(l: L, b: bool) -> Self {
        Self {
            v: mask32x16::splat(l.isa(), b),
            l,
        }
    }

    /// Lane `i` is bit `i`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn from_bits(l: L, bits: u16) -> Self {
        Self {
            v: l.op(
                #[inline(always)]
                || mask32x16::from_bitmask(l.isa(), u64::from(bits)),
            ),
            l,
        }
    }

    /// Bit `i` is lane `i`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn bits(self) -> u16 {
        self.l.op(
            #[inline(always)]
            || self.v.to_bitmask() as u16,
        )
    }

    /// Whether any lane is true.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn any(self) -> bool {
        self.bits() != 0
    }

    /// Whether every lane is true.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn all(self) -> bool {
        self.bits() == u16::MAX
    }
}

impl<L: Lanes> BitAnd for Mask<L> {
    type Output = Self;
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn bitand(self, o: Self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v & o.v,
            ),
            l: self.l,
        }
    }
}

impl<L: Lanes> BitOr for Mask<L> {
    type Output = Self;
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn bitor(self, o: Self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v | o.v,
            ),
            l: self.l,
        }
    }
}

impl<L: Lanes> BitXor for Mask<L> {
    type Output = Self;
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn bitxor(self, o: Self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || self.v ^ o.v,
            ),
            l: self.l,
        }
    }
}

impl<L: Lanes> Not for Mask<L> {
    type Output = Self;
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn not(self) -> Self {
        Self {
            v: self.l.op(
                #[inline(always)]
                || !self.v,
            ),
            l: self.l,
        }
    }
}
