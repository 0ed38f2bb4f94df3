//! Attachment and texture formats, and their exact conversions: of one value, and of
//! lanes with the same bits.

pub(crate) mod lanes;
mod scalar;

pub use scalar::*;
pub(crate) use scalar::{decode, encode, encode_depth, from_stored, to_stored};

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
            Self::R8Unorm
            | Self::R16Sint
            | Self::R16Float
            | Self::R32Float
            | Self::R32Uint
            | Self::Depth24Stencil8
            | Self::Depth32FloatStencil8 => 1,
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

    /// Raw channels of a colour that is stored as a shader's output or a clear would be.
    /// Zeros for depth formats.
    #[must_use]
    pub fn stored_color(self, color: [f32; 4]) -> [u32; 4] {
        match self.is_depth_stencil() {
            true => [0; 4],
            false => encode(self, color),
        }
    }

    /// A depth as it is stored: the D24 integer, or the bits of a float.
    #[must_use]
    pub fn stored_depth(self, depth: f32) -> u32 {
        encode_depth(self, depth)
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
