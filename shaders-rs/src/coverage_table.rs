//! Coverage from a four-dimensional texture (paper III, §3.3), which knows the
//! light's colours: entry (x0, y0, x1, y1) is the covered share of each colour for
//! the clipped edge between the two points.
//!
//! The four dimensions are laid out in an image of n^2 by n^2 texels: tile
//! (x1, y1), texel (x0, y0) in it. Entries hold twice the share, so that 8 bits
//! span its range of 0 to 1/2.

use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::{each3, each4};
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::coverage::Segment;
use crate::soft_volumes::texel_of;

/// How the coverage texture is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoverageTable {
    /// Entries in each dimension, at least 2.
    pub size: u32,
    /// Linear in all four dimensions, else the nearest entry.
    pub linear: bool,
    /// The first and last entries are on the light's border; else entries are at
    /// the centres of `size` equal cells.
    pub vertex_centred: bool,
    /// Entries hold the share, and not twice the share: colours in 8 bits, of which all
    /// may be covered.
    pub whole: bool,
}
uniforms!(CoverageTable {
    size,
    linear,
    vertex_centred,
    whole
});

/// Coverage between two images of a light, one texture for each: lights add up, and so do
/// their coverages, by how much of each colour comes from which (paper III, §3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlendedTables {
    /// How both textures are read.
    pub table: CoverageTable,
    /// How much of each colour comes from the second.
    pub parts: [f32; 3],
}
uniforms!(BlendedTables { table, parts });

impl BlendedTables {
    /// Covered share of each colour, from the textures in `slot` and the next.
    #[inline(always)]
    pub fn look_up<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        segment: &Segment<L>,
    ) -> [F32<L>; 3] {
        let mut sum = [F32::splat(l, 0.0); 3];
        for k in 0..2 {
            let share = self.table.look_up(l, f, slot + k, segment);
            sum = each3(
                #[inline(always)]
                |i| {
                    let part = self.parts[i];
                    sum[i] + share[i] * if k == 0 { 1.0 - part } else { part }
                },
            );
        }
        sum
    }
}

impl CoverageTable {
    /// Coordinate, -1..1, of entry `index` along one dimension.
    #[must_use]
    pub fn coordinate(&self, index: u32) -> f64 {
        let n = f64::from(self.size);
        if self.vertex_centred {
            2.0 * f64::from(index) / (n - 1.0) - 1.0
        } else {
            (2.0 * f64::from(index) + 1.0) / n - 1.0
        }
    }

    /// Place among the entries, 0 to size - 1.
    #[inline(always)]
    fn place<L: Lanes>(&self, x: F32<L>) -> F32<L> {
        let n = self.size as f32;
        let place = if self.vertex_centred {
            (x + 1.0) * (0.5 * (n - 1.0))
        } else {
            (x + 1.0) * (0.5 * n) - 0.5
        };
        place.clamp(0.0, n - 1.0)
    }

    /// An end for the linear filter: near the light's centre coverage depends on the
    /// direction alone, and entries on all sides of the centre have nothing to do with
    /// it. So ends are looked up two entries away from there, on their ray.
    #[inline(always)]
    fn off_centre<L: Lanes>(&self, l: L, [x, y]: [F32<L>; 2]) -> [F32<L>; 2] {
        if !self.linear {
            return [x, y];
        }
        let one = F32::splat(l, 1.0);
        let least = F32::splat(l, (4.0 / (self.size as f32 - 1.0)).min(1.0));
        let reach = x.abs().max(y.abs());
        let near = reach.lt(least) & reach.gt(F32::splat(l, 0.0));
        let scale = near.select_f32(least, one) / near.select_f32(reach, one);
        [x * scale, y * scale]
    }

    /// Covered share of each colour, from the texture in `slot`.
    #[inline(always)]
    pub fn look_up<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        segment: &Segment<L>,
    ) -> [F32<L>; 3] {
        let [p, q] = segment.ends;
        let [p, q] = [self.off_centre(l, p), self.off_centre(l, q)];
        let places = [
            self.place(p[0]),
            self.place(p[1]),
            self.place(q[0]),
            self.place(q[1]),
        ];
        let zero = F32::splat(l, 0.0);
        let entry = self.filtered(l, f, slot, places);
        let scale = if self.whole { 1.0 } else { 0.5 };
        each3(
            #[inline(always)]
            |i| segment.some.select_f32(entry[i] * scale, zero),
        )
    }

    /// Sum over the 16 entries round a place, or the nearest entry alone: the same
    /// loop, so that the look-up is compiled once.
    #[inline(always)]
    fn filtered<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        places: [F32<L>; 4],
    ) -> [F32<L>; 3] {
        let one = F32::splat(l, 1.0);
        let limit = F32::splat(l, self.size as f32 - 2.0);
        let low = each4(
            #[inline(always)]
            |k| {
                if self.linear {
                    places[k].floor().min(limit)
                } else {
                    places[k].round_ties_even()
                }
            },
        );
        let mut sum = [F32::splat(l, 0.0); 3];
        let corners = if self.linear { 16 } else { 1 };
        for corner in 0..corners {
            let mut at = low;
            let mut weight = one;
            for k in 0..4 {
                let part = places[k] - low[k];
                if corner >> k & 1 == 1 {
                    at[k] = at[k] + 1.0;
                    weight = weight * part;
                } else if self.linear {
                    weight = weight * (one - part);
                }
            }
            let entry = self.entry(l, f, slot, at);
            sum = each3(
                #[inline(always)]
                |i| sum[i] + entry[i] * weight,
            );
        }
        sum
    }

    #[inline(always)]
    fn entry<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        [x0, y0, x1, y1]: [F32<L>; 4],
    ) -> [F32<L>; 3] {
        let n = self.size as f32;
        let at = [
            (x1 * n + x0).to_i32(),
            (y1 * n + y0).to_i32(),
            I32::splat(l, 0),
        ];
        let [r, g, b, _] = texel_of(l, f, slot, at);
        [r, g, b]
    }
}
