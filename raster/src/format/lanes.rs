//! Conversions over lanes: what [`super::scalar`] does, sixteen values at a time and
//! without a branch. Halves are converted by integer arithmetic: the same bits on every
//! machine, with or without conversion instructions.

use super::{D24_MAX, Format};
use crate::simd::{F32, LANES, Lanes, U32, each4};

/// The half of smallest exponent that is normal, 2⁻¹⁴, as a float's bits.
const LEAST_NORMAL: u32 = 113 << 23;
/// 2¹⁶, the first power of two beyond the halves, as a float's bits.
const BEYOND: u32 = 143 << 23;
/// 0.5: adding it to a float below 2⁻¹⁴ leaves the half's mantissa in the low bits.
const DENORMAL_MAGIC: u32 = 126 << 23;
/// From a float's exponent to a half's, in a float's bits.
const REBIAS: u32 = 112 << 23;
const INFINITY: u32 = 0x7c00;
const NAN: u32 = 0x7e00;

/// As [`crate::format::f16_from_f32`]: ties to even, every NaN is 0x7e00.
#[inline(always)]
pub(crate) fn half_from_float<L: Lanes>(v: F32<L>) -> U32<L> {
    let l = v.lanes();
    let bits = v.to_bits();
    let sign = bits & U32::splat(l, 0x8000_0000);
    let size = bits ^ sign;
    let magic = U32::splat(l, DENORMAL_MAGIC);
    let small = (size.to_f32_bits() + magic.to_f32_bits()).to_bits() - magic;
    let odd = (size >> 13) & U32::splat(l, 1);
    // A carry out of the mantissa goes to the exponent, up to infinity itself.
    let normal = (size - U32::splat(l, REBIAS) + U32::splat(l, 0xfff) + odd) >> 13;
    let finite = size
        .lt(U32::splat(l, LEAST_NORMAL))
        .select_u32(small, normal);
    let half = size
        .ge(U32::splat(l, BEYOND))
        .select_u32(U32::splat(l, INFINITY), finite)
        | (sign >> 16);
    v.ne(v).select_u32(U32::splat(l, NAN), half)
}

/// As [`crate::format::f32_from_f16`]: exact, every NaN is canonical. Only the low
/// 16 bits count.
#[inline(always)]
pub(crate) fn float_from_half<L: Lanes>(h: U32<L>) -> F32<L> {
    let l = h.l;
    let size = (h & U32::splat(l, 0x7fff)) << 13;
    let sign = (h & U32::splat(l, 0x8000)) << 16;
    let exponent = size & U32::splat(l, INFINITY << 13);
    let normal = size + U32::splat(l, REBIAS);
    // Subnormals: as if the exponent were one more, less what that adds.
    let least = U32::splat(l, LEAST_NORMAL).to_f32_bits();
    let small = ((size + U32::splat(l, LEAST_NORMAL)).to_f32_bits() - least).to_bits();
    let special = normal + U32::splat(l, REBIAS);
    let finite = exponent.eq(U32::splat(l, 0)).select_u32(small, normal);
    let all = exponent
        .eq(U32::splat(l, INFINITY << 13))
        .select_u32(special, finite);
    (all | sign).to_f32_bits().canonical_nan()
}

/// Words by lane: packed formats in the first, others a channel a word.
pub(crate) type Words = [[u32; LANES]; 4];

/// What [`super::decode`] does, over lanes; depth too.
#[inline(always)]
pub(crate) fn decode<L: Lanes>(l: L, format: Format, words: &Words) -> [F32<L>; 4] {
    let first = U32::from_array(l, &words[0]);
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    match format {
        Format::R8Unorm => [unorm8(first, 0), zero, zero, one],
        Format::Rg8Unorm => [unorm8(first, 0), unorm8(first, 8), zero, one],
        Format::Rgba8Unorm => [
            unorm8(first, 0),
            unorm8(first, 8),
            unorm8(first, 16),
            unorm8(first, 24),
        ],
        Format::R16Sint => [((first.to_i32() << 16) >> 16).to_f32(), zero, zero, one],
        Format::R16Float => [float_from_half(first), zero, zero, one],
        Format::Rgba16Float => each4(
            #[inline(always)]
            |i| float_from_half(U32::from_array(l, &words[i])),
        ),
        Format::R32Float | Format::Depth32FloatStencil8 => [first.to_f32_bits(), zero, zero, one],
        Format::Rgba32Float => each4(
            #[inline(always)]
            |i| U32::from_array(l, &words[i]).to_f32_bits(),
        ),
        Format::R32Uint => [unsigned(first), zero, zero, one],
        Format::Depth24Stencil8 => [first.to_i32().to_f32() / D24_MAX as f32, zero, zero, one],
    }
}

