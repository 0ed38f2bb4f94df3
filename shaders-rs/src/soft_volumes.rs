//! Soft shadow volumes on a float visibility buffer (paper III; docs/papers.md, paper III
//! and §1.4): hard shadow quads count, penumbra wedges correct.
//!
//! Both read where the fragment's surface is from texture 0 (w is 0 where no
//! shadow falls: nothing is added there) and decide its side of a quad by one
//! expression, [`HardPlane::umbra_side`], so that count and correction cannot
//! disagree.

use gnomon_raster::math::dot3;
use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::simd::{each3, each4};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use crate::coverage::outlined;
use crate::coverage::{Edge, Projector, Segment, clip, covered};
use crate::coverage_table::{BlendedTables, CoverageTable};
use crate::transform::{ClipFromWorld, FullScreen};

/// The first `N` textures at the fragment's own pixel; zero beyond `count`. One
/// loop, so that the look-up is compiled once.
#[inline(always)]
pub(crate) fn own_texels<L: Lanes, const N: usize>(
    l: L,
    f: &mut Fragment<'_, L>,
    count: usize,
) -> [[F32<L>; 4]; N] {
    let at = [f.column(), f.row(), I32::splat(l, 0)];
    let mut texels = [[F32::splat(l, 0.0); 4]; N];
    for (slot, texel) in texels.iter_mut().enumerate().take(count) {
        *texel = texel_of(l, f, slot, at);
    }
    texels
}

/// One texel, in a function of its own for all shaders.
#[inline(always)]
pub(crate) fn texel_of<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    slot: usize,
    at: [I32<L>; 3],
) -> [F32<L>; 4] {
    texel_of_mip(l, f, slot, at, 0)
}

/// The same of an image of a mip chain.
#[inline(always)]
pub(crate) fn texel_of_mip<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    slot: usize,
    at: [I32<L>; 3],
    mip: u32,
) -> [F32<L>; 4] {
    outlined(
        l,
        #[inline(always)]
        || f.fetch_texel(slot, at, mip),
    )
}

/// A position relative to `origin`, and whether shadow may fall on it.
#[inline(always)]
pub(crate) fn receiver<L: Lanes>(
    l: L,
    texel: [F32<L>; 4],
    origin: [f32; 3],
) -> ([F32<L>; 3], Mask<L>) {
    let from = each3(
        #[inline(always)]
        |i| texel[i] - origin[i],
    );
    (from, texel[3].gt(F32::splat(l, 0.0)))
}

/// The plane through the light's centre and an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardPlane {
    /// Out of the umbra.
    pub normal: [f32; 3],
    /// The plane's value at [`Projector::origin`]: 0 where that is the centre.
    pub offset: f32,
}
uniforms!(HardPlane { normal, offset });

impl HardPlane {
    /// For positions relative to the light's centre.
    pub fn through_centre(normal: [f32; 3]) -> Self {
        Self {
            normal,
            offset: 0.0,
        }
    }

    /// Whether positions relative to the light's origin are on the umbra side.
    #[inline(always)]
    pub fn umbra_side<L: Lanes>(&self, l: L, from: [F32<L>; 3]) -> Mask<L> {
        umbra_side(
            l,
            each3(
                #[inline(always)]
                |i| F32::splat(l, self.normal[i]),
            ),
            F32::splat(l, self.offset),
            from,
        )
    }
}

/// The one predicate: on the plane counts as outside.
#[inline(always)]
fn umbra_side<L: Lanes>(l: L, normal: [F32<L>; 3], offset: F32<L>, from: [F32<L>; 3]) -> Mask<L> {
    (dot3(normal, from) + offset).lt(F32::splat(l, 0.0))
}

/// The predicate for the plane in the varyings of [`HardQuads`].
#[inline(always)]
pub(crate) fn umbra_side_of<L: Lanes>(l: L, f: &mut Fragment<'_, L>, from: [F32<L>; 3]) -> Mask<L> {
    let normal = each3(
        #[inline(always)]
        |i| f.varying(i),
    );
    umbra_side(l, normal, f.varying(4), from)
}

/// Attributes: homogeneous position, normal of the quad's [`HardPlane`], 1 where the
/// eye is on its umbra side, else 0, and its offset where there are `offsets`. Five
/// flat varyings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardQuads {
    /// The view.
    pub clip_from_world: ClipFromWorld,
    /// Whether planes have an offset, attribute 8; else it is 0.
    pub offsets: bool,
}
uniforms!(HardQuads {
    clip_from_world,
    offsets
});

