//! Where a pixel lives: 8×8 blocks in Morton order inside superblocks.
//!
//! A superblock is a square of at most 16×16 blocks (128×128 pixels); the
//! superblocks follow one another row by row, and the blocks inside one in
//! Z-order. So every aligned power-of-two execution tile up to 128 pixels is
//! *contiguous* in memory, and a target splits into disjoint `&mut` slices, one
//! a tile, without a lock or a line of `unsafe`.

use crate::simd::{I32, LANES, Lanes, U32};

/// Side of a storage block in pixels.
pub const BLOCK: u32 = 8;
/// Packets of lanes in a block.
pub(crate) const PACKETS: usize = (BLOCK * BLOCK) as usize / LANES;

/// log₂ of the largest superblock's side in blocks.
const MAX_ORDER: u32 = 4;

/// Addressing of one two-dimensional plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// log₂ of the superblock's side in blocks.
    order: u32,
    /// Superblocks in a row.
    across: u32,
    /// Superblocks in a column.
    down: u32,
}

impl Layout {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let blocks = width.max(height).div_ceil(BLOCK).max(1);
        let order = blocks.next_power_of_two().trailing_zeros().min(MAX_ORDER);
        let side = BLOCK << order;
        Self {
            width,
            height,
            order,
            across: width.div_ceil(side).max(1),
            down: height.div_ceil(side).max(1),
        }
    }

    /// Number of blocks that are stored, padding included.
    pub(crate) fn blocks(&self) -> usize {
        (self.across as usize * self.down as usize) << (2 * self.order)
    }

    /// Index of the block at block column `bx`, block row `by`.
    #[inline(always)]
    pub(crate) fn block_index(&self, bx: u32, by: u32) -> usize {
        let m = (1 << self.order) - 1;
        let superblock = (by >> self.order) * self.across + (bx >> self.order);
        ((superblock as usize) << (2 * self.order)) | morton(bx & m, by & m)
    }

    /// Index of the block and of the pixel inside it.
    #[inline(always)]
    pub(crate) fn locate(&self, x: u32, y: u32) -> (usize, usize) {
        (
            self.block_index(x / BLOCK, y / BLOCK),
            ((y % BLOCK) * BLOCK + x % BLOCK) as usize,
        )
    }

    /// Index of pixels among all that are stored, over lanes: 64 times the block's, and
    /// the place in it. Coordinates outside the plane give any index.
    #[inline(always)]
    pub(crate) fn locate_lanes<L: Lanes>(&self, x: I32<L>, y: I32<L>) -> U32<L> {
        let l = x.l;
        let (in_block, in_super) = (
            I32::splat(l, BLOCK as i32 - 1),
            I32::splat(l, (1 << self.order) - 1),
        );
        let (bx, by) = (x >> 3, y >> 3);
        let across = I32::splat(l, self.across as i32);
        let superblock = (by >> self.order) * across + (bx >> self.order);
        let block = superblock << (2 * self.order) | morton_lanes(bx & in_super, by & in_super);
        (block << 6 | (y & in_block) << 3 | (x & in_block)).to_u32()
    }

    /// Execution tiles of at most `side` pixels, in storage order: each is a run
    /// of `tile_blocks(side)` blocks.
    pub(crate) fn tile_side(&self, side: u32) -> u32 {
        side.min(BLOCK << self.order)
    }

    /// Blocks of one execution tile.
    pub(crate) fn tile_blocks(&self, side: u32) -> usize {
        let b = (self.tile_side(side) / BLOCK) as usize;
        b * b
    }

    /// Top-left pixel of the tile that starts at block `index`.
    pub(crate) fn tile_origin(&self, index: usize) -> (u32, u32) {
        let superblock = (index >> (2 * self.order)) as u32;
        let (bx, by) = unmorton(index & ((1 << (2 * self.order)) - 1));
        let side = 1 << self.order;
        (
            ((superblock % self.across) * side + bx) * BLOCK,
            ((superblock / self.across) * side + by) * BLOCK,
        )
    }
}

/// Z-order index of (x, y), both below 16.
#[inline(always)]
pub(crate) fn morton(x: u32, y: u32) -> usize {
    (spread(x) | (spread(y) << 1)) as usize
}

#[inline(always)]
fn spread(v: u32) -> u32 {
    let v = (v | (v << 2)) & 0x33;
    (v | (v << 1)) & 0x55
}

/// The same over lanes.
#[inline(always)]
pub(crate) fn morton_lanes<L: Lanes>(x: I32<L>, y: I32<L>) -> I32<L> {
    spread_lanes(x) | spread_lanes(y) << 1
}

#[inline(always)]
fn spread_lanes<L: Lanes>(v: I32<L>) -> I32<L> {
    let l = v.l;
    let v = (v | (v << 2)) & I32::splat(l, 0x33);
    (v | (v << 1)) & I32::splat(l, 0x55)
}

/// The (x, y) of a Z-order index below 256.
#[inline(always)]
pub(crate) fn unmorton(i: usize) -> (u32, u32) {
    let mut x = 0;
    let mut y = 0;
    for b in 0..MAX_ORDER {
        x |= ((i >> (2 * b)) as u32 & 1) << b;
        y |= ((i >> (2 * b + 1)) as u32 & 1) << b;
    }
    (x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_its_own_place_and_tiles_are_contiguous() {
        for (w, h) in [(1, 1), (8, 9), (33, 7), (640, 427), (129, 257)] {
            let l = Layout::new(w, h);
            let mut seen = vec![false; l.blocks()];
            for by in 0..h.div_ceil(BLOCK) {
                for bx in 0..w.div_ceil(BLOCK) {
                    let i = l.block_index(bx, by);
                    assert!(!std::mem::replace(&mut seen[i], true));
                    for side in [16, 32, 64, 128] {
                        let n = l.tile_blocks(side);
                        let (ox, oy) = l.tile_origin(i / n * n);
                        let t = l.tile_side(side);
                        assert_eq!((ox, oy), (bx * BLOCK / t * t, by * BLOCK / t * t));
                    }
                }
            }
        }
    }
}
