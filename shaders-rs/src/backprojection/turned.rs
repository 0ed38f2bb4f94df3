//! Bits that lie on no common line along the light's sides.

use gnomon_raster::{F32, I32, Lanes, U32};

use super::cover::{BitRows, LightCover, MOST_BITS, columns_of, next_row, rows_in_use, share_of};
use super::patches::Patch;
use crate::bounded::bounded_uniforms;
use crate::vector::each2;

/// A [`BitField`](super::cover::BitField) turned by `atan(1 / side)`, so that no two bits
/// have the same x or y: an edge along the light's sides passes them one by one, not a row
/// at a time. Of a row, the bits that a rectangle holds still follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TurnedBits {
    /// Bits along a side.
    pub side: u32,
}
bounded_uniforms!(TurnedBits { side }: |b| [
    ("bits along a side", b.side.into(), MOST_BITS as u64),
]);

impl TurnedBits {
    /// With bit i of row j at `(i + (j + 1/2) / n, j + 1 - (i + 1/2) / n)` cells: the first
    /// column of row j whose x is at or beyond a place of the light, `x` cells from its
    /// border.
    #[inline(always)]
    fn column_at_x<L: Lanes>(&self, row: usize, x: F32<L>) -> I32<L> {
        let side = self.side as f32;
        let shift = (row as f32 + 0.5) / side;
        (x - shift).ceil().clamp(0.0, side).to_i32()
    }

    /// The first column of row j whose y is below a place, `y` cells from the border: y
    /// falls along a row.
    #[inline(always)]
    fn column_below_y<L: Lanes>(&self, l: L, row: usize, y: F32<L>) -> I32<L> {
        let side = self.side as f32;
        let above = F32::splat(l, (row + 1) as f32) - y;
        (above * side + 0.5).floor().clamp(0.0, side).to_i32()
    }
}

impl LightCover for TurnedBits {
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
        let cells = 0.5 * self.side as f32;
        let x = each2(
            #[inline(always)]
            |k| (patch.x[k].clamp(-1.0, 1.0) + 1.0) * cells,
        );
        let y = each2(
            #[inline(always)]
            |k| (patch.y[k].clamp(-1.0, 1.0) + 1.0) * cells,
        );
        let none = U32::splat(l, 0);
        let rows = [y[0].floor().to_i32(), y[1].ceil().to_i32()];
        let mut rest = rows_in_use(l, rows, patch);
        while let Some((row, bits)) = next_row(&mut rest, covered) {
            let [low, high] = each2(
                #[inline(always)]
                |k| self.column_at_x(row, x[k]),
            );
            let [end, first] = each2(
                #[inline(always)]
                |k| self.column_below_y(l, row, y[k]),
            );
            let mask = columns_of(l, [low.max(first), high.min(end)]);
            *bits = *bits | patch.some.select_u32(mask, none);
        }
    }

    #[inline(always)]
    fn hidden<L: Lanes>(&self, l: L, covered: &BitRows<L>) -> F32<L> {
        share_of(l, covered, self.side)
    }
}
