//! An 8-bit sRGB picture to be compared.

use super::error::{MetricError, filled};

/// A view of 8-bit sRGB pixels, three bytes each, row 0 on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture<'a> {
    size: [u32; 2],
    rgb: &'a [u8],
}

impl<'a> Picture<'a> {
    /// A picture of `size` (width, height) from R, G, B, R, ….
    ///
    /// # Errors
    /// There are not three bytes for each pixel.
    pub fn new(size: [u32; 2], rgb: &'a [u8]) -> Result<Self, MetricError> {
        filled(size, 3, rgb.len())?;
        Ok(Self { size, rgb })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// All bytes, R, G, B, R, ….
    pub fn rgb(&self) -> &'a [u8] {
        self.rgb
    }

    /// Pixels in order.
    pub fn pixels(&self) -> impl Iterator<Item = [u8; 3]> + 'a {
        self.rgb.as_chunks::<3>().0.iter().copied()
    }
}

/// R, G, B of each pixel, without alpha.
pub fn rgb_of(rgba: &[[u8; 4]]) -> Vec<u8> {
    rgba.iter().flat_map(|p| [p[0], p[1], p[2]]).collect()
}