/// 1/255 in 16 bits, and the rest: both products of a byte with them and their
/// sum together round as the quotient does (tested for all bytes).
const INVERSE_255: [f32; 2] = [0.003_921_628, -5.937_09e-8];

#[inline(always)]
fn unorm8<L: Lanes>(word: U32<L>, shift: u32) -> F32<L> {
    let byte = ((word >> shift) & U32::splat(word.l, 255))
        .to_i32()
        .to_f32();
    byte * INVERSE_255[0] + byte * INVERSE_255[1]
}

/// An unsigned integer to the nearest float, ties to even.
#[inline(always)]
fn unsigned<L: Lanes>(v: U32<L>) -> F32<L> {
    let high = (v >> 16).to_i32().to_f32();
    let low = (v & U32::splat(v.l, 0xffff)).to_i32().to_f32();
    high * 65536.0 + low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{self, f16_from_f32, f32_from_f16};
    use crate::simd::{SimdLevel, with_lanes};

    #[test]
    fn every_half_becomes_the_float_that_it_is() {
        for level in SimdLevel::available() {
            for first in (0..=u16::MAX).step_by(LANES) {
                let h: [u32; LANES] = core::array::from_fn(|i| u32::from(first) + i as u32);
                let got = with_lanes!(level, l => float_from_half(U32::from_array(l, &h)).to_bits().to_array());
                let expect = h.map(|h| f32_from_f16(h as u16).to_bits());
                assert_eq!(got, expect, "{level} from {first:#x}");
            }
        }
    }

    #[test]
    fn floats_around_every_half_are_rounded_alike() {
        for level in SimdLevel::available() {
            for h in 0..=u16::MAX {
                let at = f32_from_f16(h).to_bits();
                // The half, its neighbours in float, and the middle to the next one.
                let near = [0, 1, u32::MAX, 0xfff, 0x1000, 0x1001, 0x2000, 1 << 22];
                let v: [f32; LANES] = core::array::from_fn(|i| {
                    f32::from_bits(at.wrapping_add(near[i % 8]) ^ ((i as u32 / 8) << 31))
                });
                let got =
                    with_lanes!(level, l => half_from_float(F32::from_array(l, &v)).to_array());
                let expect = v.map(|v| u32::from(f16_from_f32(v)));
                assert_eq!(got, expect, "{level} around {h:#x}: {v:?}");
            }
        }
    }

    /// Words that try each byte, half and a spread of 32-bit patterns.
    fn patterns(format: Format) -> Vec<u32> {
        match format.bytes() {
            1 => (0..=255).collect(),
            2 | 8 => (0..=0xffff).collect(),
            3 => (0..=D24_MAX).step_by(97).collect(),
            _ => (0..=0xffff_ffffu32)
                .step_by(65_521)
                .chain([u32::MAX, 0x7f80_0001, 0xffc0_0000])
                .collect(),
        }
    }

    fn scalar(format: Format, word: u32) -> [f32; 4] {
        let channels = match format {
            Format::Rg8Unorm => [word & 255, word >> 8, 0, 0],
            Format::Rgba8Unorm => word.to_le_bytes().map(u32::from),
            Format::Rgba16Float | Format::Rgba32Float => [word; 4],
            Format::Depth24Stencil8 => return [format::f32_from_d24(word), 0.0, 0.0, 1.0],
            Format::Depth32FloatStencil8 => return [f32::from_bits(word), 0.0, 0.0, 1.0],
            _ => [word, 0, 0, 0],
        };
        format::decode(format, channels)
    }

    #[test]
    fn lanes_decode_like_scalars() {
        for format in Format::ALL {
            for chunk in patterns(format).chunks(LANES) {
                let word: [u32; LANES] = core::array::from_fn(|i| chunk[i % chunk.len()]);
                for level in SimdLevel::available() {
                    let got =
                        with_lanes!(level, l => decode(l, format, &[word; 4]).map(F32::to_array));
                    for i in 0..LANES {
                        let want = scalar(format, word[i]).map(f32::to_bits);
                        assert_eq!(
                            got.map(|c| c[i].to_bits()),
                            want,
                            "{format:?} {:#x} {level}",
                            word[i]
                        );
                    }
                }
            }
        }
    }
}
