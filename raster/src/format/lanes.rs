//! Conversions over lanes: what [`super::scalar`] does, sixteen values at a time and
//! without a branch: the same bits on every machine, with or without instructions for it.

use super::{D24_MAX, Format};
use crate::simd::{F32, I32, LANES, Lanes, Mask, U16, U32, each4};

/// 2¹⁶, the first power of two beyond the halves, as a float's bits.
const BEYOND: i32 = 143 << 23;
/// 0.5: its last place is that of subnormal halves.
const LEAST_MAGIC: i32 = 126 << 23;
/// Infinity as a half, where [`float_by_arithmetic`] puts it before the exponent is right.
const SHIFTED_INFINITY: u32 = 0x7c00 << 13;
const NAN: i32 = 0x7e00;

/// As [`super::f16_from_f32`]: ties to even, every NaN is 0x7e00.
#[inline(always)]
pub(crate) fn half_from_float<L: Lanes>(v: F32<L>) -> U16<L> {
    let l = v.lanes();
    match l.half_from_float(v.canonical_nan().v) {
        Some(h) => U16::new(l, h),
        None => half_by_arithmetic(v),
    }
}

/// ```text
/// a = min(|v|, 2¹⁶)                  what is larger, NaN too, becomes infinity
/// m = max(2ᵉ⁺¹³, ½), 2ᵉ ≤ a < 2ᵉ⁺¹   a power whose last place is that of the half
/// r = a + m                          one rounding, to that place
/// half = (r − m) + (m − ½) / 2¹³     as bits: mantissa, and exponent
/// ```
///
/// A mantissa that was rounded up to the next power of two carries into the exponent,
/// up to infinity itself.
#[inline(always)]
fn half_by_arithmetic<L: Lanes>(v: F32<L>) -> U16<L> {
    let l = v.lanes();
    let bits = v.raw_bits().to_i32();
    let a = (bits & I32::splat(l, i32::MAX)).min(I32::splat(l, BEYOND));
    let power = a & I32::splat(l, 0xff << 23);
    let m = (power + I32::splat(l, 13 << 23)).max(I32::splat(l, LEAST_MAGIC));
    let sum = a.to_u32().to_f32_bits() + m.to_u32().to_f32_bits();
    let r = sum.raw_bits().to_i32();
    let half = (r - m) + ((m - I32::splat(l, LEAST_MAGIC)) >> 13);
    let sign = (bits >> 16) & I32::splat(l, -0x8000);
    v.eq(v).select_i32(half | sign, I32::splat(l, NAN)).narrow()
}

/// As [`super::f32_from_f16`]: exact, every NaN is canonical.
#[cfg(test)]
#[inline(always)]
pub(crate) fn float_from_half<L: Lanes>(h: U16<L>) -> F32<L> {
    float_or_nan_from_half(h).canonical_nan()
}

/// Exact; a NaN becomes some NaN.
#[inline(always)]
pub(crate) fn float_or_nan_from_half<L: Lanes>(h: U16<L>) -> F32<L> {
    match h.l.float_from_half(h.v) {
        Some(v) => F32::new(h.l, v),
        None => float_by_arithmetic(h.widen()),
    }
}

/// Exponent and mantissa, put where a float has them, make the half's value times
/// 2⁻¹¹², subnormals among them; but infinity and NaN get the largest exponent. Only
/// the low 16 bits count.
#[inline(always)]
fn float_by_arithmetic<L: Lanes>(h: U32<L>) -> F32<L> {
    let l = h.l;
    let shifted = ((h << 16).to_i32() >> 3).to_u32() & U32::splat(l, 0x8fff_e000);
    let scaled = shifted.to_f32_bits() * f32::from_bits((127 + 112) << 23);
    let infinity = U32::splat(l, SHIFTED_INFINITY);
    let special = (shifted & infinity).eq(infinity);
    let exponent = special.select_u32(U32::splat(l, 0xff << 23), U32::splat(l, 0));
    (scaled.raw_bits() | exponent).to_f32_bits()
}

/// Bytes of floats in 0..=1, as [`super::unorm8_from_f32`] has them; other lanes
/// become any byte.
#[inline(always)]
pub(crate) fn unorm8_from_unit<L: Lanes>(v: F32<L>) -> I32<L> {
    // Adding 2²³ rounds a float below 2²² to an integer, ties to even.
    (v * 255.0 + 8_388_608.0).raw_bits().to_i32() & I32::splat(v.lanes(), 0xff)
}