impl VertexShader for HardQuads {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Flat; 5]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let position = each4(
            #[inline(always)]
            |i| v.attribute(i),
        );
        for i in 0..4 {
            let flat = v.attribute(4 + i);
            v.set_varying(i, flat);
        }
        let offset = if self.offsets {
            v.attribute(8)
        } else {
            F32::splat(l, 0.0)
        };
        v.set_varying(4, offset);
        v.set_position(self.clip_from_world.apply(position));
    }
}

/// What a hard shadow count is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountTo {
    /// Attachment 0, to be added: -1 for entering the umbra, 1 for leaving it.
    Visibility,
    /// Alpha of attachments 0 and 1, in steps of 1/255: leaving, and entering.
    Alpha,
    /// No attachment: what crosses no quad is discarded, and the draw's stencil
    /// operations count the rest.
    Stencil,
}
uniforms!(enum CountTo { 0: Visibility, 1: Alpha, 2: Stencil });

/// Counts hard shadow quads between the eye and the surface: those whose plane
/// has them on different sides. It needs no depth test and no caps, and is right
/// wherever the eye is, once the eye's own count is taken off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardCount {
    /// The light's origin, as [`Projector::origin`].
    pub origin: [f32; 3],
    /// Where the count goes.
    pub to: CountTo,
}
uniforms!(HardCount { origin, to });

impl FragmentShader for HardCount {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: self.to == CountTo::Stencil,
            ..reads(1)
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [position] = own_texels(l, f, 1);
        let (from, shadowable) = receiver(l, position, self.origin);
        let normal = each3(
            #[inline(always)]
            |i| f.varying(i),
        );
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let inside = umbra_side(l, normal, f.varying(4), from).select_f32(one, zero);
        let entered = shadowable.select_f32(inside - f.varying(3), zero);
        match self.to {
            CountTo::Visibility => {
                let v = zero - entered;
                f.set_color(0, [v, v, v, zero]);
            }
            CountTo::Alpha => {
                let step = 1.0 / 255.0;
                let left = (-entered).max(zero) * step;
                f.set_color(0, [zero, zero, zero, left]);
                f.set_color(1, [zero, zero, zero, entered.max(zero) * step]);
            }
            CountTo::Stencil => f.discard(entered.eq(zero)),
        }
    }
}

/// The eye's own hard shadow count for [`HardCount`]: three vertices without data
/// over the whole screen, as if a quad had been entered so many times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeCount(pub f32);
uniforms!(EyeCount(count));

impl VertexShader for EyeCount {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Flat; 5]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        FullScreen.shade(l, v);
        let zero = F32::splat(l, 0.0);
        for i in 0..3 {
            v.set_varying(i, zero); // a normal of which nothing is on the umbra side
        }
        v.set_varying(3, F32::splat(l, -self.0));
        v.set_varying(4, zero);
    }
}

/// What the coverage of an edge is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoverTo {
    /// Attachment 0, to be added: plus on the umbra side, else minus.
    Visibility,
    /// The same on top of the visibility in texture 1: paper III's way without
    /// float blending.
    Copied,
    /// Coverage in 6 of 8 bits to attachment 0 on the umbra side, else to 1.
    SixBits,
    /// The same of one colour, to red of attachment 0 on the umbra side, else to green
    /// (paper III, §4.2).
    RedGreen,
}
uniforms!(enum CoverTo { 0: Visibility, 1: Copied, 2: SixBits, 3: RedGreen });

/// Largest coverage in 6 of 8 bits: four of them always fit.
pub const SIX_BITS: f32 = 63.0;

/// How the covered share is found from the clipped edge.
pub trait Covering: Copy + Send + Sync {
    /// Texture slots from 0 that shaders read besides others.
    const TEXTURES: usize;

    /// Covered share of each colour of the light.
    fn share<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        light: &Projector,
        segment: &Segment<L>,
    ) -> [F32<L>; 3];
}

/// In closed form, all colours alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactCoverage;
uniforms!(ExactCoverage);

impl Covering for ExactCoverage {
    const TEXTURES: usize = 2;

    #[inline(always)]
    fn share<L: Lanes>(
        &self,
        l: L,
        _: &mut Fragment<'_, L>,
        light: &Projector,
        segment: &Segment<L>,
    ) -> [F32<L>; 3] {
        [covered(l, light.image(), segment); 3]
    }
}

