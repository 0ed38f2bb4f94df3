//! What occlusion maps take of the light of one light source, at the pixels of one
//! object.

use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, Interpolation, Vertex, VertexShader,
};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use crate::surface::power;
use crate::transform::ClipFromWorld;
use crate::vector::{V3, each2};

/// Attributes: position, normal, then two numbers for each light. Varyings: position in
/// 0..3, normal in 3..6, the numbers of one light in 6..8: its transport, and how much
/// of it the object leaves visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transported {
    /// The camera.
    pub clip_from_world: ClipFromWorld,
    /// Number of the light.
    pub light: u32,
}
uniforms!(Transported {
    clip_from_world,
    light
});

impl VertexShader for Transported {
    fn varyings(&self) -> &[Interpolation] {
        &[Interpolation::Perspective; 8]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        for i in 0..6 {
            v.set_varying(i, v.attribute(i));
        }
        let first = 6 + 2 * self.light as usize;
        v.set_varying(6, v.attribute(first));
        v.set_varying(7, v.attribute(first + 1));
        let [x, y, z] = [v.attribute(0), v.attribute(1), v.attribute(2)];
        v.set_position(self.clip_from_world.apply([x, y, z, F32::splat(l, 1.0)]));
    }
}

/// How the occlusions of several groups become one; each lies within the bounds of
/// Fréchet, which hold whatever the groups hide in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// As if they hid independently: visibilities are multiplied.
    Product,
    /// As if they hid the same: the least visibility.
    Min,
    /// As if they hid apart: occlusions are added, up to 1.
    Sum,
    /// The middle of the last two.
    Midpoint,
}
uniforms!(enum Combine { 0: Product, 1: Min, 2: Sum, 3: Midpoint });

/// Where an occlusion map lies in the world, and in the atlas of texture 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionMap {
    /// Rows whose products with (position, 1) are u w, v w and w: u and v are 0..1 over
    /// the map.
    pub place: [[f32; 4]; 3],
    /// Its product with (position, 1) is above 0 where occluders may be nearer to the
    /// light.
    pub below: [f32; 4],
    /// First column and row of the cell, texels along its side, and along the atlas's.
    pub cell: [f32; 4],
}
uniforms!(OcclusionMap { place, below, cell });

impl OcclusionMap {
    /// How much of the light is hidden at a position.
    #[inline(always)]
    fn occlusion<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, position: V3<L>) -> F32<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let w = affine(position, self.place[2]);
        let before = w.gt(zero) & affine(position, self.below).gt(zero);
        let uv = each2(
            #[inline(always)]
            |k| affine(position, self.place[k]) / before.select_f32(w, one),
        );
        let inside = before & within(l, uv[0]) & within(l, uv[1]);
        if !(inside & f.live()).any() {
            return zero;
        }
        let [column, row, side, all] = self.cell;
        let at = each2(
            #[inline(always)]
            |k| {
                let low = if k == 0 { column } else { row };
                let texel = inside.select_f32(uv[k], zero) * side;
                (texel.clamp(0.5, side - 0.5) + low) * (1.0 / all)
            },
        );
        let texel = f.sample_level(0, [at[0], at[1], zero], zero);
        inside.select_f32(texel[0], zero)
    }
}

#[inline(always)]
fn within<L: Lanes>(l: L, x: F32<L>) -> Mask<L> {
    x.ge(F32::splat(l, 0.0)) & x.le(F32::splat(l, 1.0))
}

#[inline(always)]
fn affine<L: Lanes>(p: V3<L>, [a, b, c, d]: [f32; 4]) -> F32<L> {
    let [x, y, z] = p.0;
    ((x * a + y * b) + z * c) + d
}

/// Occlusion by all `maps`.
#[inline(always)]
fn combined<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    maps: &[OcclusionMap],
    how: Combine,
) -> F32<L> {
    let position = V3(each3(
        #[inline(always)]
        |i| f.varying(i),
    ));
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    let (mut visible, mut most, mut sum) = (one, zero, zero);
    for map in maps {
        let hidden = map.occlusion(l, f, position);
        visible = visible * (one - hidden);
        most = most.max(hidden);
        sum = sum + hidden;
    }
    let sum = sum.min(one);
    match how {
        Combine::Product => one - visible,
        Combine::Min => most,
        Combine::Sum => sum,
        Combine::Midpoint => (most + sum) * 0.5,
    }
}

