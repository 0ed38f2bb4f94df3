//! Textures as pictures.

use gnomon_pipeline::measure::render::SrgbEncoder;
use gnomon_raster::{Error, Subresource, Texture};

use crate::draw::Picture;

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
