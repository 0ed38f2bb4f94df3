//! Sixteen 16-bit words, as texels are stored, and sixteen bytes.

use core::ops::BitAnd;

use fearless_simd::{
    Bytes as _, Simd, SimdBase as _, SimdMask as _, i16x32, mask16x16, u8x16, u16x16,
};

use super::{I32, LANES, Lanes, U32};

/// One 16-bit word a lane.
#[derive(Clone, Copy)]
pub(crate) struct U16<L: Lanes> {
    pub(crate) v: u16x16<L::Isa>,
    pub(crate) l: L,
}

impl<L: Lanes> U16<L> {
    #[inline(always)]
    pub(crate) fn new(l: L, v: u16x16<L::Isa>) -> Self {
        Self { v, l }
    }

    #[inline(always)]
    pub(crate) fn splat(l: L, x: u16) -> Self {
        let v = u16x16::splat(l.isa(), x);
        Self { v, l }
    }

    #[inline(always)]
    pub(crate) fn from_array(l: L, a: &[u16; LANES]) -> Self {
        let v = u16x16::from_slice(l.isa(), a);
        Self { v, l }
    }

    #[inline(always)]
    pub(crate) fn store(self, a: &mut [u16; LANES]) {
        self.v.store_slice(a);
    }

    #[inline(always)]
    pub(crate) fn eq(self, o: Self) -> Mask16<L> {
        let v = self.l.op(
            #[inline(always)]
            || self.v.simd_eq(o.v),
        );
        Mask16 { v, l: self.l }
    }

    /// The same numbers in 32 bits.
    #[inline(always)]
    pub(crate) fn widen(self) -> U32<L> {
        let isa = self.l.isa();
        // Of twice as many, the half that nobody looks at costs nothing.
        let v = self.l.op(
            #[inline(always)]
            || isa.widen_u16x32(isa.combine_u16x16(self.v, self.v)).0,
        );
        U32::new(self.l, v)
    }
}

impl<L: Lanes> I32<L> {
    /// The low 16 bits of numbers in −32768..=32767. (Narrowing that saturates is
    /// one instruction even where truncation is many.)
    #[inline(always)]
    pub(crate) fn narrow(self) -> U16<L> {
        let isa = self.l.isa();
        let v = self.l.op(
            #[inline(always)]
            || {
                let twice: i16x32<L::Isa> = isa.saturating_narrow_i32x16(self.v, self.v);
                isa.split_i16x32(twice).0.bitcast()
            },
        );
        U16 { v, l: self.l }
    }
}

impl<L: Lanes> U32<L> {
    /// From bytes.
    #[inline(always)]
    pub fn from_bytes(l: L, a: &[u8; LANES]) -> Self {
        let isa = l.isa();
        let v = u8x16::from_slice(isa, a);
        let v = l.op(
            #[inline(always)]
            || {
                let (lo, hi) = isa.widen_u8x16(v);
                isa.combine_u16x8(lo, hi)
            },
        );
        U16 { v, l }.widen()
    }

    /// The low 16 bits of each lane.
    #[inline(always)]
    pub(crate) fn truncate(self) -> U16<L> {
        ((self << 16).to_i32() >> 16).narrow()
    }

    /// Stores the low byte of each lane.
    #[inline(always)]
    pub(crate) fn store_bytes(self, a: &mut [u8; LANES]) {
        let isa = self.l.isa();
        let words = self.truncate().v;
        let bytes = self.l.op(
            #[inline(always)]
            || {
                let (lo, hi) = isa.split_u16x16(words);
                isa.narrow_u16x8(lo, hi)
            },
        );
        bytes.store_slice(a);
    }
}

/// One boolean a lane of [`U16`].
#[derive(Clone, Copy)]
pub(crate) struct Mask16<L: Lanes> {
    v: mask16x16<L::Isa>,
    l: L,
}

impl<L: Lanes> Mask16<L> {
    /// Lane `i` is bit `i`.
    #[inline(always)]
    pub(crate) fn from_bits(l: L, bits: u16) -> Self {
        let v = l.op(
            #[inline(always)]
            || mask16x16::from_bitmask(l.isa(), u64::from(bits)),
        );
        Self { v, l }
    }

    /// Bit `i` is lane `i`.
    #[inline(always)]
    pub(crate) fn bits(self) -> u16 {
        self.l.op(
            #[inline(always)]
            || self.v.to_bitmask() as u16,
        )
    }

    /// `if mask { yes } else { no }`, per lane.
    #[inline(always)]
    pub(crate) fn select(self, yes: U16<L>, no: U16<L>) -> U16<L> {
        let v = self.l.op(
            #[inline(always)]
            || self.l.isa().select_u16x16(self.v, yes.v, no.v),
        );
        U16 { v, l: self.l }
    }
}

impl<L: Lanes> BitAnd for Mask16<L> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, o: Self) -> Self {
        let v = self.l.op(
            #[inline(always)]
            || self.v & o.v,
        );
        Self { v, l: self.l }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{SimdLevel, with_lanes};

    const WORDS: [u16; LANES] = [
        0, 1, 0x7f, 0x80, 0xff, 0x100, 0x7fff, 0x8000, 0x8001, 0xff80, 0xfffe, 0xffff, 3, 4, 5, 6,
    ];

    #[test]
    fn words_and_bytes_survive_widening_and_narrowing() {
        let bytes = WORDS.map(|w| w as u8);
        for level in SimdLevel::available() {
            let (mut words, mut signed, mut low, mut kept) =
                ([0; LANES], [0; LANES], [0; LANES], [0; LANES]);
            let widened = with_lanes!(level, l => {
                let v = U16::from_array(l, &WORDS).widen();
                (v + U32::splat(l, 0xabcd_0000)).truncate().store(&mut words);
                ((v << 16).to_i32() >> 16).narrow().store(&mut signed);
                (v + U32::splat(l, 0xabcd_0000)).store_bytes(&mut low);
                U32::from_bytes(l, &bytes).store_bytes(&mut kept);
                [v.to_array(), U32::from_bytes(l, &bytes).to_array()]
            });
            assert_eq!(widened, [WORDS.map(u32::from), bytes.map(u32::from)]);
            assert_eq!((words, signed), (WORDS, WORDS), "{level}");
            assert_eq!((low, kept), (bytes, bytes), "{level}");
        }
    }

    #[test]
    fn masks_select_words_lane_by_lane() {
        for level in SimdLevel::available() {
            for bits in [0, 1, 0x8000, 0x5aa5, 0xffff] {
                let mut stored = [0; LANES];
                let equal = with_lanes!(level, l => {
                    let mask = Mask16::from_bits(l, bits);
                    let v = mask.select(U16::splat(l, 7), U16::from_array(l, &WORDS));
                    v.store(&mut stored);
                    (v.eq(U16::splat(l, 7)) & mask).bits()
                });
                assert_eq!(equal, bits, "{level}");
                for (i, s) in stored.into_iter().enumerate() {
                    assert_eq!(s, if bits >> i & 1 != 0 { 7 } else { WORDS[i] });
                }
            }
        }
    }
}
