//! Sizes of on-chip tiles, and which primitives enter which of them.

use gnomon_raster::BlockAccess;

use super::model::Tile;
use super::surface::Image;

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
    pub(super) fn new(tile: &Tile, images: &[Option<Image>]) -> Self {
        let bytes = |i: &Option<Image>| i.map_or(0, |i| u32::from(i.bytes));
        let color: u32 = images.iter().skip(1).map(bytes).sum();
        let depth = images.first().map_or(0, bytes);
        let side = side(tile, color, depth) / 8;
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

/// The largest side of a square tile whose pixels fit: from the largest on it is halved,
/// but for the least that alignment allows.
fn side(tile: &Tile, color: u32, depth: u32) -> u32 {
    let fits = |side: u32| {
        let pixels = u64::from(side) * u64::from(side);
        let (color, depth) = (pixels * u64::from(color), pixels * u64::from(depth));
        match tile.depth_bytes {
            0 => color + depth <= u64::from(tile.color_bytes),
            room => color <= u64::from(tile.color_bytes) && depth <= u64::from(room),
        }
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

    #[test]
    fn tiles_halve_until_their_pixels_fit() {
        assert_eq!(side(&tile(16_384, 8_192, 16, 8), 4, 4), 16);
        assert_eq!(side(&tile(4_096, 4_096, 32, 8), 4, 4), 32);
        assert_eq!(side(&tile(4_096, 4_096, 32, 8), 8, 4), 16);
        assert_eq!(side(&tile(1 << 20, 0, 1024, 32), 4, 4), 256);
    }
}
