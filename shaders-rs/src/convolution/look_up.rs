//! Means of prefiltered images over a rectangle of the light view, at a cost that
//! does not depend on its size.

use gnomon_raster::math::{exp2, log2};
use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each4;
use gnomon_raster::{F32, I32, Lanes, U32, uniforms};

use super::{Atlas, Encoding};
use crate::bounded::bounded_uniforms;
use crate::coverage::outlined;

/// Tiles of one kind in a texture slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Images {
    /// Texture slot.
    pub slot: usize,
    /// Where tiles are.
    pub atlas: Atlas,
    /// How values are stored.
    pub encoding: Encoding,
}
uniforms!(Images {
    slot,
    atlas,
    encoding
});

/// A rectangle in image coordinates (u, v), 0..1 over the light view.
#[derive(Clone, Copy)]
pub struct Rectangle<L: Lanes> {
    /// Its centre.
    pub centre: [F32<L>; 2],
    /// Half its width and height.
    pub half: [F32<L>; 2],
}

/// A kind of prefiltered images.
pub trait Prefiltered: Copy + Send + Sync {
    /// What a rectangle comes to, for all look-ups over it.
    type Window<L: Lanes>: Copy;

    /// Prepares the look-ups over a rectangle.
    fn window<L: Lanes>(&self, l: L, rectangle: &Rectangle<L>) -> Self::Window<L>;

    /// The part of the rectangle that lies in the light view, 0..=1. No caster is
    /// seen in the rest.
    fn share<L: Lanes>(window: &Self::Window<L>) -> F32<L>;

    /// The means of the four channels of tile `tile`.
    fn four<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        window: &Self::Window<L>,
    ) -> [F32<L>; 4];

    /// The mean of an image of one channel.
    fn one<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        image: &Images,
        window: &Self::Window<L>,
    ) -> F32<L>;
}

/// Part of `low..high` in `0..limit`, as a share of the whole; 0 where that is
/// nothing.
#[inline(always)]
fn part<L: Lanes>(low: F32<L>, high: F32<L>, limit: f32) -> F32<L> {
    let inside = high.min(F32::splat(low.lanes(), limit)) - low.clamp(0.0, f32::INFINITY);
    (inside / (high - low)).clamp(0.0, 1.0)
}

/// Mip chains, looked up trilinearly: a square of the rectangle's area, or for
/// rectangular lights several along its longer side, as anisotropic filters do (§5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mipmaps {
    /// Texels along a side of a tile.
    pub side: u32,
    /// Added to the level whose texels are as wide as the square.
    pub lod_bias: f32,
    /// Squares along the longer side.
    pub probes: u32,
    /// The longer side: 0 is u, 1 is v.
    pub along: usize,
}
bounded_uniforms!(Mipmaps { side, lod_bias, probes, along }: |m| [
    ("squares along the longer side", m.probes.into(), 64),
    ("the longer side", m.along as u64, 1),
]);

/// Where [`Mipmaps`] look.
#[derive(Clone, Copy)]
pub struct Squares<L: Lanes> {
    rectangle: Rectangle<L>,
    lod: F32<L>,
    /// Half a texel of the coarser level: nearer to a tile's border the filter would
    /// reach into the next tile.
    margin: F32<L>,
    share: F32<L>,
}

impl Mipmaps {
    /// Coordinates of probe `i` in a tile, 0..1.
    #[inline(always)]
    fn probe<L: Lanes>(&self, squares: &Squares<L>, i: u32) -> [F32<L>; 2] {
        let mut at = squares.rectangle.centre;
        let shift = (2 * i + 1) as f32 / self.probes as f32 - 1.0;
        at[self.along] = at[self.along] + squares.rectangle.half[self.along] * shift;
        let most = -squares.margin + 1.0;
        for c in &mut at {
            *c = c.max(squares.margin).min(most);
        }
        at
    }
}

impl Prefiltered for Mipmaps {
    type Window<L: Lanes> = Squares<L>;