/// Highlights of a light, before the surface's specular colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Unit vector towards the light.
    pub towards: [f32; 3],
    /// The eye, relative to the origin of positions.
    pub eye: [f32; 3],
    /// Phong's exponent.
    pub shininess: f32,
}
uniforms!(Highlight {
    towards,
    eye,
    shininess
});

/// Obscured radiance of one light at albedo 1: `B T O` in attachment 0 (equation 8), and
/// `B f_r v_s O` in attachment 1 where there are highlights (equation 15). Texture 0
/// holds occlusion maps; varyings are those of [`Transported`].
#[derive(Clone, Debug, PartialEq)]
pub struct ObscuredRadiance {
    /// B, the light's radiosity.
    pub energy: [f32; 3],
    /// How occlusions of groups are combined.
    pub combine: Combine,
    /// Those of the light and the object.
    pub maps: Vec<OcclusionMap>,
    /// Of a glossy surface.
    pub highlight: Option<Highlight>,
}
uniforms!(ObscuredRadiance {
    energy,
    combine,
    maps,
    highlight
});

impl FragmentShader for ObscuredRadiance {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let zero = F32::splat(l, 0.0);
        let hidden = combined(l, f, &self.maps, self.combine);
        let lost = f.varying(6) * hidden;
        let [r, g, b] = each3(
            #[inline(always)]
            |c| lost * self.energy[c],
        );
        f.set_color(0, [r, g, b, zero]);
        if let Some(highlight) = &self.highlight {
            let lost = highlight.reflected(l, f) * f.varying(7) * hidden;
            let [r, g, b] = each3(
                #[inline(always)]
                |c| lost * self.energy[c],
            );
            f.set_color(1, [r, g, b, zero]);
        }
    }
}

impl Highlight {
    /// Phong's `max(r·v, 0)^n / π`, r being the light mirrored at the normal.
    #[inline(always)]
    fn reflected<L: Lanes>(&self, l: L, f: &Fragment<'_, L>) -> F32<L> {
        let position = V3(each3(
            #[inline(always)]
            |i| f.varying(i),
        ));
        let normal = V3(each3(
            #[inline(always)]
            |i| f.varying(3 + i),
        ));
        let [x, y, z] = self.eye;
        let to_eye = position.towards([x, y, z, 1.0]);
        let to_light = V3(each3(
            #[inline(always)]
            |i| F32::splat(l, self.towards[i]),
        ));
        let zero = F32::splat(l, 0.0);
        let tiny = F32::splat(l, f32::MIN_POSITIVE);
        let n_n = normal.dot(normal).max(tiny);
        let v_v = to_eye.dot(to_eye).max(tiny);
        let (n_l, n_v) = (normal.dot(to_light), normal.dot(to_eye));
        let mirrored = n_l * 2.0 * n_v / n_n - to_light.dot(to_eye);
        let cosine = (mirrored / v_v.sqrt()).clamp(0.0, 1.0);
        let reflected = power(cosine, self.shininess) * std::f32::consts::FRAC_1_PI;
        n_l.gt(zero).select_f32(reflected, zero)
    }
}

/// Visibility of one light: what the object leaves of it (varying 7 of [`Transported`])
/// times what other objects do. Texture 0 holds occlusion maps.
#[derive(Clone, Debug, PartialEq)]
pub struct DistantVisibility {
    /// How occlusions of groups are combined.
    pub combine: Combine,
    /// Those of the light and the object.
    pub maps: Vec<OcclusionMap>,
}
uniforms!(DistantVisibility { combine, maps });

impl FragmentShader for DistantVisibility {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let zero = F32::splat(l, 0.0);
        let hidden = combined(l, f, &self.maps, self.combine);
        let left = f.varying(7).clamp(0.0, 1.0) * (F32::splat(l, 1.0) - hidden);
        f.set_color(0, [left, zero, zero, zero]);
    }
}