impl Covering for CoverageTable {
    const TEXTURES: usize = 3;

    #[inline(always)]
    fn share<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        _: &Projector,
        segment: &Segment<L>,
    ) -> [F32<L>; 3] {
        self.look_up(l, f, 2, segment)
    }
}

impl Covering for BlendedTables {
    const TEXTURES: usize = 4;

    #[inline(always)]
    fn share<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        _: &Projector,
        segment: &Segment<L>,
    ) -> [F32<L>; 3] {
        self.look_up(l, f, 2, segment)
    }
}

/// The penumbra of one edge: how much of the light it covers, taken away outside
/// the umbra and given back inside. Exactly 0 outside the penumbra, so the wedge
/// that is drawn only has to hold it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penumbra<C> {
    /// The light.
    pub light: Projector,
    /// How coverage is found.
    pub covering: C,
    /// The edge, in the light's coordinates.
    pub edge: Edge,
    /// What side of its hard shadow quad a fragment is on.
    pub plane: HardPlane,
    /// Where the coverage goes.
    pub to: CoverTo,
}
uniforms!(Penumbra<C> { light, covering, edge, plane, to });

impl<C: Covering> FragmentShader for Penumbra<C> {
    fn outputs(&self) -> FragmentOutputs {
        let copied = if self.to == CoverTo::Copied { 2 } else { 1 };
        reads(if C::TEXTURES > 2 { C::TEXTURES } else { copied })
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let count = if self.to == CoverTo::Copied { 2 } else { 1 };
        let [position, before] = own_texels(l, f, count);
        let (from, shadowable) = receiver(l, position, self.light.origin());
        let zero = F32::splat(l, 0.0);
        let projected = self.light.project(l, from, &self.edge);
        let mut segment = clip(l, self.light.image(), &projected);
        segment.some = segment.some & shadowable;
        let share = self.covering.share(l, f, &self.light, &segment);
        let inside = self.plane.umbra_side(l, from);
        match self.to {
            CoverTo::Visibility | CoverTo::Copied => {
                let [r, g, b] = each3(
                    #[inline(always)]
                    |i| inside.select_f32(share[i], zero - share[i]),
                );
                if self.to == CoverTo::Visibility {
                    f.set_color(0, [r, g, b, zero]);
                    return;
                }
                f.set_color(0, [before[0] + r, before[1] + g, before[2] + b, before[3]]);
            }
            CoverTo::SixBits => {
                let bits = each3(
                    #[inline(always)]
                    |i| (share[i] * SIX_BITS).round_ties_even() / 255.0,
                );
                let add = each3(
                    #[inline(always)]
                    |i| inside.select_f32(bits[i], zero),
                );
                let take = each3(
                    #[inline(always)]
                    |i| inside.select_f32(zero, bits[i]),
                );
                f.set_color(0, [add[0], add[1], add[2], zero]);
                f.set_color(1, [take[0], take[1], take[2], zero]);
            }
            CoverTo::RedGreen => {
                let bits = (share[0] * SIX_BITS).round_ties_even() / 255.0;
                let add = inside.select_f32(bits, zero);
                let take = inside.select_f32(zero, bits);
                f.set_color(0, [add, take, zero, zero]);
            }
        }
    }
}

/// What a buffer becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolve {
    /// Texture 0 as it is.
    Copy,
    /// Visibility from the 8-bit buffers in textures 0 and 1: added minus taken
    /// coverage over 63, and one per count of the alphas.
    SixBits,
}
uniforms!(enum Resolve { 0: Copy, 1: SixBits });

impl FragmentShader for Resolve {
    fn outputs(&self) -> FragmentOutputs {
        reads(if *self == Self::Copy { 1 } else { 2 })
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let count = self.outputs().textures;
        let [added, taken] = own_texels(l, f, count);
        if *self == Self::Copy {
            f.set_color(0, added);
            return;
        }
        let whole = each4(
            #[inline(always)]
            |i| ((added[i] - taken[i]) * 255.0).round_ties_even(),
        );
        let [r, g, b] = each3(
            #[inline(always)]
            |i| whole[3] + whole[i] / SIX_BITS + 1.0,
        );
        f.set_color(0, [r, g, b, F32::splat(l, 1.0)]);
    }
}

pub(crate) fn reads(textures: usize) -> FragmentOutputs {
    FragmentOutputs {
        textures,
        ..FragmentOutputs::default()
    }
}