    #[inline(always)]
    fn window<L: Lanes>(&self, l: L, r: &Rectangle<L>) -> Squares<L> {
        let side = self.side as f32;
        let (mut centre, mut half) = (r.centre, r.half);
        let mut share = F32::splat(l, 1.0);
        // No less than a texel, as lights without width have it.
        let least = F32::splat(l, 0.5 / side);
        for k in 0..2 {
            let whole = half[k].max(least);
            let (low, high) = (centre[k] - whole, centre[k] + whole);
            share = share * part(low, high, 1.0);
            // What is outside is empty: squares are of the part inside.
            let (low, high) = (low.clamp(0.0, 1.0), high.clamp(0.0, 1.0));
            centre[k] = (low + high) * 0.5;
            half[k] = ((high - low) * 0.5).max(least);
        }
        let area = (half[0] * (2.0 * side)) * (half[1] * (2.0 * side));
        let width = (area * (1.0 / self.probes as f32)).sqrt();
        let levels = self.side.trailing_zeros() as f32;
        let lod = (log2(width.clamp(1.0, side)) + self.lod_bias).clamp(0.0, levels);
        let margin = exp2(lod.ceil()) * (0.5 / side);
        Squares {
            rectangle: Rectangle { centre, half },
            lod,
            margin,
            share,
        }
    }

    #[inline(always)]
    fn share<L: Lanes>(squares: &Squares<L>) -> F32<L> {
        squares.share
    }

    #[inline(always)]
    fn four<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        squares: &Squares<L>,
    ) -> [F32<L>; 4] {
        let zero = F32::splat(l, 0.0);
        let [column, row] = images.atlas.cell(tile);
        let cell = [column as f32, row as f32];
        let Atlas { columns, rows, .. } = images.atlas;
        let scale = [1.0 / columns as f32, 1.0 / rows as f32];
        let mut sum = [zero; 4];
        for i in 0..self.probes {
            let [u, v] = self.probe(squares, i);
            let at = [(u + cell[0]) * scale[0], (v + cell[1]) * scale[1], zero];
            let texel = f.sample_level(images.slot, at, squares.lod);
            sum = each4(
                #[inline(always)]
                |c| sum[c] + texel[c],
            );
        }
        each4(
            #[inline(always)]
            |c| images.encoding.read(sum[c] * (1.0 / self.probes as f32)),
        )
    }

    #[inline(always)]
    fn one<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        image: &Images,
        squares: &Squares<L>,
    ) -> F32<L> {
        self.four(l, f, image, 0, squares)[0]
    }
}

/// Where a box's edges are between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxEdges {
    /// Where they are.
    Exact,
    /// At the nearest border of texels.
    Texel,
}
uniforms!(enum BoxEdges { 0: Exact, 1: Texel });

/// A box in texels of a tile: edges in 0..=side − 1, at least one texel apart.
#[derive(Clone, Copy)]
pub struct TexelBox<L: Lanes> {
    /// Low and high edge of columns, then of rows.
    edges: [[F32<L>; 2]; 2],
    /// 1 / area.
    per_texel: F32<L>,
    share: F32<L>,
}

impl<L: Lanes> TexelBox<L> {
    /// The tables' last column and row are sums without the last texels, which so
    /// are never read: they count as outside.
    #[inline(always)]
    fn new(l: L, r: &Rectangle<L>, side: u32, snapped: BoxEdges) -> Self {
        let limit = (side - 1) as f32;
        let mut edges = [[F32::splat(l, 0.0); 2]; 2];
        let mut share = F32::splat(l, 1.0);
        for (k, axis) in edges.iter_mut().enumerate() {
            let centre = r.centre[k] * side as f32;
            let half = (r.half[k] * side as f32).max(F32::splat(l, 0.5));
            let (low, high) = (centre - half, centre + half);
            share = share * part(low, high, limit);
            let mut low = low.clamp(0.0, limit - 1.0);
            let mut high = high.clamp(0.0, limit);
            if snapped == BoxEdges::Texel {
                (low, high) = (low.round_ties_even(), high.round_ties_even());
            }
            *axis = [low, high.max(low + 1.0)];
        }
        let [[x0, x1], [y0, y1]] = edges;
        Self {
            edges,
            per_texel: F32::splat(l, 1.0) / ((x1 - x0) * (y1 - y0)),
            share,
        }
    }
}

