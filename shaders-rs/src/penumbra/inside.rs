//! Paper II: umbra and penumbra apart, alone or in one pass, with tiles culled.
//!
//! The umbra's boundary is the front planes. Whether it lies between eye and
//! surface is the sign of the *same* plane value that decides whether the surface
//! is inside the wedge (docs/papers.md, paper II, hazards): a surface on the front plane
//! can not be counted by one and missed by the other, whatever the rounding.
//! Where depth is 1 nothing is added.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use super::intensity::{Distances, IntensityRates};
use super::plane::{ScreenBox, ScreenPlane, ScreenPoint};
use super::{FULL, seen};

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

/// The test of modelled tiles against a wedge (paper II, §4). Tiles are squares of
/// `2^shift` pixels anchored at pixel (0, 0).
///
/// Texture 1 holds the greatest, texture 2 the least depth of each tile; see
/// [`super::buffers::TileDepths`].
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

/// What a draw adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// 255 per front plane; out of the shader's hands in stencil passes.
    Umbra,
    /// The intensity at surfaces inside the wedge.
    Penumbra,
    /// Both, for front planes that a single pass draws once.
    Both,
}
uniforms!(enum Part { 0: Umbra, 1: Penumbra, 2: Both });

/// Adds a wedge's part to attachment 0 and discards where there is nothing to
/// add. Without colour attachment what is left counts in the stencil. Texture 0
/// is depth; 1 and 2 as [`TileTest`] needs.
#[derive(Clone, Debug, PartialEq)]
pub struct WedgeInside {
    /// Front, back, first and second side, positive inside. A surface in the
    /// second side plane belongs to the neighbour.
    pub planes: [ScreenPlane; 4],
    /// For the intensity.
    pub rates: IntensityRates,
    /// What to add.
    pub part: Part,
    /// Count umbra boundaries beyond the surface instead of before it.
    pub depth_fail: bool,
    /// Tiles to leave out.
    pub tiles: TileTest,
}
uniforms!(WedgeInside {
    planes,
    rates,
    part,
    depth_fail,
    tiles
});

/// Which of a packet's tiles are out of reach, or wholly inside.
#[derive(Clone, Copy)]
struct TileClass<L: Lanes> {
    umbra_culled: Mask<L>,
    penumbra_culled: Mask<L>,
    accepted: Mask<L>,
}

impl FragmentShader for WedgeInside {
    fn outputs(&self) -> FragmentOutputs {
        let textures = match self.tiles.culling {
            Culling::None => 1,
            Culling::Zmax => 2,
            Culling::ZminZmax => 3,
        };
        FragmentOutputs {
            discards: true,
            textures,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let none = Mask::splat(l, true);
        let class = self.classify(l, f);
        let skip_umbra = if self.has_umbra() {
            class.umbra_culled
        } else {
            none
        };
        let skip_penumbra = if self.has_penumbra() {
            class.penumbra_culled
        } else {
            none
        };
        // Lanes without tile left read no depth.
        f.discard(skip_umbra & skip_penumbra);
        if !(f.live() & !(skip_umbra & skip_penumbra)).any() {
            return;
        }
        let (point, surface) = seen(l, f, 0);
        let values = Values::new(&self.planes, &point);
        let counted = self.counted(l, &values) & surface & !skip_umbra;
        let inside = (values.inside() | class.accepted) & surface & !skip_penumbra;
        f.discard(!(counted | inside));
        let zero = F32::splat(l, 0.0);
        let full = self.umbra_value(f.front_facing());
        let umbra = counted.select_f32(F32::splat(l, full), zero);
        let penumbra = inside.select_f32(values.light(&self.rates), zero);
        f.set_color(0, [umbra + penumbra, zero, zero, zero]);
    }
}

impl WedgeInside {
    fn has_umbra(&self) -> bool {
        self.part != Part::Penumbra
    }

    fn has_penumbra(&self) -> bool {
        self.part != Part::Umbra
    }

