//! The test of modelled tiles against a wedge (paper II, §4), once for each tile.
//!
//! Tiles are squares of `2^shift` pixels anchored at pixel (0, 0). For each wedge a
//! rectangle of a small texture holds what became of its tiles, a texel each:
//! [`TileClasses`] fills it, and the shader of pixels looks it up ([`TileLookUp`]).

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use super::plane::{ScreenBox, ScreenPlane};

/// Which depths of a tile are known before its pixels' depths are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Culling {
    /// None: nothing is culled.
    #[default]
    None,
    /// The greatest, as hardware of the time: tiles may reach to the near plane.
    Zmax,
    /// The least as well.
    ZminZmax,
}
uniforms!(enum Culling { 0: None, 1: Zmax, 2: ZminZmax });

/// How a tile is found to be outside a wedge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutsideTest {
    /// By the wedge's planes, and by whatever `range` and `axes` hold.
    #[default]
    Planes,
    /// By `range` and `axes` alone.
    WithoutPlanes,
}
uniforms!(enum OutsideTest { 0: Planes, 1: WithoutPlanes });

/// What tiles are tested with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TileTest {
    /// What is known of tiles.
    pub culling: Culling,
    /// log2 of a tile's side in pixels.
    pub shift: u32,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// Which tests tell that a tile is out of the wedge's reach.
    pub outside: OutsideTest,
    /// The wedge's range of depth as planes, for the quick rejection test; each with
    /// the distance beyond it that counts as surely outside, as in `axes`.
    pub range: Vec<(ScreenPlane, f32)>,
    /// Planes of further separating axes, positive inside.
    pub axes: Vec<(ScreenPlane, f32)>,
}
uniforms!(TileTest {
    culling,
    shift,
    size,
    outside,
    range,
    axes
});

/// The planes of a wedge, as tiles and pixels are tested against them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgePlanes {
    /// Front, back, first and second side, positive inside. A surface in the second
    /// side plane belongs to the neighbour.
    pub planes: [ScreenPlane; 4],
    /// How far beyond the front plane a surface may lie, by this plane, where the depth
    /// of the rasterised plane still has it inside: vertices are snapped, and depth is
    /// rounded.
    pub front_margin: f32,
    /// Where the wedge ends, positive inside, if it does.
    pub bottom: Option<ScreenPlane>,
}
uniforms!(WedgePlanes {
    planes,
    front_margin,
    bottom
});

/// What a tile's test says, as it is stored.
pub mod class {
    /// Out of the wedge's reach: nothing of it need be looked at.
    pub const CULLED: f32 = 0.0;
    /// Its pixels decide.
    pub const CROSSING: f32 = 128.0 / 255.0;
    /// Wholly inside: pixels need no test.
    pub const INSIDE: f32 = 1.0;
}

/// Counts of [`TileClasses`].
pub const TILE_COUNTS: &[&str] = &["tiles-tested", "tiles-culled", "tiles-inside"];

/// Writes the class of a wedge's tiles to attachment 0, a fragment for each tile.
/// Texture 0 holds the greatest, texture 1 the least depth of each tile; see
/// [`super::buffers::TileDepths`].
#[derive(Clone, Debug, PartialEq)]
pub struct TileClasses {
    /// The wedge.
    pub wedge: WedgePlanes,
    /// The test.
    pub test: TileTest,
    /// What is added to a tile's column and row for its texel.
    pub offset: [i32; 2],
}
uniforms!(TileClasses {
    wedge,
    test,
    offset
});

impl FragmentShader for TileClasses {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: match self.test.culling {
                Culling::ZminZmax => 2,
                _ => 1,
            },
            counts: TILE_COUNTS,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let column = f.column() - I32::splat(l, self.offset[0]);
        let row = f.row() - I32::splat(l, self.offset[1]);
        let (tile, empty) = self.test.fetch(l, f, [column, row]);
        let culled = empty | self.outside(l, &tile);
        let inside = self.wedge.all_inside(l, &tile) & !culled;
        f.count(0, Mask::splat(l, true));
        f.count(1, culled);
        f.count(2, inside);
        let splat = |x: f32| F32::splat(l, x);
        let kept = inside.select_f32(splat(class::INSIDE), splat(class::CROSSING));
        let class = culled.select_f32(splat(class::CULLED), kept);
        f.set_color(0, [class, splat(0.0), splat(0.0), splat(0.0)]);
    }
}

