//! What patches hide of the light.

use gnomon_raster::{F32, I32, Lanes, U32, uniforms};

use super::patches::Patch;
use super::region::power_of_two;
use crate::bounded::bounded_uniforms;
use crate::vector::each2;

/// A way to add patches up.
pub trait LightCover: Copy + Send + Sync {
    /// What is hidden.
    type Covered<L: Lanes>: Copy;

    /// Nothing.
    fn nothing<L: Lanes>(&self, l: L) -> Self::Covered<L>;

    /// Hides a patch as well.
    fn add<L: Lanes>(&self, l: L, covered: &mut Self::Covered<L>, patch: &Patch<L>);

    /// The share of the light; more than 1 where patches overlap and that is not told.
    fn hidden<L: Lanes>(&self, l: L, covered: &Self::Covered<L>) -> F32<L>;
}

/// The sum of the patches' areas (Guennebaud et al. 2006). What is hidden twice counts
/// twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AreaSum;
uniforms!(AreaSum);

impl LightCover for AreaSum {
    type Covered<L: Lanes> = F32<L>;

    #[inline(always)]
    fn nothing<L: Lanes>(&self, l: L) -> F32<L> {
        F32::splat(l, 0.0)
    }

    #[inline(always)]
    fn add<L: Lanes>(&self, l: L, covered: &mut F32<L>, patch: &Patch<L>) {
        let zero = F32::splat(l, 0.0);
        let spans = [patch.x, patch.y];
        let [width, height] = each2(
            #[inline(always)]
            |i| {
                let [low, high] = spans[i];
                (high.clamp(-1.0, 1.0) - low.clamp(-1.0, 1.0)).max(zero)
            },
        );
        let area = width * height;
        *covered = *covered + patch.some.select_f32(area, zero);
    }

    #[inline(always)]
    fn hidden<L: Lanes>(&self, _: L, covered: &F32<L>) -> F32<L> {
        *covered * 0.25
    }
}

/// Most bits along a side of the field.
pub const MOST_BITS: usize = 16;

/// Bits by row.
pub type BitRows<L> = [U32<L>; MOST_BITS];

/// Bits of a field over the light, each the centre of a cell (Schwarz and Stamminger
/// 2007): what is hidden twice counts once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitField {
    /// Bits along a side.
    pub side: u32,
}
bounded_uniforms!(BitField { side }: |b| [
    ("bits along a side", b.side.into(), MOST_BITS as u64),
]);

impl BitField {
    /// The first bit at or beyond a place, and how many bits there are before it.
    #[inline(always)]
    fn bit<L: Lanes>(&self, place: F32<L>) -> I32<L> {
        let side = self.side as f32;
        let bits = (place.clamp(-1.0, 1.0) + 1.0) * (0.5 * side) - 0.5;
        bits.ceil().clamp(0.0, side).to_i32()
    }
}

/// Bits of a row from the first to before the second.
#[inline(always)]
pub(super) fn columns_of<L: Lanes>(l: L, [low, high]: [I32<L>; 2]) -> U32<L> {
    let places = [low, high.max(low)];
    let [low, high] = each2(
        #[inline(always)]
        |i| power_of_two(l, places[i]).to_i32(),
    );
    (high - low).to_u32()
}

/// The rows that any lane's patch touches, as bits: most patches are as high as one or
/// two.
#[inline(always)]
pub(super) fn rows_in_use<L: Lanes>(l: L, rows: [I32<L>; 2], patch: &Patch<L>) -> u32 {
    let own = columns_of(l, rows);
    let own = patch.some.select_u32(own, U32::splat(l, 0)).to_array();
    let mut all = 0;
    for lane in own {
        all |= lane;
    }
    all
}

/// The lowest row that is left, which is taken off.
#[inline(always)]
pub(super) fn next_row<'c, L: Lanes>(
    rest: &mut u32,
    covered: &'c mut BitRows<L>,
) -> Option<(usize, &'c mut U32<L>)> {
    let row = rest.trailing_zeros() as usize;
    *rest &= rest.wrapping_sub(1);
    let bits = covered.get_mut(row)?;
    Some((row, bits))
}

/// The share of a field of so many bits along a side that is set.
#[inline(always)]
pub(super) fn share_of<L: Lanes>(l: L, covered: &BitRows<L>, side: u32) -> F32<L> {
    let mut count = U32::splat(l, 0);
    for pair in covered.chunks_exact(2) {
        count = count + ones(l, pair[0] | (pair[1] << 16));
    }
    count.to_i32().to_f32() * (1.0 / (side * side) as f32)
}

impl LightCover for BitField {
    /// A row each.
    type Covered<L: Lanes> = BitRows<L>;

    #[inline(always)]
    fn nothing<L: Lanes>(&self, l: L) -> BitRows<L> {
        [U32::splat(l, 0); MOST_BITS]
    }

    #[inline(always)]
    fn add<L: Lanes>(&self, l: L, covered: &mut BitRows<L>, patch: &Patch<L>) {
        if !patch.some.any() {
            return;
        }
        let columns = each2(
            #[inline(always)]
            |k| self.bit(patch.x[k]),
        );
        let rows = each2(
            #[inline(always)]
            |k| self.bit(patch.y[k]),
        );
        let none = U32::splat(l, 0);
        let mask = patch.some.select_u32(columns_of(l, columns), none);
        let mut rest = rows_in_use(l, rows, patch);
        while let Some((row, bits)) = next_row(&mut rest, covered) {
            let row = I32::splat(l, row as i32);
            let inside = row.ge(rows[0]) & row.lt(rows[1]);
            *bits = *bits | inside.select_u32(mask, none);
        }
    }

    #[inline(always)]
    fn hidden<L: Lanes>(&self, l: L, covered: &BitRows<L>) -> F32<L> {
        share_of(l, covered, self.side)
    }
}

/// How many bits are set: by pairs, fours, bytes, then all.
#[inline(always)]
fn ones<L: Lanes>(l: L, v: U32<L>) -> U32<L> {
    let splat = |x: u32| U32::splat(l, x);
    let pairs = v - ((v >> 1) & splat(0x5555_5555));
    let fours = (pairs & splat(0x3333_3333)) + ((pairs >> 2) & splat(0x3333_3333));
    let bytes = (fours + (fours >> 4)) & splat(0x0f0f_0f0f);
    let halves = bytes + (bytes >> 8);
    (halves + (halves >> 16)) & splat(0x3f)
}
