//! Sizes of on-chip tiles, and which primitives enter which of them.

use gnomon_raster::BlockAccess;

use super::attachments::Attachment;
use super::model::Tile;
use super::surface::{Image, Images};

/// Bytes of a pixel in a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PixelBytes {
    pub(super) color: u32,
    pub(super) depth: u32,
}

impl PixelBytes {
    /// A pixel of all these attachments, each image once.
    pub(super) fn of<'a>(images: &Images, all: impl Iterator<Item = &'a Attachment>) -> Self {
        let mut seen: Vec<&Attachment> = Vec::new();
        let mut pixel = Self::default();
        for a in all {
            if seen.iter().any(|b| b.is_image_of(a)) {
                continue;
            }
            seen.push(a);
            let bytes = u32::from(images.get(a.texture, a.subresource).bytes);
            match a.is_depth {
                true => pixel.depth += bytes,
                false => pixel.color += bytes,
            }
        }
        pixel
    }
}

/// The tiles of a pass.
#[derive(Debug, Default)]
pub(super) struct Bins {
    /// Side in blocks.
    side: u32,
    across: u32,
    /// Draw and primitive that entered last.
    last: Vec<(u32, u32)>,
}

const NOBODY: (u32, u32) = (u32::MAX, u32::MAX);

impl Bins {
    /// Tiles of a pass with `images`, a pixel of which takes `pixel` bytes on chip.
    pub(super) fn new(tile: &Tile, images: &[Option<Image>], pixel: PixelBytes) -> Self {
        let side = side(tile, pixel) / 8;
        let [width, height] = images.iter().flatten().next().map_or([0; 2], |i| i.size);
        let across = width.div_ceil(8 * side);
        let count = across * height.div_ceil(8 * side);
        Self {
            side,
            across,
            last: vec![NOBODY; count as usize],
        }
    }

    /// Whether the event is its primitive's first in a tile.
    pub(super) fn enters(&mut self, e: &BlockAccess) -> bool {
        let [x, y] = e.block.map(|b| u32::from(b) / self.side);
        let who = (e.draw, e.primitive);
        let last = &mut self.last[(y * self.across + x) as usize];
        core::mem::replace(last, who) != who
    }
}

/// The least side of a tile.
pub(super) fn least_side(tile: &Tile) -> u32 {
    tile.align.max(8) / 8 * 8
}

/// Bytes of a pixel in each memory of a tile, and that memory's bytes.
pub(super) fn room(tile: &Tile, pixel: PixelBytes) -> impl Iterator<Item = (u32, u64)> {
    let color = u64::from(tile.color_bytes);
    let parts = match tile.depth_bytes {
        0 => [(pixel.color + pixel.depth, color), (0, 0)],
        depth => [(pixel.color, color), (pixel.depth, u64::from(depth))],
    };
    parts.into_iter()
}

/// The largest side of a square tile whose pixels fit: from the largest on it is halved,
/// but for the least that alignment allows.
fn side(tile: &Tile, pixel: PixelBytes) -> u32 {
    let fits = |side: u32| {
        let pixels = u64::from(side) * u64::from(side);
        room(tile, pixel).all(|(bytes, room)| pixels * u64::from(bytes) <= room)
    };
    let mut side = tile.largest / tile.align * tile.align;
    while side > tile.align && !fits(side) {
        side = (side / 2 / tile.align * tile.align).max(tile.align);
    }
    (side.max(8)) / 8 * 8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(color_bytes: u32, depth_bytes: u32, largest: u32, align: u32) -> Tile {
        Tile {
            color_bytes,
            depth_bytes,
            largest,
            align,
            list_bytes: 8,
            vertex_reads: 1,
        }
    }

    fn pixel(color: u32, depth: u32) -> PixelBytes {
        PixelBytes { color, depth }
    }

    #[test]
    fn tiles_halve_until_their_pixels_fit() {
        assert_eq!(side(&tile(16_384, 8_192, 16, 8), pixel(4, 4)), 16);
        assert_eq!(side(&tile(4_096, 4_096, 32, 8), pixel(4, 4)), 32);
        assert_eq!(side(&tile(4_096, 4_096, 32, 8), pixel(8, 4)), 16);
        assert_eq!(side(&tile(4_096, 2_048, 32, 8), pixel(4, 4)), 16);
        assert_eq!(side(&tile(1 << 20, 0, 1024, 32), pixel(4, 4)), 256);
        assert_eq!(side(&tile(1 << 20, 0, 1024, 32), pixel(8, 4)), 256);
        assert_eq!(side(&tile(1 << 20, 0, 1024, 32), pixel(16, 4)), 128);
    }
}
