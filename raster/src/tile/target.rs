//! A tile's share of the attachments: disjoint slices, handed out before the
//! workers start.

use super::witness::Untold;
use crate::format::{Format, from_stored};
use crate::observer::ColorBlock;
use crate::texture::{Block, Block4};

/// Colour blocks of a tile.
pub(crate) enum ColorTile<'a> {
    B8(&'a mut [Block<u8>]),
    B16(&'a mut [Block<u16>]),
    B32(&'a mut [Block<u32>]),
    B16x4(&'a mut [Block4<u16>]),
    B32x4(&'a mut [Block4<u32>]),
}

impl ColorTile<'_> {
    /// Block `b` as it is stored.
    pub(crate) fn block(&self, b: usize) -> ColorBlock<'_> {
        match self {
            Self::B8(v) => ColorBlock::B8(&v[b].0),
            Self::B16(v) => ColorBlock::B16(&v[b].0),
            Self::B32(v) => ColorBlock::B32(&v[b].0),
            Self::B16x4(v) => ColorBlock::B16x4(&v[b].0),
            Self::B32x4(v) => ColorBlock::B32x4(&v[b].0),
        }
    }

    /// Raw channels of pixel `i` of block `b`; unused ones are 0.
    pub(crate) fn get(&self, format: Format, b: usize, i: usize) -> [u32; 4] {
        from_stored(format, self.block(b).stored(i))
    }
}

impl ColorBlock<'_> {
    fn stored(&self, i: usize) -> [u32; 4] {
        match self {
            Self::B8(v) => [u32::from(v[i]), 0, 0, 0],
            Self::B16(v) => [u32::from(v[i]), 0, 0, 0],
            Self::B32(v) => [v[i], 0, 0, 0],
            Self::B16x4(v) => v.map(|channel| u32::from(channel[i])),
            Self::B32x4(v) => v.map(|channel| channel[i]),
        }
    }
}

/// Depth, stencil and zmin/zmax blocks of a tile.
pub(crate) struct DepthTile<'a> {
    pub(crate) depth: &'a mut [Block<u32>],
    pub(crate) stencil: &'a mut [Block<u8>],
    pub(crate) hiz_min: &'a mut [i32],
    pub(crate) hiz_max: &'a mut [i32],
}

/// One execution tile.
pub(crate) struct TileTarget<'a> {
    /// Top-left pixel.
    pub(crate) x: u32,
    pub(crate) y: u32,
    /// Side in pixels.
    pub(crate) side: u32,
    /// Size of the image.
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) depth: Option<DepthTile<'a>>,
    pub(crate) color: Vec<ColorTile<'a>>,
    /// While somebody listens.
    pub(crate) untold: Untold,
}

impl TileTarget<'_> {
    /// Pixels of the block at pixel (x, y) that lie inside the image.
    #[inline(always)]
    pub(crate) fn inside(&self, x: u32, y: u32) -> u64 {
        if x + 8 <= self.width && y + 8 <= self.height {
            return u64::MAX;
        }
        rect_mask(
            0,
            0,
            self.width.saturating_sub(x).min(8),
            self.height.saturating_sub(y).min(8),
        )
    }
}

/// Bits of the pixels of a block with x0 ≤ column < x1, y0 ≤ row < y1 (0..=8).
#[inline(always)]
pub(crate) fn rect_mask(x0: u32, y0: u32, x1: u32, y1: u32) -> u64 {
    if x0 >= x1 || y0 >= y1 {
        return 0;
    }
    let row = ((1u64 << x1) - 1) & !((1u64 << x0) - 1);
    let rows = row * 0x0101_0101_0101_0101;
    let below = if y1 == 8 {
        u64::MAX
    } else {
        (1u64 << (8 * y1)) - 1
    };
    rows & below & !((1u64 << (8 * y0)) - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rect_masks_hold_exactly_their_pixels() {
        for x0 in 0..8 {
            for x1 in 0..=8 {
                for (y0, y1) in [(0, 8), (0, 3), (2, 7), (5, 5), (7, 8)] {
                    let m = rect_mask(x0, y0, x1, y1);
                    for i in 0..64u32 {
                        let (x, y) = (i % 8, i / 8);
                        assert_eq!(
                            m >> i & 1 != 0,
                            (x0..x1).contains(&x) && (y0..y1).contains(&y)
                        );
                    }
                }
            }
        }
    }
}