/// Summed-area tables of floats, four channels a texel (Crow 1984): four look-ups a
/// box, each bilinear where edges are [`BoxEdges::Exact`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatTables {
    /// Texels along a side of a tile.
    pub side: u32,
    /// Where edges are.
    pub edges: BoxEdges,
    /// Whether the tables are of [`super::prefilter::LessMean`]: a fifth look-up, of
    /// the mean.
    pub centred: bool,
}
uniforms!(FloatTables {
    side,
    edges,
    centred
});

impl FloatTables {
    /// What was taken off the texels of a tile.
    #[inline(always)]
    fn taken_off<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
    ) -> [F32<L>; 4] {
        let factor = super::prefilter::mean_factor(self.side);
        let [column, row] = images.atlas.cell(tile);
        let level = self.side.trailing_zeros();
        let at = [I32::splat(l, column as i32), I32::splat(l, row as i32)];
        let mean = super::prefilter::texel_at(l, f, images.slot, at, level);
        each4(
            #[inline(always)]
            |i| mean[i] * factor,
        )
    }

    #[inline(always)]
    fn corner<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        at: [F32<L>; 2],
    ) -> [F32<L>; 4] {
        let [column, row] = images.atlas.origin(tile);
        let [x, y] = [at[0] + column as f32, at[1] + row as f32];
        if self.edges == BoxEdges::Texel {
            let at = [x.to_i32(), y.to_i32(), I32::splat(l, 0)];
            return crate::soft_volumes::texel_of(l, f, images.slot, at);
        }
        let [width, height] = images.atlas.size();
        let [w, h] = [1.0 / width as f32, 1.0 / height as f32];
        let zero = F32::splat(l, 0.0);
        f.sample_level(images.slot, [(x + 0.5) * w, (y + 0.5) * h, zero], zero)
    }
}

impl Prefiltered for FloatTables {
    type Window<L: Lanes> = TexelBox<L>;

    #[inline(always)]
    fn window<L: Lanes>(&self, l: L, rectangle: &Rectangle<L>) -> TexelBox<L> {
        TexelBox::new(l, rectangle, self.side, self.edges)
    }

    #[inline(always)]
    fn share<L: Lanes>(window: &TexelBox<L>) -> F32<L> {
        window.share
    }

    #[inline(always)]
    fn four<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        window: &TexelBox<L>,
    ) -> [F32<L>; 4] {
        let [[x0, x1], [y0, y1]] = window.edges;
        let [a, b, c, d] = [
            self.corner(l, f, images, tile, [x0, y0]),
            self.corner(l, f, images, tile, [x1, y0]),
            self.corner(l, f, images, tile, [x0, y1]),
            self.corner(l, f, images, tile, [x1, y1]),
        ];
        let means = each4(
            #[inline(always)]
            |i| ((d[i] - c[i]) - (b[i] - a[i])) * window.per_texel,
        );
        if !self.centred {
            return each4(
                #[inline(always)]
                |i| images.encoding.read(means[i]),
            );
        }
        let taken = self.taken_off(l, f, images, tile);
        each4(
            #[inline(always)]
            |i| images.encoding.read(means[i] + taken[i]),
        )
    }

    #[inline(always)]
    fn one<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        image: &Images,
        window: &TexelBox<L>,
    ) -> F32<L> {
        self.four(l, f, image, 0, window)[0]
    }
}

/// Summed-area tables of 32-bit integers that wrap, one channel a tile. A box's sum
/// is exact where it is below 2³², whatever has wrapped before. Filters do not work
/// on integers, so a box with [`BoxEdges::Exact`] is nine smaller ones from 16
/// entries; one with [`BoxEdges::Texel`] takes four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegerTables {
    /// Texels along a side of a tile.
    pub side: u32,
    /// Where edges are.
    pub edges: BoxEdges,
}
uniforms!(IntegerTables { side, edges });

/// Entries along one axis, and the weights of the texels between them.
#[derive(Clone, Copy)]
struct Entries<L: Lanes> {
    index: [I32<L>; 4],
    weight: [F32<L>; 3],
}

