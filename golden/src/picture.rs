//! Results as pictures: for people, since eight bits do not hold every format.

use std::path::Path;

use gnomon_raster::{Error, Format, Subresource, Texture};

use crate::{GoldenError, failed, make_folder};

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    pub(crate) size: [u32; 2],
    /// RGBA, rows from the top.
    pub(crate) pixels: Vec<u8>,
}

/// An image, eight bits a channel: those of such formats as they are stored, floats
/// limited to 0..=1, integers to 0..=255, depth as grey.
pub(crate) fn picture_of(texture: &Texture, at: Subresource) -> Result<Picture, Error> {
    let [w, h, _] = texture.mip_size(at.mip);
    let format = texture.descriptor().format;
    let pixels = if format.is_depth_stencil() {
        let depths = texture.read_depth(at)?;
        depths.iter().flat_map(|d| grey(byte(*d))).collect()
    } else {
        let texels = texture.read_color(at)?;
        let scale = match format {
            Format::R16Sint | Format::R32Uint => 1.0 / 255.0,
            _ => 1.0,
        };
        let channels = format.channels();
        texels
            .iter()
            .flat_map(|t| rgba(t.0, scale, channels))
            .collect()
    };
    Ok(Picture {
        size: [w, h],
        pixels,
    })
}

fn rgba(texel: [f32; 4], scale: f32, channels: usize) -> [u8; 4] {
    let [r, g, b, a] = texel.map(|v| byte(v * scale));
    match channels {
        1 => grey(r),
        4 => [r, g, b, a],
        _ => [r, g, b, 255],
    }
}

fn grey(v: u8) -> [u8; 4] {
    [v, v, v, 255]
}

fn byte(v: f32) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Writes a PNG, making its folder.
pub(crate) fn write(path: &Path, picture: &Picture) -> Result<(), GoldenError> {
    make_folder(path.parent().unwrap_or(Path::new(".")))?;
    let [w, h] = picture.size;
    image::save_buffer(path, &picture.pixels, w, h, image::ExtendedColorType::Rgba8)
        .map_err(|e| failed(path, std::io::Error::other(e)))
}

/// Reads a PNG; `None` where there is none of that size.
pub(crate) fn read(path: &Path, size: [u32; 2]) -> Option<Picture> {
    let read = image::open(path).ok()?.into_rgba8();
    let picture = Picture {
        size: [read.width(), read.height()],
        pixels: read.into_raw(),
    };
    (picture.size == size).then_some(picture)
}

/// Pixels that differ as white where the difference is largest, others black; how many
/// there are, and the first one.
pub(crate) fn difference(a: &Picture, b: &Picture) -> (Picture, usize, Option<[u32; 2]>) {
    let pairs = a.pixels.chunks_exact(4).zip(b.pixels.chunks_exact(4));
    let largest = |(a, b): (&[u8], &[u8])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
    let sizes: Vec<u8> = pairs.map(|p| largest(p).unwrap_or(0)).collect();
    let top = sizes.iter().copied().max().unwrap_or(0).max(1);
    // A difference of one step is seen, too.
    let show = |d: &u8| match *d {
        0 => grey(0),
        d => grey((64 + u32::from(d) * 191 / u32::from(top)) as u8),
    };
    let first = sizes.iter().position(|d| *d > 0);
    let picture = Picture {
        size: a.size,
        pixels: sizes.iter().flat_map(show).collect(),
    };
    let at = |i: usize| [i as u32 % a.size[0], i as u32 / a.size[0]];
    (
        picture,
        sizes.iter().filter(|d| **d > 0).count(),
        first.map(at),
    )
}
