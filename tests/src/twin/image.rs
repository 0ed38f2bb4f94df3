//! Images while the twin draws into them.

use gnomon_raster::Format;

use super::case::{DepthImage, TwinCase};
use super::convert::{f16_bits, f32_bits, sint16, unorm8};
use super::depth::Encoding;

/// Depth and stencil, row by row.
#[derive(Clone, Debug)]
pub(super) struct DepthStencil {
    pub(super) format: Format,
    pub(super) depth: Vec<u32>,
    pub(super) stencil: Vec<u8>,
}

impl DepthStencil {
    fn new(image: &DepthImage) -> Self {
        let encoding = Encoding::of(Some(image.format));
        Self {
            format: image.format,
            depth: image.depth.iter().map(|&d| encoding.encode(d)).collect(),
            stencil: image.stencil.clone(),
        }
    }
}

/// All images of a case.
pub(super) struct Images {
    pub(super) color: Vec<super::case::ColorImage>,
    pub(super) depth: Option<DepthStencil>,
}

impl Images {
    pub(super) fn new(case: &TwinCase) -> Self {
        Self {
            color: case.color.clone(),
            depth: case.depth.as_ref().map(DepthStencil::new),
        }
    }
}

/// Channels of a colour format.
pub(super) fn channels(f: Format) -> usize {
    match f {
        Format::Rg8Unorm => 2,
        Format::Rgba8Unorm | Format::Rgba16Float | Format::Rgba32Float => 4,
        _ => 1,
    }
}

/// Bytes of a colour texel.
pub(super) fn texel_bytes(f: Format) -> u64 {
    let channel = match f {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => 1,
        Format::R16Sint | Format::R16Float | Format::Rgba16Float => 2,
        _ => 4,
    };
    channel * channels(f) as u64
}

/// Bytes of the depth aspect, and of the word that holds depth and stencil.
pub(super) fn depth_bytes(f: Format) -> (u64, u64) {
    if f == Format::Depth24Stencil8 {
        (3, 4)
    } else {
        (4, 8)
    }
}

/// A colour as stored texel.
pub(super) fn encode(f: Format, v: [f32; 4]) -> [u32; 4] {
    let one = |v: f32| match f {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => unorm8(v),
        Format::R16Sint => u32::from(sint16(v).0 as i16 as u16),
        Format::R16Float | Format::Rgba16Float => f16_bits(v),
        Format::R32Uint => v.to_bits(),
        _ => f32_bits(v),
    };
    std::array::from_fn(|c| if c < channels(f) { one(v[c]) } else { 0 })
}
