//! What witnesses are shown: blocks after events, and blocks that draws are done with.

use super::DrawConfig;
use super::target::TileTarget;
use crate::MAX_COLOR_ATTACHMENTS;
use crate::format::Format;
use crate::observer::{BlockAccess, BlockLeft, BlockView, BlockWitness, ColorBlock};
use crate::simd::SimdLevel;
use crate::texture::layout::unmorton;

/// Words of a bit for each block of the largest tile.
const WORDS: usize = 4;

/// Blocks of a tile, by their index in its slices, that a draw wrote to and that nobody has
/// been told of.
#[derive(Default)]
pub(crate) struct Untold {
    draw: u32,
    blocks: [u64; WORDS],
}

impl Untold {
    pub(super) fn is_of_another(&self, draw: u32) -> bool {
        self.draw != draw
    }

    pub(super) fn add(&mut self, draw: u32, index: usize) {
        self.draw = draw;
        self.blocks[index / 64] |= 1 << (index % 64);
    }
}

pub(super) fn wrote(access: &BlockAccess) -> bool {
    let colors = access.color_write.iter().fold(0, |m, c| m | c);
    (access.z_write | access.stencil_write | colors) != 0
}

/// Tells of the blocks that the draw before wrote to: another one begins, or none follows.
/// All draws of a pass have the attachments of `config`.
pub(super) fn tell_left(
    target: &mut TileTarget<'_>,
    config: &DrawConfig<'_>,
    level: SimdLevel,
    witness: &dyn BlockWitness,
    to: &mut Vec<BlockLeft>,
) {
    let Untold { draw, blocks } = core::mem::take(&mut target.untold);
    for (word, mut left) in blocks.into_iter().enumerate() {
        while left != 0 {
            let index = 64 * word + left.trailing_zeros() as usize;
            left &= left - 1;
            let (bx, by) = unmorton(index);
            let place = [target.x / 8 + bx, target.y / 8 + by];
            to.push(BlockLeft {
                draw,
                block: [place[0] as u16, place[1] as u16],
                seen: look_at(target, config, index, place, witness, level),
            });
        }
    }
}

/// What `w` says of block number `index` of the tile, at column and row `place`, as it is
/// now.
pub(super) fn look_at(
    target: &TileTarget<'_>,
    config: &DrawConfig<'_>,
    index: usize,
    place: [u32; 2],
    w: &dyn BlockWitness,
    level: SimdLevel,
) -> u64 {
    let mut color = [ColorBlock::B8(&[0; 64]); MAX_COLOR_ATTACHMENTS];
    let mut formats = [Format::R8Unorm; MAX_COLOR_ATTACHMENTS];
    for (i, tile) in target.color.iter().enumerate() {
        color[i] = tile.block(index);
        formats[i] = config.targets[i].format;
    }
    let attachments = target.color.len();
    let depth = target.depth.as_ref();
    w.after(&BlockView {
        block: [place[0] as u16, place[1] as u16],
        inside: target.inside(8 * place[0], 8 * place[1]),
        depth_stencil: depth.map(|d| (&d.depth[index].0, &d.stencil[index].0)),
        color: &color[..attachments],
        formats: &formats[..attachments],
        level,
    })
}
