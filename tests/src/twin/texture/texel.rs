//! From a stored texel to four floats (texture rules, §1).

use gnomon_raster::Format;

use super::super::convert::f16_value;
use super::super::depth::Encoding;
use super::super::image::channels;
use super::is_depth;

/// The texel's floats; channels that the format lacks are 0, alpha 1.
pub(super) fn decode(f: Format, stored: [u32; 4]) -> [f32; 4] {
    let one = |bits: u32| match f {
        Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => bits as f32 / 255.0,
        Format::R16Sint => f32::from(bits as u16 as i16),
        Format::R16Float | Format::Rgba16Float => f16_value(bits),
        Format::R32Uint => bits as f32,
        f if is_depth(f) => Encoding::of(Some(f)).decode(bits),
        _ => f32::from_bits(bits),
    };
    let mut value = [0.0, 0.0, 0.0, 1.0];
    for (v, bits) in value.iter_mut().zip(stored).take(channels(f)) {
        *v = one(bits);
    }
    value
}

/// Each channel, or the canonical NaN.
pub(super) fn canonical(value: [f32; 4]) -> [f32; 4] {
    value.map(|v| {
        if v.is_nan() {
            f32::from_bits(0x7fc0_0000)
        } else {
            v
        }
    })
}

/// What `fetch_texel_bits` shows of a stored texel (§5).
pub(super) fn first_word(f: Format, [a, b, c, d]: [u32; 4]) -> u32 {
    match f {
        Format::Rg8Unorm => a | b << 8,
        Format::Rgba8Unorm => a | b << 8 | c << 16 | d << 24,
        _ => a,
    }
}