impl IntegerTables {
    /// The first `count` + 1 entries and `count` weights mean something.
    #[inline(always)]
    fn count(&self) -> usize {
        if self.edges == BoxEdges::Exact { 3 } else { 1 }
    }

    #[inline(always)]
    fn entries<L: Lanes>(&self, l: L, [low, high]: [F32<L>; 2], origin: u32) -> Entries<L> {
        let origin = I32::splat(l, origin as i32);
        let one = F32::splat(l, 1.0);
        let [first, last] = [low.floor(), high.floor()];
        let [i, j] = [first.to_i32(), last.to_i32()];
        let next = I32::splat(l, 1);
        // The last entry's texel has weight 0 there.
        let most = I32::splat(l, self.side as i32 - 1);
        if self.edges == BoxEdges::Texel {
            let index = [i, j, j, j];
            return Entries {
                index: each4(
                    #[inline(always)]
                    |k| index[k] + origin,
                ),
                weight: [one; 3],
            };
        }
        let index = [i, i + next, j, (j + next).min(most)];
        Entries {
            index: each4(
                #[inline(always)]
                |k| index[k] + origin,
            ),
            weight: [one - (low - first), one, high - last],
        }
    }

    /// Sum of a channel over the box.
    #[inline(always)]
    fn sum<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        [x, y]: [&Entries<L>; 2],
    ) -> F32<L> {
        let count = self.count();
        let mut before = [U32::splat(l, 0); 3];
        let mut sum = F32::splat(l, 0.0);
        for row in 0..=count {
            let mut entry = bits_of(l, f, slot, [x.index[0], y.index[row]]);
            for column in 0..count {
                let next = bits_of(l, f, slot, [x.index[column + 1], y.index[row]]);
                let upwards = next - entry;
                if row > 0 {
                    let cell = float(l, upwards - before[column]);
                    sum = sum + cell * x.weight[column] * y.weight[row - 1];
                }
                before[column] = upwards;
                entry = next;
            }
        }
        sum
    }

    /// The mean of the only channel of tile `tile`.
    #[inline(always)]
    pub fn mean<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        window: &TexelBox<L>,
    ) -> F32<L> {
        let [column, row] = images.atlas.origin(tile);
        let x = self.entries(l, window.edges[0], column);
        let y = self.entries(l, window.edges[1], row);
        let sum = self.sum(l, f, images.slot, [&x, &y]);
        images.encoding.read(sum * window.per_texel)
    }
}

impl Prefiltered for IntegerTables {
    type Window<L: Lanes> = TexelBox<L>;

    #[inline(always)]
    fn window<L: Lanes>(&self, l: L, rectangle: &Rectangle<L>) -> TexelBox<L> {
        TexelBox::new(l, rectangle, self.side, self.edges)
    }

    #[inline(always)]
    fn share<L: Lanes>(window: &TexelBox<L>) -> F32<L> {
        window.share
    }

    #[inline(always)]
    fn four<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        tile: usize,
        window: &TexelBox<L>,
    ) -> [F32<L>; 4] {
        let mut means = [F32::splat(l, 0.0); 4];
        for (channel, mean) in means.iter_mut().enumerate() {
            *mean = self.mean(l, f, images, 4 * tile + channel, window);
        }
        means
    }

    #[inline(always)]
    fn one<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        image: &Images,
        window: &TexelBox<L>,
    ) -> F32<L> {
        self.mean(l, f, image, 0, window)
    }
}

/// An integer of a texture, in a function of its own for all shaders.
#[inline(always)]
pub(super) fn bits_of<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    slot: usize,
    [x, y]: [I32<L>; 2],
) -> U32<L> {
    let zero = I32::splat(l, 0);
    outlined(
        l,
        #[inline(always)]
        || f.fetch_texel_bits(slot, [x, y, zero], 0),
    )
}

/// The nearest float, ties to even.
#[inline(always)]
fn float<L: Lanes>(l: L, v: U32<L>) -> F32<L> {
    let high = (v >> 16).to_i32().to_f32();
    let low = (v & U32::splat(l, 0xffff)).to_i32().to_f32();
    high * 65536.0 + low
}
