//! Shadows on planes: how many points of a light are hidden, in a texture over the plane
//! (docs/papers.md, baselines).

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use crate::soft_volumes::texel_of;
use crate::vector::{V3, each2};

/// Visibility of receivers on a plane, to red of attachment 0; others are discarded.
///
/// Texture 0 holds positions (w is 0 where no shadow falls), texture 1 counts of points
/// that are hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarShadow {
    /// A point of the plane, relative to the origin of positions.
    pub origin: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Distances from the plane up to this are on it.
    pub tolerance: f32,
    /// Vectors whose products with a position, from the origin, are texels to the right
    /// and downwards.
    pub axes: [[f32; 3]; 2],
    /// Texels along a side.
    pub size: u32,
    /// Points of the light.
    pub points: u32,
}
uniforms!(PlanarShadow {
    origin,
    normal,
    tolerance,
    axes,
    size,
    points
});

impl PlanarShadow {
    /// The texel of a position, and whether there is one.
    #[inline(always)]
    fn texel<L: Lanes>(&self, l: L, from: [F32<L>; 3]) -> ([I32<L>; 2], Mask<L>) {
        let place = each2(
            #[inline(always)]
            |k| {
                V3(from).dot(V3(each3(
                    #[inline(always)]
                    |i| F32::splat(l, self.axes[k][i]),
                )))
            },
        );
        let size = self.size as f32;
        let (zero, end) = (F32::splat(l, 0.0), F32::splat(l, size));
        let inside = place[0].ge(zero) & place[0].lt(end) & place[1].ge(zero) & place[1].lt(end);
        let texel = each2(
            #[inline(always)]
            |k| inside.select_f32(place[k], zero).floor().to_i32(),
        );
        (texel, inside)
    }
}

impl FragmentShader for PlanarShadow {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 2,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let none = I32::splat(l, 0);
        let own = [f.column(), f.row(), none];
        let [x, y, z, shadowable] = texel_of(l, f, 0, own);
        let position = [x, y, z];
        let from = each3(
            #[inline(always)]
            |i| position[i] - self.origin[i],
        );
        let normal = each3(
            #[inline(always)]
            |i| F32::splat(l, self.normal[i]),
        );
        let off = V3(from).dot(V3(normal)).abs();
        let (texel, inside) = self.texel(l, from);
        let on = shadowable.gt(zero) & off.le(F32::splat(l, self.tolerance)) & inside;
        f.discard(!on);
        if !(on & f.live()).any() {
            return;
        }
        let [hidden, ..] = texel_of(l, f, 1, [texel[0], texel[1], none]);
        let share = hidden / F32::splat(l, self.points as f32);
        f.set_color(0, [one - share, zero, zero, zero]);
    }
}