/// Rounded to the nearest integer, ties to even, and limited, as
/// [`super::i16_from_f32`]; and the lanes that fitted.
#[inline(always)]
pub(crate) fn sint16_from_float<L: Lanes>(v: F32<L>) -> (I32<L>, Mask<L>) {
    let l = v.lanes();
    let (lo, hi) = (F32::splat(l, -32768.0), F32::splat(l, 32767.0));
    let rounded = v.round_ties_even();
    let fits = rounded.ge(lo) & rounded.le(hi);
    // NaN goes to 0, as `as` does.
    let limited = rounded.to_i32().max(I32::splat(l, -32768));
    (limited.min(I32::splat(l, 32767)), fits)
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
        Format::R16Float => [float_by_arithmetic(first).canonical_nan(), zero, zero, one],
        Format::Rgba16Float => each4(
            #[inline(always)]
            |i| float_by_arithmetic(U32::from_array(l, &words[i])).canonical_nan(),
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

    /// Converted by the level's instructions, if it has any, and by arithmetic.
    fn halves(level: SimdLevel, v: &[f32; LANES]) -> [[u16; LANES]; 2] {
        let mut halves = [[0; LANES]; 2];
        with_lanes!(level, l => {
            half_from_float(F32::from_array(l, v)).store(&mut halves[0]);
            half_by_arithmetic(F32::from_array(l, v)).store(&mut halves[1]);
        });
        halves
    }

    fn check_halves(bits: &[u32; LANES]) {
        let v = bits.map(f32::from_bits);
        let expect = [v.map(f16_from_f32); 2];
        for level in SimdLevel::available() {
            assert_eq!(halves(level, &v), expect, "{level}: {bits:x?}");
        }
    }

    #[test]
    fn every_half_becomes_the_float_that_it_is() {
        for level in SimdLevel::available() {
            for first in (0..=u16::MAX).step_by(LANES) {
                let h: [u16; LANES] = core::array::from_fn(|i| first + i as u16);
                let got = with_lanes!(level, l => {
                    let h = U16::from_array(l, &h);
                    let by_arithmetic = float_by_arithmetic(h.widen()).canonical_nan();
                    [float_from_half(h), by_arithmetic].map(|v| v.to_bits().to_array())
                });
                let expect = h.map(|h| f32_from_f16(h).to_bits());
                assert_eq!(got, [expect; 2], "{level} from {first:#x}");
            }
        }
    }

    #[test]
    fn floats_around_every_half_are_rounded_alike() {
        for h in 0..=u16::MAX {
            let at = f32_from_f16(h).to_bits();
            // The half, its neighbours in float, and the middle to the next one.
            let near = [0, 1, u32::MAX, 0xfff, 0x1000, 0x1001, 0x2000, 1 << 22];
            check_halves(&core::array::from_fn(|i| {
                at.wrapping_add(near[i % 8]) ^ ((i as u32 / 8) << 31)
            }));
        }
    }

    /// All exponents with mantissas at and beside multiples of every power of two: where
    /// rounding turns, for normal and subnormal halves.
    #[test]
    fn floats_of_every_exponent_are_rounded_alike_at_ties_and_beside_them() {
        let mut mantissas = Vec::new();
        for shift in 0..23 {
            for multiple in [1u32, 2, 3, 4, 5, 7, 8] {
                let from_below = multiple << shift;
                for at in [from_below, from_below.wrapping_neg()] {
                    for beside in [0, 1, u32::MAX] {
                        mantissas.push(at.wrapping_add(beside) & 0x7f_ffff);
                    }
                }
            }
        }
        mantissas.sort_unstable();
        mantissas.dedup();
        for exponent in 0..256 {
            for few in mantissas.chunks(LANES / 2) {
                check_halves(&core::array::from_fn(|i| {
                    let sign = u32::from(i < LANES / 2) << 31;
                    sign | exponent << 23 | few[i % few.len()]
                }));
            }
        }
    }

    #[test]
    #[ignore = "all 2³² floats at every level: minutes in a release build"]
    fn every_float_becomes_the_half_next_to_it() {
        use rayon::prelude::*;
        (0..1u32 << 28).into_par_iter().for_each(|block| {
            check_halves(&core::array::from_fn(|i| block << 4 | i as u32));
        });
    }

    #[test]
    fn bytes_and_signed_integers_are_rounded_alike() {
        let mut values: Vec<f32> = (0..=510).map(|i| i as f32 / 510.0).collect();
        values.extend((-140_000..140_000).step_by(7).map(|i| i as f32 * 0.25));
        values.extend([
            -0.0,
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MIN_POSITIVE,
            1e-40,
            3e9,
            -3e9,
            32767.5,
            -32768.5,
            32767.498,
        ]);
        for few in values.chunks(LANES) {
            let v: [f32; LANES] = core::array::from_fn(|i| few[i % few.len()]);
            for level in SimdLevel::available() {
                let (bytes, (integers, fits)) = with_lanes!(level, l => {
                    let v = F32::from_array(l, &v);
                    let (i, fits) = sint16_from_float(v);
                    (unorm8_from_unit(v.clamp(0.0, 1.0)).to_array(), (i.to_array(), fits.bits()))
                });
                assert_eq!(bytes, v.map(|v| i32::from(format::unorm8_from_f32(v))));
                assert_eq!(integers, v.map(|v| i32::from(format::i16_from_f32(v))));
                for (i, v) in v.iter().enumerate() {
                    let r = v.round_ties_even();
                    assert_eq!(fits >> i & 1 != 0, (-32768.0..=32767.0).contains(&r), "{v}");
                }
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