impl TileClasses {
    #[inline(always)]
    fn outside<L: Lanes>(&self, l: L, tile: &ScreenBox<L>) -> Mask<L> {
        let mut outside = Mask::splat(l, false);
        if self.test.outside == OutsideTest::Planes {
            outside = self.wedge.any_outside(l, tile);
        }
        for (plane, margin) in self.test.range.iter().chain(&self.test.axes) {
            outside = outside | plane.greatest(tile).lt(F32::splat(l, -margin));
        }
        outside
    }
}

impl WedgePlanes {
    /// Boxes that lie outside of one of the planes.
    #[inline(always)]
    fn any_outside<L: Lanes>(&self, l: L, tile: &ScreenBox<L>) -> Mask<L> {
        let zero = F32::splat(l, 0.0);
        let [front, back, first, second] = &self.planes;
        front.greatest(tile).lt(F32::splat(l, -self.front_margin))
            | back.greatest(tile).lt(zero)
            | first.greatest(tile).lt(zero)
            | second.greatest(tile).le(zero)
            | self.below(
                l,
                #[inline(always)]
                |b| b.greatest(tile),
            )
    }

    /// Boxes that lie inside of all planes, whatever the depth test of the front plane
    /// makes of their surfaces.
    #[inline(always)]
    fn all_inside<L: Lanes>(&self, l: L, tile: &ScreenBox<L>) -> Mask<L> {
        let zero = F32::splat(l, 0.0);
        let [front, back, first, second] = &self.planes;
        front.least(tile).ge(F32::splat(l, self.front_margin))
            & back.least(tile).ge(zero)
            & first.least(tile).ge(zero)
            & second.least(tile).gt(zero)
            & !self.below(
                l,
                #[inline(always)]
                |b| b.least(tile),
            )
    }

    /// Where a value of the bottom is negative; nowhere without one.
    #[inline(always)]
    pub(super) fn below<L: Lanes>(&self, l: L, value: impl Fn(&ScreenPlane) -> F32<L>) -> Mask<L> {
        match &self.bottom {
            Some(bottom) => value(bottom).lt(F32::splat(l, 0.0)),
            None => Mask::splat(l, false),
        }
    }
}

impl TileTest {
    /// The boxes of tiles, and which have no surface.
    #[inline(always)]
    fn fetch<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        [column, row]: [I32<L>; 2],
    ) -> (ScreenBox<L>, Mask<L>) {
        let at = [column, row, I32::splat(l, 0)];
        let one = F32::splat(l, 1.0);
        let [greatest, ..] = f.fetch_texel(0, at, 0);
        let nearest = if self.culling == Culling::ZminZmax {
            one - f.fetch_texel(1, at, 0)[0]
        } else {
            one
        };
        let tile = ScreenBox {
            x: self.extent(column, self.size[0]),
            y: self.extent(row, self.size[1]),
            q: [one - greatest, nearest],
        };
        (tile, greatest.lt(F32::splat(l, 0.0)))
    }

    /// First and last pixel centre of a tile along an axis of `size` pixels.
    #[inline(always)]
    fn extent<L: Lanes>(&self, tile: I32<L>, size: u32) -> [F32<L>; 2] {
        let l = tile.to_f32().lanes();
        let first = (tile << self.shift).to_f32() + 0.5;
        let last = first + ((1u32 << self.shift) - 1) as f32;
        [first, last.min(F32::splat(l, size as f32 - 0.5))]
    }
}

/// Where pixels find the class of their tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileLookUp {
    /// log2 of a tile's side in pixels.
    pub shift: u32,
    /// What is added to a tile's column and row for its texel.
    pub offset: [i32; 2],
}
uniforms!(TileLookUp { shift, offset });

impl TileLookUp {
    /// Pixels whose tile is culled, and those whose tile is wholly inside; `slot` holds
    /// the classes.
    #[inline(always)]
    pub(super) fn classes<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
    ) -> [Mask<L>; 2] {
        let column = (f.column() >> self.shift) + I32::splat(l, self.offset[0]);
        let row = (f.row() >> self.shift) + I32::splat(l, self.offset[1]);
        let [stored, ..] = f.fetch_texel(slot, [column, row, I32::splat(l, 0)], 0);
        [
            stored.eq(F32::splat(l, class::CULLED)),
            stored.eq(F32::splat(l, class::INSIDE)),
        ]
    }
}
