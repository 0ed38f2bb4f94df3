//! Attachment and texture formats, and their exact scalar conversions.

use half::f16;

/// Format of a colour attachment or texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Format {
    /// One 8-bit unorm channel.
    R8Unorm,
    /// Two 8-bit unorm channels.
    Rg8Unorm,
    /// Four 8-bit unorm channels.
    Rgba8Unorm,
    /// One signed 16-bit integer channel (a light-intensity buffer, paper I §5).
    R16Sint,
    /// One half-float channel.
    R16Float,
    /// Four half-float channels.
    Rgba16Float,
    /// One float channel.
    R32Float,
    /// Four float channels.
    Rgba32Float,
    /// One unsigned 32-bit integer channel (a summed-area table).
    R32Uint,
    /// 24-bit integer depth and 8-bit stencil.
    Depth24Stencil8,
    /// Float depth and 8-bit stencil.
    Depth32FloatStencil8,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::R8Unorm,
        Self::Rg8Unorm,
        Self::Rgba8Unorm,
        Self::R16Sint,
        Self::R16Float,
        Self::Rgba16Float,
        Self::R32Float,
        Self::Rgba32Float,
        Self::R32Uint,
        Self::Depth24Stencil8,
        Self::Depth32FloatStencil8,
    ];

    /// Whether the format holds depth and stencil.
    #[must_use]
    pub fn is_depth_stencil(self) -> bool {
        matches!(self, Self::Depth24Stencil8 | Self::Depth32FloatStencil8)
    }

    /// Channels of a colour format (1 for the depth aspect).
    #[must_use]
    pub fn channels(self) -> usize {
        match self {
            Self::Rg8Unorm => 2,
            Self::Rgba8Unorm | Self::Rgba16Float | Self::Rgba32Float => 4,
            _ => 1,
        }
    }

    /// Bytes of a colour texel; of the depth aspect for depth formats (D24 = 3).
    #[must_use]
    pub fn bytes(self) -> u64 {
        match self {
            Self::R8Unorm => 1,
            Self::Rg8Unorm | Self::R16Sint | Self::R16Float => 2,
            Self::Depth24Stencil8 => 3,
            Self::Rgba8Unorm | Self::R32Float | Self::R32Uint | Self::Depth32FloatStencil8 => 4,
            Self::Rgba16Float => 8,
            Self::Rgba32Float => 16,
        }
    }

    /// Whether values are integers that are not normalised.
    #[must_use]
    pub fn is_integer(self) -> bool {
        matches!(self, Self::R16Sint | Self::R32Uint)
    }

    /// Whether the format can be blended. 32-bit integers cannot; R16Sint can
    /// with factors `One` and `Zero`, as the papers' light-intensity buffer
    /// needs: integer arithmetic saturating to −32768..=32767.
    #[must_use]
    pub fn is_blendable(self) -> bool {
        !self.is_depth_stencil() && self != Self::R32Uint
    }
}

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
