//! Patches looked up at points of a disc, as many for each receiver.

use std::sync::Arc;

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, I32, Lanes, uniforms};

use super::patches::PatchShape;
use super::{PATCHES, PatchSearch, PictureCone, ShadowCone};
use crate::light_view::{InLightView, LightMapping};
use crate::soft_volumes::texel_of;
use crate::vector::each2;

/// Beyond these texels all coordinates are alike: outside.
const FAR_OUTSIDE: f32 = 1_048_576.0;

/// Half the diagonal of a texel: a texel whose centre is in a disc is in the disc that
/// is wider by so much.
const HALF_DIAGONAL: f32 = core::f32::consts::FRAC_1_SQRT_2;

/// Points of the unit disc, each with 1/(N·p): N points of density p estimate a sum over
/// texels.
///
/// The disc goes round the receiver's place on the view's near plane, and holds all that
/// the cone cuts out of that plane; so every patch of the cone is in it.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscSamples {
    /// Place and weight.
    pub points: Arc<[[f32; 3]]>,
}
uniforms!(DiscSamples { points });

impl<'a, L: Lanes> PictureCone<'a, L> {
    #[inline(always)]
    pub(super) fn new(
        mapping: &'a LightMapping,
        place: &InLightView<L>,
        cone: &ShadowCone<L>,
    ) -> Self {
        let size = mapping.size as f32;
        let zero = F32::splat(place.distance.lanes(), 0.0);
        let wanted = cone.wanted;
        let at = each2(
            #[inline(always)]
            |k| {
                let texels = (place.uv[k] * size).clamp(-FAR_OUTSIDE, FAR_OUTSIDE);
                wanted.select_f32(texels, zero)
            },
        );
        let distance = wanted.select_f32(place.distance, zero);
        let along = ((distance + mapping.base) / cone.distance).clamp(0.0, 1.0);
        let aside = ((zero + 1.0 - along) * (along + 1.0)).sqrt();
        Self {
            mapping,
            at,
            distance,
            cosine: along * cone.cosine - aside * cone.sine,
        }
    }

    /// Radius of the disc, in texels; no more than reaches all of the picture.
    ///
    /// What a cone of half angle θ cuts out of the near plane at distance n, its axis at ψ
    /// from the view's, is nowhere farther from the axis, in tangents, than
    /// R (1/n − 1/d) / cos(ψ + θ), d being the receiver's distance.
    #[inline(always)]
    fn radius(&self, cone: &ShadowCone<L>) -> F32<L> {
        let zero = F32::splat(self.distance.lanes(), 0.0);
        let mapping = self.mapping;
        let size = mapping.size as f32;
        let near = mapping.range.near;
        let depth = self.distance + mapping.base;
        let reach = (self.distance - near).max(zero) / (depth * (near + mapping.base));
        let light_radius = cone.sine * cone.distance;
        let needed = light_radius * reach * (mapping.scale * size) / self.cosine;
        let [x, y] = each2(
            #[inline(always)]
            |k| self.at[k].abs().max((self.at[k] - size).abs()),
        );
        let all = (x * x + y * y).sqrt();
        let bounded = self.cosine.gt(zero);
        bounded.select_f32(needed, all).min(all) + HALF_DIAGONAL
    }
}

impl PatchSearch for DiscSamples {
    const MORE_TEXTURES: usize = 0;

    #[inline(always)]
    fn hidden<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        shape: &PatchShape,
        cone: &ShadowCone<L>,
        at: &PictureCone<'_, L>,
    ) -> F32<L> {
        let radius = at.radius(cone);
        let mut hidden = F32::splat(l, 0.0);
        for [x, y, weight] in self.points.iter().copied() {
            let [column, row] = each2(
                #[inline(always)]
                |k| (radius * [x, y][k] + at.at[k]).floor().to_i32(),
            );
            let patch = texel_of(l, f, PATCHES, [column, row, I32::splat(l, 0)]);
            hidden = hidden + cone.hidden(f, shape, patch, weight);
        }
        hidden * radius * radius
    }
}
