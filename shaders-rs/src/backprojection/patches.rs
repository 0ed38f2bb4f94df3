//! The patches of a receiver on the light.

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use super::Backprojection;
use super::cover::LightCover;
use super::region::Region;
use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, Span, blocker, kernel};

/// What becomes of gaps between patches of neighbours at different depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gaps {
    /// Light leaks through.
    Left,
    /// A patch reaches to its neighbours to the left and below, if these block.
    Filled,
}
uniforms!(enum Gaps { 0: Left, 1: Filled });

/// A rectangle on the light, which is -1..=1.
#[derive(Clone, Copy)]
pub struct Patch<L: Lanes> {
    /// Low and high border.
    pub x: [F32<L>; 2],
    /// Low and high border.
    pub y: [F32<L>; 2],
    /// Lanes that have it.
    pub some: Mask<L>,
}

/// A texel as a receiver sees it.
#[derive(Clone, Copy)]
struct Seen<L: Lanes> {
    blocks: Mask<L>,
    /// Half the width of the light through it, in texels.
    half: [F32<L>; 2],
}

impl<C: LightCover> Backprojection<C> {
    /// What all patches of a region cover.
    #[inline(always)]
    pub(super) fn covered<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
        region: &Region<L>,
    ) -> C::Covered<L> {
        let size = mapping.size as f32;
        let wanted = region.some & f.live();
        let columns = Span::new(receiver.at[0], region.half[0], size, wanted);
        let rows = Span::new(receiver.at[1], region.half[1], size, wanted);
        let mut covered = self.cover.nothing(l);
        for row in 0..rows.count {
            let y = rows.first + row as f32;
            let in_row = wanted & y.lt(rows.high);
            let before = columns.first - 1.0;
            let mut left = self.seen(l, f, mapping, receiver, [before, y], in_row);
            for column in 0..columns.count {
                let x = columns.first + column as f32;
                let read = in_row & x.lt(columns.high);
                let own = self.seen(l, f, mapping, receiver, [x, y], read);
                let below = match self.gaps {
                    Gaps::Left => own,
                    Gaps::Filled => self.seen(l, f, mapping, receiver, [x, y + 1.0], own.blocks),
                };
                let patch = self.patch(receiver, [x, y], &own, &left, &below);
                self.cover.add(l, &mut covered, &patch);
                left = own;
            }
        }
        covered
    }

    /// A texel; nothing is read, and nothing blocks, where it is not wanted.
    #[inline(always)]
    fn seen<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
        [x, y]: [F32<L>; 2],
        wanted: Mask<L>,
    ) -> Seen<L> {
        let outside = F32::splat(l, -1.0);
        let at = [wanted.select_f32(x, outside).to_i32(), y.to_i32()];
        let (blocks, depth) = blocker(l, f, receiver, at);
        let blocks = blocks & wanted;
        let distance = mapping.range.distance(depth);
        Seen {
            blocks,
            half: kernel(mapping, self.light_half, distance, receiver),
        }
    }

    /// The patch of texel (x, y), reaching to the right border of its left neighbour and
    /// to the upper border of the one below, where these are beyond its own.
    #[inline(always)]
    fn patch<L: Lanes>(
        &self,
        receiver: &Receiver<L>,
        [x, y]: [F32<L>; 2],
        own: &Seen<L>,
        left: &Seen<L>,
        below: &Seen<L>,
    ) -> Patch<L> {
        let [x, y] = [x - receiver.at[0], y - receiver.at[1]];
        let mut low = x / own.half[0];
        let mut high = (y + 1.0) / own.half[1];
        if self.gaps == Gaps::Filled {
            let to_left = low.min(x / left.half[0]);
            low = left.blocks.select_f32(to_left, low);
            let to_below = high.max((y + 1.0) / below.half[1]);
            high = below.blocks.select_f32(to_below, high);
        }
        Patch {
            x: [low, (x + 1.0) / own.half[0]],
            y: [y / own.half[1], high],
            some: own.blocks,
        }
    }
}
