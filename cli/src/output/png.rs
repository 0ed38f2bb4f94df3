//! Pictures as PNG, in memory.

use image::ExtendedColorType::Rgba8;
use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::draw::Picture;

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
    fn pictures_survive() {
        let picture = Picture {
            size: [2, 1],
            pixels: vec![[1, 2, 3, 255], [4, 5, 6, 255]],
        };
        let read = image::load_from_memory(&encode(&picture)).unwrap();
        assert_eq!(read.to_rgba8().into_raw(), picture.pixels.as_flattened());
    }
}
