//! Shaders over lanes, each of the size of a real one.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader, Interpolation};
use gnomon_raster::shader::{Vertex, VertexShader};
use gnomon_raster::{F32, Lanes, math};

/// Corners in floats 0 to 3; four varyings made from them, of every kind.
pub struct Corners;

impl VertexShader for Corners {
    fn varyings(&self) -> &[Interpolation] {
        &[
            Interpolation::Perspective,
            Interpolation::Perspective,
            Interpolation::Linear,
            Interpolation::Flat,
        ]
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, v: &mut Vertex<'_, L>) {
        let p = [0, 1, 2, 3].map(|i| v.attribute(i));
        v.set_varying(0, p[0] * 0.5 + 0.5);
        v.set_varying(1, p[1] * 0.5 + 0.5);
        v.set_varying(2, p[2] * p[2]);
        v.set_varying(3, F32::splat(l, 0.25) + p[3]);
        v.set_position(p);
    }
}

/// Every function of the mathematics, a surface lit by them.
pub struct Lit;

impl FragmentShader for Lit {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (u, v) = (f.varying(0), f.varying(1));
        let [s, c] = math::sin_cos(u * 6.0);
        let n = math::normalize([s, c, math::exp(v)]);
        let light = math::normalize([u - 0.5, v - 0.25, F32::splat(l, 1.0)]);
        let d = math::saturate(math::dot3(n, light));
        let h = math::reflect(light, n);
        let gloss = math::pow(math::saturate(h[2]), F32::splat(l, 12.5));
        let angle = math::atan2(v, u) + math::acos(d) + math::ln(u + 1.5);
        let rim = math::smoothstep(F32::splat(l, 0.1), F32::splat(l, 0.9), f.varying(2));
        f.set_color(0, [d, gloss, math::mix(rim, angle, d), f.varying(3)]);
    }
}

/// Looks up slots 0 (with mip levels), 1 (a cube), 2 (a volume) and 3 (depth and stencil).
pub struct LookUps;

impl FragmentShader for LookUps {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 4,
            counts: &["look-ups"],
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (u, v, zero) = (f.varying(0), f.varying(1), F32::splat(l, 0.0));
        let a = f.sample(0, [u * 3.0, v * 3.0, zero]);
        let b = f.sample_level(1, [u - 0.5, v - 0.5, zero + 0.25], zero);
        let (dx, dy) = ([u * 0.1, zero, zero], [zero, v * 0.1, zero]);
        let c = f.sample_grad(2, [u, v, u], dx, dy);
        let at = [f.column(), f.row(), f.row()];
        let depth = f.fetch_texel(3, at, 0)[0];
        let stencil = f.fetch_stencil(3, at, 0).to_i32().to_f32();
        f.count(0, f.live());
        f.set_color(0, [a[0] + b[1], c[2] + depth, stencil * 0.1, a[3]]);
    }
}
