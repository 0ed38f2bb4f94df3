//! Calling the fragment shader: varying planes of a block, and its results.

use super::block::{Env, Place};
use super::depth::DepthBlock;
use crate::MAX_VARYINGS;
use crate::format;
use crate::geometry::Triangle;
use crate::shader::{PACKETS, ShadeBlock, VaryingPlanes};
use crate::simd::{F32, I32, LANES, Lanes};
use crate::texture::Block;

const IX: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7];
const IY: [i32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];

/// Screen-space frame of a triangle, from which any varying's plane follows
/// (rules §3.6).
struct Frame {
    x0: f64,
    y0: f64,
    ax: f64,
    ay: f64,
    bx: f64,
    by: f64,
    det: f64,
}

impl Frame {
    #[inline(always)]
    fn new(env: &Env<'_, '_>, t: &Triangle) -> Self {
        let [p, q, r] = t.v.map(|v| {
            let s = env.chunk.chunk.screen(env.chunk.shaded, v);
            (f64::from(s.x) * (1.0 / 256.0), f64::from(s.y) * (1.0 / 256.0))
        });
        let (ax, ay, bx, by) = (q.0 - p.0, q.1 - p.1, r.0 - p.0, r.1 - p.1);
        Self { x0: p.0, y0: p.1, ax, ay, bx, by, det: ax * by - bx * ay }
    }

    /// Value at the origin pixel of the block at (x, y), and gradients.
    #[inline(always)]
    fn plane(&self, q: [f32; 3], x: u32, y: u32) -> [f32; 3] {
        let q = q.map(f64::from);
        let (e1, e2) = (q[1] - q[0], q[2] - q[0]);
        let gx = (e1 * self.by - e2 * self.ay) / self.det;
        let gy = (e2 * self.ax - e1 * self.bx) / self.det;
        let base = q[0] + (gx * ((f64::from(x) + 0.5) - self.x0) + gy * ((f64::from(y) + 0.5) - self.y0));
        [base as f32, gx as f32, gy as f32]
    }
}

/// Planes of all varyings over one block.
#[inline(always)]
fn varying_planes(env: &Env<'_, '_>, t: &Triangle, place: Place) -> VaryingPlanes {
    let config = env.config;
    let n = config.varyings;
    let mut p = VaryingPlanes {
        base: [0.0; MAX_VARYINGS + 1],
        gx: [0.0; MAX_VARYINGS + 1],
        gy: [0.0; MAX_VARYINGS + 1],
        perspective: config.perspective,
    };
    if n == 0 {
        return p;
    }
    let frame = Frame::new(env, t);
    let inv_w = t.v.map(|v| env.chunk.chunk.screen(env.chunk.shaded, v).inv_w);
    for i in 0..n {
        let a = t.v.map(|v| env.chunk.chunk.varying(env.chunk.shaded, v, i, n));
        let [base, gx, gy] = if config.flat >> i & 1 != 0 {
            [flat_value(env, t, i, n), 0.0, 0.0]
        } else if config.perspective >> i & 1 != 0 {
            frame.plane(core::array::from_fn(|k| a[k] * inv_w[k]), place.x, place.y)
        } else {
            frame.plane(a, place.x, place.y)
        };
        (p.base[i], p.gx[i], p.gy[i]) = (base, gx, gy);
    }
    if config.perspective != 0 {
        let [base, gx, gy] = frame.plane(inv_w, place.x, place.y);
        (p.base[MAX_VARYINGS], p.gx[MAX_VARYINGS], p.gy[MAX_VARYINGS]) = (base, gx, gy);
    }
    p
}

/// A flat varying: that of the primitive's first vertex, which clipping may have
/// cut away; the clipper keeps it in every vertex it makes.
#[inline(always)]
fn flat_value(env: &Env<'_, '_>, t: &Triangle, i: usize, n: usize) -> f32 {
    env.chunk.chunk.varying(env.chunk.shaded, t.v[0], i, n)
}

/// Shades the fragments of `live`; gives those that were discarded.
#[inline(always)]
pub(super) fn run<const D24: bool>(
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    live: u64,
) -> u64 {
    let Some(shader) = env.config.shader else { return 0 };
    let planes = varying_planes(env, t, place);
    let mut block = ShadeBlock {
        x: place.x,
        y: place.y,
        live,
        planes: &planes,
        depth: plane.for_shader(),
        front_facing: t.front,
        primitive: t.primitive,
        textures: &env.config.textures,
        out: env.outputs,
        events: &mut env.counters.shader,
    };
    shader.shade_block(env.level, &mut block);
    if !env.config.discards {
        return 0;
    }
    (0..PACKETS).filter(|k| (live >> (16 * k)) as u16 != 0).fold(0, |m, k| {
        m | u64::from(env.outputs[k].discarded) << (16 * k)
    }) & live
}

/// Encodes the depths that the shader wrote for the fragments of `live`.
#[inline(always)]
pub(super) fn shader_depths<const D24: bool>(env: &mut Env<'_, '_>, live: u64) -> Box<Block<u32>> {
    let mut block = Box::new(Block([0u32; 64]));
    let [lo, hi] = env.config.depth_range;
    for i in (0..64).filter(|i| live >> i & 1 != 0) {
        let v = env.outputs[i / LANES].depth[i % LANES];
        let events = &mut env.counters.events;
        events.nan_canonicalised += u64::from(v.is_nan());
        events.depth_clamped += u64::from(!v.is_nan() && !(0.0..=1.0).contains(&v));
        let encoded = if D24 {
            format::d24_from_f32(v) as i32
        } else {
            let z = if v > 0.0 { v } else { 0.0 };
            (if z < 1.0 { z } else { 1.0 }).to_bits() as i32
        };
        block.0[i] = encoded.max(lo).min(hi) as u32;
    }
    block
}

/// Pixels of the block on the right side of every user clip plane (rules §4).
#[inline(always)]
pub(super) fn inside_clip_planes<L: Lanes>(l: L, env: &Env<'_, '_>, t: &Triangle, place: Place) -> u64 {
    let frame = Frame::new(env, t);
    let chunk = env.chunk.chunk;
    let mut m = u64::MAX;
    for plane in &env.config.clip_planes {
        let q = t.v.map(|v| {
            let [x, y, z, w] = chunk.clip_position(env.chunk.shaded, v);
            let d = ((plane[0] * x + plane[1] * y) + plane[2] * z) + plane[3] * w;
            d * chunk.screen(env.chunk.shaded, v).inv_w
        });
        let [base, gx, gy] = frame.plane(q, place.x, place.y);
        for k in 0..PACKETS {
            let ix = I32::from_array(l, &IX).to_f32();
            let iy = (I32::from_array(l, &IY) + I32::splat(l, 2 * k as i32)).to_f32();
            let v = (F32::splat(l, base) + ix * gx) + iy * gy;
            let out = !v.ge(F32::splat(l, 0.0)).bits();
            m &= !(u64::from(out) << (16 * k));
        }
    }
    m
}
