//! Half floats on lanes, by integer arithmetic: the same bits on every machine,
//! with or without conversion instructions.

use super::{F32, Lanes, U32};

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{f16_from_f32, f32_from_f16};
    use crate::simd::{LANES, SimdLevel, with_lanes};

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
}
