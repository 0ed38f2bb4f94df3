//! Textures as pictures, as numbers, and as arrays of what is stored.

use gnomon_pipeline::measure::render::SrgbEncoder;
use gnomon_raster::{Error, Format, Subresource, Texture, format};
use image::ExtendedColorType::Rgba32F;
use image::ImageEncoder;
use image::codecs::openexr::OpenExrEncoder;

use crate::documents::numpy_type;
use crate::draw::Picture;

/// What of a texture is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aspect {
    Color,
    Depth,
    Stencil,
}

impl Aspect {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Stencil => "stencil",
        }
    }
}

/// What is stored, as little-endian numbers that NumPy calls `kind`.
pub(crate) struct Array {
    pub(crate) size: [u32; 2],
    pub(crate) kind: &'static str,
    pub(crate) channels: usize,
    pub(crate) bytes: Vec<u8>,
}

/// An image as it is stored; depths of 24 bits take 32.
///
/// # Errors
/// There is no such image, or memory is short.
pub(crate) fn array(texture: &Texture, image: Subresource, of: Aspect) -> Result<Array, Error> {
    let [width, height, _] = texture.mip_size(image.mip);
    let format = texture.descriptor().format;
    let (kind, channels, bytes) = match of {
        Aspect::Color => (
            numpy_type(format),
            format.channels(),
            texture.read_packed(image)?,
        ),
        Aspect::Depth => {
            let depths = texture.read_depth_bits(image)?;
            let bytes = depths.iter().flat_map(|d| d.to_le_bytes());
            (numpy_type(format), 1, bytes.collect())
        }
        Aspect::Stencil => ("|u1", 1, texture.read_stencil(image)?),
    };
    Ok(Array {
        size: [width, height],
        kind,
        channels,
        bytes,
    })
}

/// What an image means: floats, integers, 8-bit channels as they are stored.
pub(crate) struct Values {
    pub(crate) size: [u32; 2],
    pub(crate) channels: usize,
    /// Texel by texel.
    pub(crate) numbers: Vec<f64>,
}

impl Values {
    /// One channel, texel by texel.
    pub(crate) fn channel(&self, number: usize) -> impl Iterator<Item = f64> {
        let texels = self.numbers.chunks_exact(self.channels);
        texels.map(move |t| t[number])
    }
}

/// The numbers of an image.
///
/// # Errors
/// There is no such image, or memory is short.
pub(crate) fn values(texture: &Texture, image: Subresource, of: Aspect) -> Result<Values, Error> {
    let array = array(texture, image, of)?;
    let of = |size: usize, number: &dyn Fn(&[u8]) -> f64| -> Vec<f64> {
        array.bytes.chunks_exact(size).map(number).collect()
    };
    let two = |b: &[u8]| [b[0], b[1]];
    let four = |b: &[u8]| [b[0], b[1], b[2], b[3]];
    let numbers = match array.kind {
        "|u1" => of(1, &|b| b[0].into()),
        "<i2" => of(2, &|b| i16::from_le_bytes(two(b)).into()),
        "<f2" => of(2, &|b| {
            format::f32_from_f16(u16::from_le_bytes(two(b))).into()
        }),
        "<f4" => of(4, &|b| f32::from_le_bytes(four(b)).into()),
        _ => of(4, &|b| u32::from_le_bytes(four(b)).into()),
    };
    Ok(Values {
        size: array.size,
        channels: array.channels,
        numbers,
    })
}

/// Whether every value of a format is a float of 32 bits.
pub(crate) fn fits_floats(format: Format) -> bool {
    format != Format::R32Uint
}

/// An OpenEXR file with the values as 32-bit floats: one channel is grey, missing ones are
/// 0, and alpha is 1.
pub(crate) fn exr(values: &Values) -> Vec<u8> {
    let texel = |t: &[f64]| match *t {
        [v] => [v, v, v, 1.0],
        [r, g] => [r, g, 0.0, 1.0],
        [r, g, b] => [r, g, b, 1.0],
        _ => [t[0], t[1], t[2], t[3]],
    };
    let texels = values.numbers.chunks_exact(values.channels).flat_map(texel);
    let bytes: Vec<u8> = texels.flat_map(|v| (v as f32).to_ne_bytes()).collect();
    let mut out = std::io::Cursor::new(Vec::new());
    let [width, height] = values.size;
    OpenExrEncoder::new(&mut out)
        .write_image(&bytes, width, height, Rgba32F)
        .expect("there are as many values as the size says, and memory takes all writes");
    out.into_inner()
}

/// An image of colours, clamped to 0..=1, encoded as sRGB, and opaque.
///
/// # Errors
/// There is no such image, or memory is short.
pub(crate) fn picture(texture: &Texture, image: Subresource) -> Result<Picture, Error> {
    let [width, height, _] = texture.mip_size(image.mip);
    let encoder = SrgbEncoder::new();
    let texels = texture.read_color(image)?;
    let pixels = texels.iter().map(|t| {
        let [r, g, b, _] = encoder.encode(t.0);
        [r, g, b, 255]
    });
    Ok(Picture {
        size: [width, height],
        pixels: pixels.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_texels(channels: usize) -> Values {
        let numbers = (0..2 * channels).map(|k| 0.5 + k as f64).collect();
        Values {
            size: [2, 1],
            channels,
            numbers,
        }
    }

    #[test]
    fn channels_are_told_apart() {
        let values = two_texels(3);
        for (number, wanted) in [[0.5, 3.5], [1.5, 4.5], [2.5, 5.5]].iter().enumerate() {
            assert_eq!(values.channel(number).collect::<Vec<_>>(), wanted);
        }
    }

    /// One channel is grey, missing ones are 0, alpha is 1 where there is none.
    #[test]
    fn every_channel_is_in_an_exr_file() {
        for (channels, wanted) in [
            (1, [0.5, 0.5, 0.5, 1.0]),
            (2, [0.5, 1.5, 0.0, 1.0]),
            (3, [0.5, 1.5, 2.5, 1.0]),
            (4, [0.5, 1.5, 2.5, 3.5]),
        ] {
            let file = exr(&two_texels(channels));
            let read = image::load_from_memory(&file).unwrap().to_rgba32f();
            assert_eq!(read.get_pixel(0, 0).0, wanted, "{channels}");
            assert_eq!(read.get_pixel(1, 0).0[0], 0.5 + channels as f32);
        }
    }
}
