//! Pictures from the bytes of PNG and JPEG files.
//!
//! JPEG is decoded without the instructions of one machine, so that its texels are the same
//! on every other.

use std::io::Cursor;

use gnomon_raster::format::f16_from_f32;
use image::codecs::png::PngDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, Limits};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::error::{MAX_PICTURE_TEXELS, PictureError, PictureKind};
use super::mips::Level;
use crate::world::light_image::linear;

/// What all PNG files begin with.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Bytes that the decoder of PNG takes at most besides texels: a few thousand bytes of a colour
/// profile become any number. A larger one is left out, for none is used.
const BESIDE: u64 = 16 << 20;
/// What all JPEG files begin with.
const JPEG: &[u8] = b"\xff\xd8\xff";

/// The kind of a file, and its texels.
pub(super) fn decode(bytes: &[u8]) -> Result<(PictureKind, Level), PictureError> {
    if bytes.starts_with(PNG) {
        Ok((PictureKind::Png, png(bytes)?))
    } else if bytes.starts_with(JPEG) {
        Ok((PictureKind::Jpeg, jpeg(bytes)?))
    } else {
        Err(PictureError::Unknown)
    }
}

fn undecodable(error: impl std::fmt::Display) -> PictureError {
    PictureError::Undecodable(error.to_string())
}

/// The size, if it may be decoded.
fn checked(size: [u64; 2]) -> Result<[u32; 2], PictureError> {
    let most = u64::from(gnomon_raster::MAX_TEXTURE_SIZE);
    let sides = size.iter().all(|s| (1..=most).contains(s));
    if sides && size[0] * size[1] <= MAX_PICTURE_TEXELS {
        Ok(size.map(|s| s as u32))
    } else {
        Err(PictureError::Size { size })
    }
}

/// Texels that a file says it has; nothing is decoded.
pub(super) fn texels(bytes: &[u8]) -> Result<u64, PictureError> {
    let size = if bytes.starts_with(PNG) {
        png_header(bytes)?.1
    } else if bytes.starts_with(JPEG) {
        jpeg_header(bytes)?.1
    } else {
        return Err(PictureError::Unknown);
    };
    Ok(size.map(u64::from).into_iter().product())
}

/// A decoder and the size of its picture.
type Header<D> = Result<(D, [u32; 2]), PictureError>;

fn png_header(bytes: &[u8]) -> Header<PngDecoder<Cursor<&[u8]>>> {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(BESIDE);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(undecodable)?;
    let (width, height) = decoder.dimensions();
    let size = checked([width, height].map(u64::from))?;
    Ok((decoder, size))
}

fn png(bytes: &[u8]) -> Result<Level, PictureError> {
    let (decoder, size) = png_header(bytes)?;
    let deep = matches!(
        decoder.color_type(),
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16
    );
    let decoded = DynamicImage::from_decoder(decoder).map_err(undecodable)?;
    Ok(if deep {
        of_numbers(size, &table(u16::MAX), &decoded.into_rgb16())
    } else {
        of_numbers(size, &table(u8::MAX.into()), &decoded.into_rgb8())
    })
}

fn jpeg_header(bytes: &[u8]) -> Header<JpegDecoder<&[u8]>> {
    let most = gnomon_raster::MAX_TEXTURE_SIZE as usize;
    let options = DecoderOptions::default()
        .set_use_unsafe(false)
        .set_max_width(most)
        .set_max_height(most);
    let mut decoder = JpegDecoder::new_with_options(bytes, options);
    decoder.decode_headers().map_err(undecodable)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let size = checked([width, height].map(|s| s as u64))?;
    let grey = decoder.get_input_colorspace() == Some(ColorSpace::Luma);
    let wanted = if grey {
        ColorSpace::Luma
    } else {
        ColorSpace::RGB
    };
    decoder.set_options(options.jpeg_set_out_colorspace(wanted));
    Ok((decoder, size))
}

fn jpeg(bytes: &[u8]) -> Result<Level, PictureError> {
    let (mut decoder, size) = jpeg_header(bytes)?;
    let numbers = decoder.decode().map_err(undecodable)?;
    let texels = size[0] as usize * size[1] as usize;
    let bytes = table(u8::MAX.into());
    if numbers.len() == texels {
        let rgb: Vec<u8> = numbers.iter().flat_map(|v| [*v; 3]).collect();
        return Ok(of_numbers(size, &bytes, &rgb));
    }
    if numbers.len() != 3 * texels {
        return Err(undecodable("its colours are neither RGB nor grey"));
    }
    Ok(of_numbers(size, &bytes, &numbers))
}

/// Of each sRGB number up to `most` the linear light, as the bits of a half.
fn table(most: u16) -> Vec<u16> {
    let light = |v: u16| linear(f64::from(v) / f64::from(most)) as f32;
    (0..=most).map(|v| f16_from_f32(light(v))).collect()
}

/// Red, green and blue of each texel.
fn of_numbers<N: Copy + Into<usize>>(size: [u32; 2], table: &[u16], numbers: &[N]) -> Level {
    let one = f16_from_f32(1.0);
    let mut halves = Vec::with_capacity(numbers.len() / 3 * 4);
    for rgb in numbers.as_chunks::<3>().0 {
        halves.extend(rgb.map(|n| table[n.into()]));
        halves.push(one);
    }
    Level::new(size, &halves)
}

#[cfg(test)]
mod tests {
    use image::ImageEncoder as _;

    use super::*;