    /// What a boundary adds: entering the umbra before the surface takes 255;
    /// leaving it beyond takes as much.
    fn umbra_value(&self, front_facing: bool) -> f32 {
        if front_facing == self.depth_fail {
            FULL
        } else {
            -FULL
        }
    }

    /// Where the front plane lies between eye and surface, or, with depth fail,
    /// where it does not.
    #[inline(always)]
    fn counted<L: Lanes>(&self, l: L, values: &Values<L>) -> Mask<L> {
        let eye_inside = Mask::splat(l, self.planes[0].eye_is_inside());
        let behind_front = values.front.ge(F32::splat(l, 0.0));
        let before = behind_front ^ eye_inside;
        before ^ Mask::splat(l, self.depth_fail)
    }

    #[inline(always)]
    fn classify<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> TileClass<L> {
        let nothing = Mask::splat(l, false);
        let mut class = TileClass {
            umbra_culled: nothing,
            penumbra_culled: nothing,
            accepted: nothing,
        };
        if self.tiles.culling == Culling::None {
            return class;
        }
        let (tile, empty) = self.tiles.fetch(l, f);
        let zero = F32::splat(l, 0.0);
        let [front, back, first, second] = &self.planes;
        if self.has_umbra() {
            // All surfaces on one side of the plane: the one that counts nothing.
            let eye_inside = front.eye_is_inside();
            let all_inside = front.least(&tile).ge(zero);
            let all_outside = front.greatest(&tile).lt(zero);
            class.umbra_culled = empty
                | if eye_inside == self.depth_fail {
                    all_outside
                } else {
                    all_inside
                };
        }
        if self.has_penumbra() {
            let mut outside = nothing;
            if self.tiles.outside == OutsideTest::Planes {
                outside = front.greatest(&tile).lt(zero)
                    | back.greatest(&tile).lt(zero)
                    | first.greatest(&tile).lt(zero)
                    | second.greatest(&tile).le(zero);
            }
            for (plane, margin) in self.tiles.range.iter().chain(&self.tiles.axes) {
                outside = outside | plane.greatest(&tile).lt(F32::splat(l, -margin));
            }
            class.penumbra_culled = empty | outside;
            class.accepted = front.least(&tile).ge(zero)
                & back.least(&tile).ge(zero)
                & first.least(&tile).ge(zero)
                & second.least(&tile).gt(zero);
        }
        class
    }
}

impl TileTest {
    /// The box of each fragment's tile, and tiles without surface.
    #[inline(always)]
    fn fetch<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> (ScreenBox<L>, Mask<L>) {
        let (column, row) = (f.column() >> self.shift, f.row() >> self.shift);
        let at = [column, row, I32::splat(l, 0)];
        let one = F32::splat(l, 1.0);
        let [greatest, ..] = f.fetch_texel(1, at, 0);
        let nearest = if self.culling == Culling::ZminZmax {
            one - f.fetch_texel(2, at, 0)[0]
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

/// Plane values of a surface point.
struct Values<L: Lanes> {
    front: F32<L>,
    back: F32<L>,
    first: F32<L>,
    second: F32<L>,
}

impl<L: Lanes> Values<L> {
    #[inline(always)]
    fn new([front, back, first, second]: &[ScreenPlane; 4], p: &ScreenPoint<L>) -> Self {
        Self {
            front: front.at(p),
            back: back.at(p),
            first: first.at(p),
            second: second.at(p),
        }
    }

    #[inline(always)]
    fn inside(&self) -> Mask<L> {
        let zero = F32::splat(self.front.lanes(), 0.0);
        self.front.ge(zero) & self.back.ge(zero) & self.first.ge(zero) & self.second.gt(zero)
    }

    /// 255 times the intensity, rounded; meaningful inside.
    #[inline(always)]
    fn light(&self, rates: &IntensityRates) -> F32<L> {
        let s = rates.intensity(&Distances {
            front: self.front,
            back: self.back,
            first: self.first,
            second: self.second,
        });
        (s * FULL).round_ties_even()
    }
}
