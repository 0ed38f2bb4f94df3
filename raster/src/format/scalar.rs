//! Conversions of one value.

use half::f16;

use super::Format;

/// Largest stored value of D24.
pub const D24_MAX: u32 = 0x00ff_ffff;

/// Float to 8-bit unorm: NaN → 0, clamp to 0..=1, then half-even rounding of
/// the float32 product v·255 (the peers' rule).
#[must_use]
pub fn unorm8_from_f32(v: f32) -> u8 {
    let c = if v > 0.0 { v } else { 0.0 };
    let c = if c < 1.0 { c } else { 1.0 };
    (c * 255.0).round_ties_even() as u8
}

/// 8-bit unorm to float: the correctly rounded quotient v/255.
#[must_use]
pub fn f32_from_unorm8(v: u8) -> f32 {
    f32::from(v) / 255.0
}

/// Rounds t/255 to nearest for t in 0..=65025, in integers.
#[must_use]
pub fn div255(t: u32) -> u32 {
    let t = t + 128;
    (t + (t >> 8)) >> 8
}

/// Float to half, ties to even; every NaN becomes 0x7e00.
#[must_use]
pub fn f16_from_f32(v: f32) -> u16 {
    if v.is_nan() {
        0x7e00
    } else {
        f16::from_f32_const(v).to_bits()
    }
}

/// Half to float, exact; every NaN becomes 0x7fc0_0000.
#[must_use]
pub fn f32_from_f16(bits: u16) -> f32 {
    canonical_nan(f16::from_bits(bits).to_f32_const())
}

/// Float to R16Sint: NaN → 0, half-even rounding, saturating.
#[must_use]
pub fn i16_from_f32(v: f32) -> i16 {
    v.round_ties_even() as i16
}

/// The value itself, or the canonical NaN 0x7fc0_0000.
#[must_use]
pub fn canonical_nan(v: f32) -> f32 {
    if v.is_nan() {
        f32::from_bits(0x7fc0_0000)
    } else {
        v
    }
}

/// Float depth in 0..=1 to D24: half-even rounding of the float32 product.
#[must_use]
pub fn d24_from_f32(v: f32) -> u32 {
    let c = if v > 0.0 { v } else { 0.0 };
    let c = if c < 1.0 { c } else { 1.0 };
    (c * D24_MAX as f32).round_ties_even() as u32
}

/// D24 to float: the correctly rounded quotient v/(2²⁴−1).
#[must_use]
pub fn f32_from_d24(v: u32) -> f32 {
    v as f32 / D24_MAX as f32
}

/// Depth in 0..=1 as a stored integer; NaN and −0 become 0.
pub(crate) fn encode_depth(f: Format, v: f32) -> u32 {
    if f == Format::Depth24Stencil8 {
        return d24_from_f32(v);
    }
    let c = if v > 0.0 { v } else { 0.0 };
    (if c < 1.0 { c } else { 1.0 }).to_bits()
}

/// A shader's output as raw channels.
pub(crate) fn encode(f: Format, v: [f32; 4]) -> [u32; 4] {
    match f {
        Format::R8Unorm => [u32::from(unorm8_from_f32(v[0])), 0, 0, 0],
        Format::Rg8Unorm => [
            u32::from(unorm8_from_f32(v[0])),
            u32::from(unorm8_from_f32(v[1])),
            0,
            0,
        ],
        Format::Rgba8Unorm => v.map(|c| u32::from(unorm8_from_f32(c))),
        Format::R16Sint => [u32::from(i16_from_f32(v[0]) as u16), 0, 0, 0],
        Format::R16Float => [u32::from(f16_from_f32(v[0])), 0, 0, 0],
        Format::Rgba16Float => v.map(|c| u32::from(f16_from_f32(c))),
        Format::R32Float => [canonical_nan(v[0]).to_bits(), 0, 0, 0],
        Format::Rgba32Float => v.map(|c| canonical_nan(c).to_bits()),
        Format::R32Uint => [v[0].to_bits(), 0, 0, 0],
        Format::Depth24Stencil8 | Format::Depth32FloatStencil8 => [0; 4],
    }
}

