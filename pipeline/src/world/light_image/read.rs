//! Images of lights from files: PNG, OpenEXR and Radiance.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder as _};
use thiserror::Error;

use super::{LightImage, LightSequence, TexelError};
use crate::world::environment;
use crate::world::files;

/// Bytes of an image that are read at most.
pub const MAX_LIGHT_IMAGE_BYTES: u64 = 16 << 20;

/// Images of a sequence at most.
pub const MAX_LIGHT_IMAGES: usize = 4096;

/// What all PNG files begin with.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Why files make no images of a light.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LightImageError {
    /// A file that cannot be read, or not as a picture.
    #[error("light image '{name}' {why}")]
    Unreadable {
        /// The file.
        name: String,
        /// What is wrong.
        why: String,
    },
    /// A picture that no light can have.
    #[error("light image '{name}' {why}")]
    Texels {
        /// The file.
        name: String,
        /// What is wrong.
        why: TexelError,
    },
    /// Images of several sizes.
    #[error(
        "light image '{name}' is {side}x{side} texels and the first one {first}x{first}; all of \
         a sequence are of one size"
    )]
    Sides {
        /// The file.
        name: String,
        /// Its side.
        side: usize,
        /// The first one's.
        first: usize,
    },
    /// Too many.
    #[error("{given} light images; a sequence has at most {MAX_LIGHT_IMAGES}")]
    TooMany {
        /// How many there are.
        given: usize,
    },
}

impl LightSequence {
    /// The images of files that the user names, in order.
    ///
    /// # Errors
    /// One cannot be read, is not a square of 2 to 32 texels a side or not of the first
    /// one's size, or there are too many.
    pub fn read<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, LightImageError> {
        let names: Vec<&str> = names.into_iter().collect();
        if names.len() > MAX_LIGHT_IMAGES {
            let given = names.len();
            return Err(LightImageError::TooMany { given });
        }
        let images: Vec<LightImage> = names.iter().map(|n| read(n)).collect::<Result<_, _>>()?;
        let first = images.first().map_or(0, LightImage::side);
        for (name, image) in names.iter().zip(&images) {
            if image.side() != first {
                return Err(LightImageError::Sides {
                    name: (*name).to_owned(),
                    side: image.side(),
                    first,
                });
            }
        }
        Ok(Self::Images(images.into()))
    }
}

fn read(name: &str) -> Result<LightImage, LightImageError> {
    let unreadable = |why: String| LightImageError::Unreadable {
        name: name.to_owned(),
        why,
    };
    let bytes = files::read(Path::new(name), MAX_LIGHT_IMAGE_BYTES);
    let bytes = bytes.map_err(|e| unreadable(e.to_string()))?;
    let found = if bytes.starts_with(PNG) {
        png(&bytes)
    } else {
        environment::decode(&bytes)
            .unwrap_or_else(|| Err("is no PNG, .exr or .hdr file".to_owned()))
    };
    let (size, texels) = found.map_err(unreadable)?;
    LightImage::of_picture(size, &texels).map_err(|why| LightImageError::Texels {
        name: name.to_owned(),
        why,
    })
}

/// Size and linear texels, rows from the top; what is transparent gives no light.
type Picture = ([usize; 2], Vec<[f32; 3]>);

