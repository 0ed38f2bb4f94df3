//! Pictures as PNG, in memory.

use image::ExtendedColorType::Rgba8;
use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use gnomon_pipeline::measure::render::RenderError;
use gnomon_raster::memory;

use crate::draw::Picture;

/// Bytes that a pixel takes in a picture, its filtered rows, and the file.
const ROOM: usize = 16;

/// Whether there is memory to draw and encode a picture of `size` pixels.
///
/// # Errors
/// There is not.
pub(crate) fn check_room(size: [u32; 2]) -> Result<(), RenderError> {
    let [w, h] = size.map(|s| s as usize);
    let what = || format!("drawing a picture of {w}x{h} pixels");
    Ok(memory::reserve(&mut Vec::<u8>::new(), w * h * ROOM, what)?)
}

/// The picture as a PNG file.
pub(crate) fn encode(picture: &Picture) -> Vec<u8> {
    let [width, height] = picture.size;
    let mut out = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut out, CompressionType::Default, FilterType::Adaptive);
    encoder
        .write_image(picture.pixels.as_flattened(), width, height, Rgba8)
        .expect("a picture has as many pixels as its size says, and memory takes all writes");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_memory_cannot_hold_is_an_error() {
        check_room([8192, 8192]).expect("a gigabyte of addresses");
        let error = check_room([u32::MAX, 1 << 27]).unwrap_err().to_string();
        assert!(error.contains("4294967295x134217728"), "{error}");
    }

    #[test]
    fn pictures_survive() {
        let picture = Picture {
            size: [2, 1],
            pixels: vec![[1, 2, 3, 255], [4, 5, 6, 255]],
        };
        let read = image::load_from_memory(&encode(&picture)).unwrap();
        assert_eq!(read.to_rgba8().into_raw(), picture.pixels.as_flattened());
    }
}
