//! Prefiltering as render passes: mip levels and summed-area tables.
//!
//! A shader treats the same texel of up to four textures of one size and writes it
//! to as many attachments.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each4;
use gnomon_raster::{F32, I32, Lanes, Mask, U32, uniforms};

use super::look_up::bits_of;
use crate::bounded::bounded_uniforms;
use crate::soft_volumes::reads;

/// Most textures that are treated at a time.
pub const MAX_TEXTURES: usize = 4;

/// A texel of a level, in a function of its own for all shaders.
#[inline(always)]
pub(crate) fn texel_at<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    slot: usize,
    at: [I32<L>; 2],
    mip: u32,
) -> [F32<L>; 4] {
    let zero = I32::splat(l, 0);
    crate::coverage::outlined(
        l,
        #[inline(always)]
        || f.fetch_texel(slot, [at[0], at[1], zero], mip),
    )
}

/// A texel of the next level: the mean of the four under it, `((a + b) + (c + d))/4`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Halve {
    /// Textures in slots from 0, attachments likewise.
    pub textures: usize,
    /// The level that is read.
    pub mip: u32,
}
uniforms!(Halve { textures, mip });

impl FragmentShader for Halve {
    fn outputs(&self) -> FragmentOutputs {
        reads(self.textures)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let one = I32::splat(l, 1);
        let [x, y] = [f.column() << 1, f.row() << 1];
        for slot in 0..self.textures {
            let [a, b, c, d] = [
                texel_at(l, f, slot, [x, y], self.mip),
                texel_at(l, f, slot, [x + one, y], self.mip),
                texel_at(l, f, slot, [x, y + one], self.mip),
                texel_at(l, f, slot, [x + one, y + one], self.mip),
            ];
            let mean = each4(
                #[inline(always)]
                |i| ((a[i] + b[i]) + (c[i] + d[i])) * 0.25,
            );
            f.set_color(slot, mean);
        }
    }
}

/// A level as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CopyLevel {
    /// Textures in slots from 0, attachments likewise.
    pub textures: usize,
    /// The level that is read.
    pub mip: u32,
}
uniforms!(CopyLevel { textures, mip });

impl FragmentShader for CopyLevel {
    fn outputs(&self) -> FragmentOutputs {
        reads(self.textures)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row()];
        for slot in 0..self.textures {
            let texel = texel_at(l, f, slot, at, self.mip);
            f.set_color(slot, texel);
        }
    }
}

/// Texels less the mean of their tile, for tables that lose less to rounding: sums of
/// what is left stay near 0. The first column and row are the zeros of exclusive
/// tables and stay so.
///
/// The mean is in the last level of the chain of the textures that are read; see
/// `mean_factor`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LessMean {
    /// Textures in slots from 0, attachments likewise.
    pub textures: usize,
    /// Texels along a side of a tile, a power of two.
    pub side: u32,
}
uniforms!(LessMean { textures, side });

/// What the last level of an exclusive table's chain is multiplied by: its zeros are
/// no texels.
#[must_use]
pub(super) fn mean_factor(side: u32) -> f32 {
    let share = side as f32 / (side - 1).max(1) as f32;
    share * share
}

impl FragmentShader for LessMean {
    fn outputs(&self) -> FragmentOutputs {
        reads(self.textures)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let level = self.side.trailing_zeros();
        let factor = mean_factor(self.side);
        let at = [f.column(), f.row()];
        let last = I32::splat(l, self.side as i32 - 1);
        let zero = I32::splat(l, 0);
        let texel = (at[0] & last).gt(zero) & (at[1] & last).gt(zero);
        let cell = [at[0] >> level, at[1] >> level];
        for slot in 0..self.textures {
            let value = texel_at(l, f, slot, at, 0);
            let mean = texel_at(l, f, slot, cell, level);
            let rest = each4(
                #[inline(always)]
                |i| texel.select_f32(value[i] - mean[i] * factor, F32::splat(l, 0.0)),
            );
            f.set_color(slot, rest);
        }
    }
}

/// One step of recursive doubling (Hensley et al. 2005), or two at once: to each entry
/// of a tile the one `step` before it is added. After steps 1, 2, 4 … an entry is the
/// sum of all up to it.
///
/// Two steps at once read the entries that the second would find and write none of
/// them: the same sums of the same pairs, to the bit, with half the writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SumStep {
    /// Textures in slots from 0, attachments likewise.
    pub textures: usize,
    /// 0: along rows; 1: along columns.
    pub axis: usize,
    /// Texels back.
    pub step: u32,
    /// The next step, of twice as many, too.
    pub twice: bool,
    /// Texels along a side of a tile, a power of two.
    pub side: u32,
    /// Sums of unsigned integers, modulo 2³².
    pub integer: bool,
}
bounded_uniforms!(SumStep { textures, axis, step, twice, side, integer }: |s| [
    ("an axis", s.axis as u64, 1),
]);

impl SumStep {
    /// Where the entry `steps` back is, and where there is one; outside the texture
    /// where there is none, so that nothing is read.
    #[inline(always)]
    fn before<L: Lanes>(&self, l: L, at: [I32<L>; 2], steps: u32) -> ([I32<L>; 2], Mask<L>) {
        let back = I32::splat(l, (self.step * steps) as i32);
        let within = at[self.axis] & I32::splat(l, self.side as i32 - 1);
        let some = within.ge(back);
        let mut other = at;
        other[self.axis] = some.select_i32(at[self.axis] - back, I32::splat(l, -1));
        (other, some)
    }

    /// An entry and those before it that are added, of integers.
    #[inline(always)]
    fn integers<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, slot: usize) -> U32<L> {
        let at = [f.column(), f.row()];
        let zero = U32::splat(l, 0);
        let mut sum = bits_of(l, f, slot, at);
        for steps in 1..=self.entries() {
            let (other, some) = self.before(l, at, steps);
            sum = sum + some.select_u32(bits_of(l, f, slot, other), zero);
        }
        sum
    }

    /// The same of floats, in the order of one step after the other.
    #[inline(always)]
    fn floats<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, slot: usize) -> [F32<L>; 4] {
        let at = [f.column(), f.row()];
        let own = texel_at(l, f, slot, at, 0);
        let (other, some) = self.before(l, at, 1);
        let first = added(own, texel_at(l, f, slot, other, 0), some);
        if !self.twice {
            return first;
        }
        let (other, second) = self.before(l, at, 2);
        let (farthest, third) = self.before(l, at, 3);
        let far = texel_at(l, f, slot, other, 0);
        let far = added(far, texel_at(l, f, slot, farthest, 0), third);
        added(first, far, second)
    }

    /// Entries that are added.
    #[inline(always)]
    fn entries(&self) -> u32 {
        if self.twice { 3 } else { 1 }
    }
}

/// The sum where there is something to add.
#[inline(always)]
fn added<L: Lanes>(a: [F32<L>; 4], b: [F32<L>; 4], some: Mask<L>) -> [F32<L>; 4] {
    each4(
        #[inline(always)]
        |i| some.select_f32(a[i] + b[i], a[i]),
    )
}

impl FragmentShader for SumStep {
    fn outputs(&self) -> FragmentOutputs {
        reads(self.textures)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        for slot in 0..self.textures {
            if self.integer {
                let sum = self.integers(l, f, slot);
                f.set_color_uint(slot, sum);
            } else {
                let sum = self.floats(l, f, slot);
                f.set_color(slot, sum);
            }
        }
    }
}