/// Raw channels as floats; missing colour channels are 0, missing alpha 1.
pub(crate) fn decode(f: Format, t: [u32; 4]) -> [f32; 4] {
    let u = |c: u32| f32_from_unorm8(c as u8);
    let h = |c: u32| f32_from_f16(c as u16);
    match f {
        Format::R8Unorm => [u(t[0]), 0.0, 0.0, 1.0],
        Format::Rg8Unorm => [u(t[0]), u(t[1]), 0.0, 1.0],
        Format::Rgba8Unorm => t.map(u),
        Format::R16Sint => [f32::from(t[0] as u16 as i16), 0.0, 0.0, 1.0],
        Format::R16Float => [h(t[0]), 0.0, 0.0, 1.0],
        Format::Rgba16Float => t.map(h),
        Format::R32Float => [f32::from_bits(t[0]), 0.0, 0.0, 1.0],
        Format::Rgba32Float => t.map(f32::from_bits),
        Format::R32Uint => [t[0] as f32, 0.0, 0.0, 1.0],
        Format::Depth24Stencil8 | Format::Depth32FloatStencil8 => [0.0; 4],
    }
}

/// Raw channels as they are stored: formats of several bytes in one word, red lowest.
pub(crate) fn to_stored(f: Format, t: [u32; 4]) -> [u32; 4] {
    match f {
        Format::Rg8Unorm => [t[0] & 0xff | (t[1] & 0xff) << 8, 0, 0, 0],
        Format::Rgba8Unorm => [u32::from_le_bytes(t.map(|c| c as u8)), 0, 0, 0],
        Format::R8Unorm
        | Format::R16Sint
        | Format::R16Float
        | Format::Rgba16Float
        | Format::R32Float
        | Format::Rgba32Float
        | Format::R32Uint
        | Format::Depth24Stencil8
        | Format::Depth32FloatStencil8 => t,
    }
}

/// The raw channels of what [`to_stored`] gives.
pub(crate) fn from_stored(f: Format, t: [u32; 4]) -> [u32; 4] {
    match f {
        Format::Rg8Unorm => [t[0] & 0xff, t[0] >> 8 & 0xff, 0, 0],
        Format::Rgba8Unorm => t[0].to_le_bytes().map(u32::from),
        Format::R8Unorm
        | Format::R16Sint
        | Format::R16Float
        | Format::Rgba16Float
        | Format::R32Float
        | Format::Rgba32Float
        | Format::R32Uint
        | Format::Depth24Stencil8
        | Format::Depth32FloatStencil8 => t,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unorm8_round_trips_and_rounds_half_even() {
        for v in 0..=255u8 {
            assert_eq!(unorm8_from_f32(f32_from_unorm8(v)), v);
        }
        assert_eq!(unorm8_from_f32(0.5 / 255.0), 0);
        assert_eq!(unorm8_from_f32(1.5 / 255.0), 2);
        assert_eq!(unorm8_from_f32(f32::NAN), 0);
        assert_eq!(unorm8_from_f32(f32::INFINITY), 255);
        assert_eq!(unorm8_from_f32(-1.0), 0);
    }

    #[test]
    fn div255_is_exact_rounding_everywhere() {
        for t in 0..=65025u32 {
            let exact = (2 * t + 255) / 510;
            assert_eq!(div255(t), exact, "t = {t}");
        }
    }

    #[test]
    fn halves_round_trip() {
        for b in 0..=u16::MAX {
            let f = f32_from_f16(b);
            if !f.is_nan() {
                assert_eq!(f16_from_f32(f), b);
            }
        }
    }

    #[test]
    fn d24_round_trips() {
        for v in (0..=D24_MAX).step_by(97).chain([D24_MAX]) {
            assert_eq!(d24_from_f32(f32_from_d24(v)), v);
        }
    }
}