/// An sRGB picture. One that is too large is not decoded.
fn png(bytes: &[u8]) -> Result<Picture, String> {
    let cannot = |e: image::ImageError| format!("cannot be decoded: {e}");
    let decoder = PngDecoder::new(Cursor::new(bytes)).map_err(cannot)?;
    let (width, height) = decoder.dimensions();
    let size = [width as usize, height as usize];
    if size.iter().any(|s| *s > super::LIGHT_IMAGE_SIDES[1]) {
        return Ok((size, Vec::new()));
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(cannot)?;
    let texel = |p: &image::Rgba<u16>| {
        let [r, g, b, a] = p.0.map(|v| f64::from(v) / f64::from(u16::MAX));
        [r, g, b].map(|v| (linear(v) * a) as f32)
    };
    Ok((size, decoded.to_rgba16().pixels().map(texel).collect()))
}

/// Of an sRGB value (IEC 61966-2-1).
pub(crate) fn linear(v: f64) -> f64 {
    if v <= 0.04045 {
        v / 12.92
    } else {
        libm::pow((v + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scratch::Scratch;
    use std::fs;

    fn read_all(names: &[String]) -> Result<LightSequence, LightImageError> {
        LightSequence::read(names.iter().map(String::as_str))
    }

    #[test]
    fn png_hdr_and_exr_hold_the_same_light() {
        let folder = Scratch::made("light-images");
        let path = |name: &str| folder.join(name).display().to_string();
        let texel = |x: u32, y: u32| [f32::from(x == 0), f32::from(y == 0), 1.0];
        let float = image::ImageBuffer::from_fn(4, 4, |x, y| image::Rgb(texel(x, y)));
        let bytes = |x, y| image::Rgb(texel(x, y).map(|v| (v * 255.0) as u8));
        image::RgbImage::from_fn(4, 4, bytes)
            .save(path("a.png"))
            .unwrap();
        float.save(path("a.exr")).unwrap();
        float.save(path("a.hdr")).unwrap();
        let names = ["a.png", "a.exr", "a.hdr"].map(path);
        let LightSequence::Images(images) = read_all(&names).unwrap() else {
            unreachable!()
        };
        assert_eq!((&images[0], &images[0]), (&images[1], &images[2]));
        // The top row of the picture is at the far end of y.
        assert_eq!(images[0].cells()[12], [1.0, 1.0, 1.0]);
        assert_eq!(images[0].cells()[3], [0.0, 0.0, 1.0]);
    }

    #[test]
    fn srgb_and_transparency_are_taken_into_account() {
        let folder = Scratch::made("light-image-alpha");
        let path = folder.join("a.png");
        let texel = |x: u32, _| image::Rgba([188, 255, 0, if x == 0 { 255 } else { 51 }]);
        image::RgbaImage::from_fn(2, 2, texel).save(&path).unwrap();
        let image = read(&path.display().to_string()).unwrap();
        let [opaque, thin] = [image.cells()[0], image.cells()[1]];
        assert!(
            (opaque[0] - 0.503).abs() < 1e-3 && opaque[1] == 1.0,
            "{opaque:?}"
        );
        assert!((thin[1] - 0.2).abs() < 1e-6 && (thin[0] - 0.2 * opaque[0]).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_image_of_a_light_is_named() {
        let folder = Scratch::made("light-image-wrong");
        let path = |name: &str| folder.join(name).display().to_string();
        let message = |names: &[String]| read_all(names).unwrap_err().to_string();
        for (side, name) in [
            (33, "large.png"),
            (1, "small.png"),
            (4, "four.png"),
            (8, "eight.png"),
        ] {
            image::RgbImage::new(side, side).save(path(name)).unwrap();
        }
        image::RgbImage::new(8, 4).save(path("wide.png")).unwrap();
        fs::write(path("text.png"), "no picture").unwrap();
        let whole = fs::read(path("eight.png")).unwrap();
        fs::write(path("cut.png"), &whole[..whole.len() / 2]).unwrap();
        for (name, what) in [
            ("large.png", "33x33"),
            ("small.png", "1x1"),
            ("wide.png", "8x4"),
            ("text.png", "no PNG"),
            ("cut.png", "cannot be decoded"),
            ("none.png", "cannot be read"),
            ("", "is a folder"),
        ] {
            let text = message(&[path(name)]);
            assert!(text.contains(what), "{name}: {text}");
        }
        let text = message(&[path("four.png"), path("eight.png")]);
        assert!(text.contains("8x8") && text.contains("4x4"), "{text}");
        let many = vec![path("four.png"); MAX_LIGHT_IMAGES + 1];
        assert!(message(&many).contains("4097"));
    }
}
