//! Smoothies: geometry round silhouettes, drawn from the light, that softens the edges of
//! a shadow map (Chan and Durand 2003; docs/papers.md).
//!
//! Distances are along a view's axis, beyond its base, world units, as in
//! [`crate::light_view`]: b of a smoothie and r of the surface behind it. Alpha is the
//! share of the light that is seen.

use gnomon_raster::math::dot2;
use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use crate::light_view::{DepthRange, LightMapping};
use crate::soft_volumes::texel_of;
use crate::transform::ClipFromWorld;
use crate::vector::each2;

/// Attributes x, y, z; the vertex's distance and that of what it is attached to; two
/// lengths in the picture, over a smoothie's width: from the edge or the corner.
/// Varyings: both distances, then both lengths, which are linear in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothieVertices(pub ClipFromWorld);
uniforms!(SmoothieVertices(clip_from_world));

impl VertexShader for SmoothieVertices {
    fn varyings(&self) -> &[Interpolation] {
        const P: Interpolation = Interpolation::Perspective;
        const L: Interpolation = Interpolation::Linear;
        &[P, P, L, L]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        for i in 0..4 {
            let attribute = v.attribute(3 + i);
            v.set_varying(i, attribute);
        }
        let [x, y, z] = [v.attribute(0), v.attribute(1), v.attribute(2)];
        v.set_position(self.0.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// Scaled linear depth of smoothies in red of attachment 0, limited to 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothieDepth {
    /// How depth is stored.
    pub range: DepthRange,
}
uniforms!(SmoothieDepth { range });

impl FragmentShader for SmoothieDepth {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let depth = self.range.scaled(f.varying(0)).clamp(0.0, 1.0);
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [depth, zero, zero, zero]);
    }
}

/// What alpha is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaFrom {
    /// The length from edge or corner, as it is: shadows come off their casters.
    Length,
    /// The same over 1 − b/r, so that a penumbra is as wide as what lies between
    /// blocker and receiver asks for.
    RemappedLength,
    /// Of the way from the distance of edge or corner to the receiver's, how much the
    /// fragment has gone: for cones and sheets (Wyman and Hansen 2003).
    Distances,
}
uniforms!(enum AlphaFrom { 0: Length, 1: RemappedLength, 2: Distances });

/// Alpha in red of attachment 0. Texture 0 holds scaled depths of all surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothieAlpha {
    /// How depths are stored.
    pub range: DepthRange,
    /// What distances are relative to.
    pub base: f32,
    /// What it is made of.
    pub from: AlphaFrom,
}
uniforms!(SmoothieAlpha { range, base, from });

impl FragmentShader for SmoothieAlpha {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            counts: &["alpha-clamped"],
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [depth, ..] = texel_of(l, f, 0, own);
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let length = [f.varying(2), f.varying(3)];
        let length = dot2(length, length).sqrt().min(one);
        let receiver = self.range.distance(depth);
        let background = depth.ge(one);
        let (way, whole) = match self.from {
            AlphaFrom::Length => (length, one),
            AlphaFrom::RemappedLength => {
                let ratio = (receiver - f.varying(0)) / (receiver + self.base);
                (length, background.select_f32(one, ratio))
            }
            AlphaFrom::Distances => (f.varying(0) - f.varying(1), receiver - f.varying(1)),
        };
        // Nothing is behind it, or less than what it is wide.
        let beyond = !way.lt(whole);
        f.count(0, beyond & way.gt(whole));
        let alpha = beyond.select_f32(one, way / whole).max(zero);
        f.set_color(0, [alpha, zero, zero, zero]);
    }
}

/// Shadows looked up in textures 1 to 3: depths of blockers, depths and alpha of
/// smoothies. Texture 0 holds positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothieShadow {
    /// The view.
    pub mapping: LightMapping,
    /// By how much a blocker or smoothie must be nearer than the receiver, world units.
    pub bias: f32,
    /// Whether the outcomes of the four nearest texels are weighted, instead of one
    /// taken.
    pub filtered: bool,
}
uniforms!(SmoothieShadow {
    mapping,
    bias,
    filtered
});

impl SmoothieShadow {
    /// The paper's three cases at one texel: behind a blocker, behind a smoothie, lit.
    #[inline(always)]
    fn at_texel<L: Lanes>(
        l: L,
        f: &mut Fragment<'_, L>,
        [column, row]: [I32<L>; 2],
        reference: F32<L>,
    ) -> F32<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let at = [column, row, I32::splat(l, 0)];
        let [blocker, .., inside] = texel_of(l, f, 1, at);
        let [smoothie, ..] = texel_of(l, f, 2, at);
        let [alpha, ..] = texel_of(l, f, 3, at);
        let inside = inside.gt(zero);
        let soft = smoothie.lt(reference).select_f32(alpha, one);
        let seen = blocker.lt(reference).select_f32(zero, soft);
        inside.select_f32(seen, one)
    }

    /// The four nearest texels, weighted by what a texel's square round the place shares
    /// with each.
    #[inline(always)]
    fn of_four<L: Lanes>(
        l: L,
        f: &mut Fragment<'_, L>,
        at: [F32<L>; 2],
        reference: F32<L>,
    ) -> F32<L> {
        let whole = each2(
            #[inline(always)]
            |k| (at[k] - 0.5).floor(),
        );
        let high = each2(
            #[inline(always)]
            |k| (at[k] - 0.5) - whole[k],
        );
        let one = F32::splat(l, 1.0);
        let mut hidden = F32::splat(l, 0.0);
        for number in 0..4 {
            let step = [number % 2, number / 2];
            let place = each2(
                #[inline(always)]
                |k| whole[k].to_i32() + I32::splat(l, step[k]),
            );
            let [x, y] = each2(
                #[inline(always)]
                |k| if step[k] == 1 { high[k] } else { one - high[k] },
            );
            hidden = hidden + (one - Self::at_texel(l, f, place, reference)) * (x * y);
        }
        (one - hidden).clamp(0.0, 1.0)
    }
}

/// Beyond these texels all coordinates are alike: outside.
const FAR_OUTSIDE: f32 = 1_048_576.0;

impl FragmentShader for SmoothieShadow {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 4,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, shadowable] = texel_of(l, f, 0, own);
        let zero = F32::splat(l, 0.0);
        let place = self.mapping.locate(l, [x, y, z]);
        let receives: Mask<L> = shadowable.gt(zero) & place.belongs;
        f.discard(!receives);
        if !(receives & f.live()).any() {
            return;
        }
        let size = self.mapping.size as f32;
        let at = each2(
            #[inline(always)]
            |k| {
                let texels = (place.uv[k] * size).clamp(-FAR_OUTSIDE, FAR_OUTSIDE);
                receives.select_f32(texels, zero)
            },
        );
        // What is cleared to is never before anything.
        let reference = self.mapping.range.scaled(place.distance - self.bias);
        let reference = reference.min(F32::splat(l, 1.0));
        let seen = match self.filtered {
            true => Self::of_four(l, f, at, reference),
            false => {
                let texel = each2(
                    #[inline(always)]
                    |k| at[k].floor().to_i32(),
                );
                Self::at_texel(l, f, texel, reference)
            }
        };
        f.set_color(0, [seen, zero, zero, zero]);
    }
}