    fn png_of(image: DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    /// Channels are in order, sRGB is decoded, and a channel of 16 bits is more than one of 8.
    #[test]
    fn texels_are_linear_light_in_their_order() {
        let small = image::RgbImage::from_raw(2, 1, vec![0, 128, 255, 10, 20, 30]).unwrap();
        let (kind, level) = decode(&png_of(small.into())).unwrap();
        assert_eq!((kind, level.size), (PictureKind::Png, [2, 1]));
        let [r, g, b] = level.texel([0, 0]);
        assert_eq!((r, b), (0.0, 1.0));
        assert!((g - 0.215_86).abs() < 1e-4, "{g}");
        let [r, g, b] = level.texel([1, 0]);
        assert!(r < g && g < b && b < 0.014, "{r} {g} {b}");
        let deep = image::ImageBuffer::from_raw(1, 1, vec![32768_u16, 32896, 65535]).unwrap();
        let (_, level) = decode(&png_of(DynamicImage::ImageRgb16(deep))).unwrap();
        let [r, g, _] = level.texel([0, 0]);
        // Half of a step of 8 bits more.
        assert!((g - 0.215_86).abs() < 1e-4 && r < g, "{r} {g}");
        let grey = image::GrayImage::from_raw(1, 1, vec![255]).unwrap();
        assert_eq!(
            decode(&png_of(grey.into())).unwrap().1.texel([0, 0]),
            [1.0; 3]
        );
    }

    /// A JPEG of 8×8 texels of one grey, written by hand: no encoder is at hand.
    #[test]
    fn a_grey_jpeg_is_read() {
        let (kind, level) = decode(&grey_jpeg(8, 8)).unwrap();
        assert_eq!((kind, level.size), (PictureKind::Jpeg, [8, 8]));
        for at in [[0, 0], [7, 7]] {
            let [r, g, b] = level.texel(at);
            assert!(
                (r - 0.215_86).abs() < 4e-3 && r == g && g == b,
                "{r} {g} {b}"
            );
        }
    }

    /// One DC coefficient of 0 to a block: 128 everywhere.
    fn grey_jpeg(width: u16, height: u16) -> Vec<u8> {
        let mut bytes = b"\xff\xd8\xff\xdb\x00\x43\x00".to_vec();
        bytes.extend([1; 64]);
        bytes.extend(b"\xff\xc0\x00\x0b\x08");
        bytes.extend(height.to_be_bytes());
        bytes.extend(width.to_be_bytes());
        bytes.extend(b"\x01\x01\x11\x00");
        // One code of one bit for DC: category 0; the same for AC: end of block.
        for class in [0x00, 0x10] {
            bytes.extend(b"\xff\xc4\x00\x14");
            bytes.push(class);
            bytes.push(1);
            bytes.extend([0; 15]);
            bytes.push(0);
        }
        bytes.extend(b"\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00");
        let blocks = usize::from(width.div_ceil(8)) * usize::from(height.div_ceil(8));
        let bits = 2 * blocks;
        bytes.extend(vec![0; bits / 8]);
        bytes.push(0xff_u8 >> (bits % 8));
        bytes.extend(b"\xff\xd9");
        bytes
    }

    #[test]
    fn what_is_no_picture_or_too_large_is_refused_before_it_is_decoded() {
        assert_eq!(decode(b"").unwrap_err(), PictureError::Unknown);
        assert_eq!(decode(b"GIF89a").unwrap_err(), PictureError::Unknown);
        let whole = png_of(image::RgbImage::new(16, 16).into());
        let cut = decode(&whole[..whole.len() / 2]).unwrap_err();
        assert!(matches!(cut, PictureError::Undecodable(_)), "{cut}");
        // A header of 30000×30000 texels without any data.
        let mut large = whole.clone();
        large[16..24].copy_from_slice(&[0, 0, 0x75, 0x30, 0, 0, 0x75, 0x30]);
        let crc = crc32(&large[12..29]).to_be_bytes();
        large[29..33].copy_from_slice(&crc);
        let problem = decode(&large).unwrap_err();
        assert_eq!(problem, PictureError::Size { size: [30000; 2] });
        let mut jpeg = grey_jpeg(8, 8);
        let at = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).unwrap() + 5;
        jpeg[at..at + 4].copy_from_slice(&[0x75, 0x30, 0x75, 0x30]);
        let problem = decode(&jpeg).unwrap_err();
        assert!(
            matches!(
                problem,
                PictureError::Size { .. } | PictureError::Undecodable(_)
            ),
            "{problem}"
        );
    }

    /// 65 MB of zeros in a file of some thousand bytes.
    #[test]
    fn profiles_that_swell_are_left_out() {
        let with_profile = |length: usize| {
            let mut bytes = Vec::new();
            let mut encoder = image::codecs::png::PngEncoder::new(&mut bytes);
            encoder.set_icc_profile(vec![0; length]).unwrap();
            let written = encoder.write_image(&[7; 3], 1, 1, image::ExtendedColorType::Rgb8);
            written.unwrap();
            bytes
        };
        let profile = |bytes: &[u8]| png_header(bytes).unwrap().0.icc_profile().unwrap();
        assert_eq!(profile(&with_profile(1000)), Some(vec![0; 1000]));
        let bomb = with_profile(65 << 20);
        assert!(bomb.len() < 1 << 20, "{} bytes", bomb.len());
        assert_eq!(profile(&bomb), None);
        assert!(decode(&bomb).is_ok());
    }

    fn crc32(bytes: &[u8]) -> u32 {
        let step = |crc: u32, byte: &u8| {
            (0..8).fold(crc ^ u32::from(*byte), |c, _| {
                if c & 1 == 1 {
                    c >> 1 ^ 0xedb8_8320
                } else {
                    c >> 1
                }
            })
        };
        !bytes.iter().fold(u32::MAX, step)
    }
}
