//! Calling the fragment shader: varying planes of a block, and its results.

use super::block::{Env, Place};
use super::config::DrawConfig;
use super::depth::DepthBlock;
use crate::MAX_VARYINGS;
use crate::format;
use crate::geometry::Triangle;
use crate::shader::{ShadeBlock, VaryingPlanes};
use crate::simd::{F32, F64, I32, LANES, Lanes, each3, outlined};
use crate::texture::Block;
use crate::texture::PACKETS;

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
        let (chunk, shaded) = (env.chunk.chunk, env.chunk.shaded);
        let [p, q, r] = each3(
            #[inline(always)]
            |k| {
                let s = chunk.screen(shaded, t.v[k]);
                (
                    f64::from(s.x) * (1.0 / 256.0),
                    f64::from(s.y) * (1.0 / 256.0),
                )
            },
        );
        let (ax, ay, bx, by) = (q.0 - p.0, q.1 - p.1, r.0 - p.0, r.1 - p.1);
        Self {
            x0: p.0,
            y0: p.1,
            ax,
            ay,
            bx,
            by,
            det: ax * by - bx * ay,
        }
    }

    /// Value at the origin pixel of the block at (x, y), and gradients.
    #[inline(always)]
    fn plane(&self, q: [f32; 3], x: u32, y: u32) -> [f32; 3] {
        let q = [f64::from(q[0]), f64::from(q[1]), f64::from(q[2])];
        let (e1, e2) = (q[1] - q[0], q[2] - q[0]);
        let gx = (e1 * self.by - e2 * self.ay) / self.det;
        let gy = (e2 * self.ax - e1 * self.bx) / self.det;
        let base =
            q[0] + (gx * ((f64::from(x) + 0.5) - self.x0) + gy * ((f64::from(y) + 0.5) - self.y0));
        [base as f32, gx as f32, gy as f32]
    }
}

/// Planes of a triangle's varyings: found once a triangle and tile, moved to each block.
#[derive(Default)]
pub(super) struct VaryingCache {
    ready: bool,
    /// Vertex 0's value and gradients, in doubles, of each varying.
    q: [f64; LANES],
    gx: [f64; LANES],
    gy: [f64; LANES],
    /// The same of 1/w.
    inv_w: [f64; 3],
    /// Vertex 0's position in pixels.
    x0: f64,
    y0: f64,
    planes: VaryingPlanes,
}

const _: () = assert!(MAX_VARYINGS <= LANES);

impl VaryingCache {
    /// Another triangle comes.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        self.ready = false;
    }

    /// The planes over the block that was shaded last.
    pub(super) fn planes(&self) -> &VaryingPlanes {
        &self.planes
    }
}

/// Finds the planes of triangle `t` (rules §3.6, §6).
#[inline(always)]
fn prepare_varyings<L: Lanes>(l: L, env: &mut Env<'_, '_>, t: &Triangle) {
    let config = env.config;
    let n = config.varyings;
    let frame = Frame::new(env, t);
    let v = &mut *env.varyings;
    v.ready = true;
    (v.x0, v.y0) = (frame.x0, frame.y0);
    v.planes.perspective = config.perspective;
    let (chunk, shaded) = (env.chunk.chunk, env.chunk.shaded);
    let inv_w: [f32; 3] = each3(
        #[inline(always)]
        |k| chunk.screen(shaded, t.v[k]).inv_w,
    );
    let mut q = [[0.0f32; LANES]; 3];
    for i in 0..n {
        let flat = config.flat >> i & 1 != 0;
        for k in 0..3 {
            let a = chunk.varying(shaded, t.v[if flat { 0 } else { k }], i, n);
            q[k][i] = if config.perspective >> i & 1 != 0 {
                a * inv_w[k]
            } else {
                a
            };
        }
    }
    let [q0, q1, q2] = each3(
        #[inline(always)]
        |k| F64::from_f32(F32::from_array(l, &q[k])),
    );
    let (e1, e2) = (q1 - q0, q2 - q0);
    let gx = (e1 * frame.by - e2 * frame.ay) / F64::splat(l, frame.det);
    let gy = (e2 * frame.ax - e1 * frame.bx) / F64::splat(l, frame.det);
    (v.q, v.gx, v.gy) = (q0.to_array(), gx.to_array(), gy.to_array());
    v.planes.gx[..LANES].copy_from_slice(&gx.to_f32().to_array());
    v.planes.gy[..LANES].copy_from_slice(&gy.to_f32().to_array());
    // A flat varying is its value, whatever it is: no arithmetic on infinities.
    for i in (0..n).filter(|i| config.flat >> i & 1 != 0) {
        // −0 added to anything is that thing, −0 included.
        (v.gx[i], v.gy[i], v.planes.gx[i], v.planes.gy[i]) = (0.0, 0.0, -0.0, -0.0);
    }
    if config.perspective != 0 {
        let [q0, q1, q2] = [
            f64::from(inv_w[0]),
            f64::from(inv_w[1]),
            f64::from(inv_w[2]),
        ];
        let (e1, e2) = (q1 - q0, q2 - q0);
        let gx = (e1 * frame.by - e2 * frame.ay) / frame.det;
        let gy = (e2 * frame.ax - e1 * frame.bx) / frame.det;
        v.inv_w = [q0, gx, gy];
        (v.planes.gx[MAX_VARYINGS], v.planes.gy[MAX_VARYINGS]) = (gx as f32, gy as f32);
    }
}

/// Moves the planes to the block at `place`.
#[inline(always)]
fn move_varyings<L: Lanes>(l: L, env: &mut Env<'_, '_>, place: Place) {
    let v = &mut *env.varyings;
    let (dx, dy) = (
        (f64::from(place.x) + 0.5) - v.x0,
        (f64::from(place.y) + 0.5) - v.y0,
    );
    let q = F64::from_array(l, &v.q);
    let base = q + (F64::from_array(l, &v.gx) * dx + F64::from_array(l, &v.gy) * dy);
    base.to_f32().store(
        (&mut v.planes.base[..LANES])
            .try_into()
            .expect("16 varyings"),
    );
    let mut flat = env.config.flat;
    while flat != 0 {
        let i = flat.trailing_zeros() as usize;
        flat &= flat - 1;
        v.planes.base[i] = v.q[i] as f32;
    }
    let [q, gx, gy] = v.inv_w;
    v.planes.base[MAX_VARYINGS] = (q + (gx * dx + gy * dy)) as f32;
}

/// Shades the fragments of `live`; gives those that were discarded.
#[inline(always)]
pub(super) fn run<L: Lanes, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    place: Place,
    plane: &DepthBlock<D24>,
    live: u64,
) -> u64 {
    let Some(shader) = env.config.shader else {
        return 0;
    };
    if env.config.constant.is_some() {
        return 0;
    }
    if env.config.varyings != 0 {
        if !env.varyings.ready {
            outlined(
                l,
                #[inline(always)]
                || prepare_varyings(l, env, t),
            );
        }
        move_varyings(l, env, place);
    } else {
        env.varyings.planes.perspective = 0;
    }
    let mut block = ShadeBlock {
        x: place.x,
        y: place.y,
        live,
        planes: &env.varyings.planes,
        varyings: env.config.varyings,
        depth: plane.for_shader(),
        front_facing: t.is_front(),
        primitive: t.primitive,
        textures: &env.config.textures,
        out: env.outputs,
        attachments: env.config.targets.len(),
        writes_depth: env.config.writes_shader_depth,
        events: &mut env.counters.shader,
        log: match &mut env.listening {
            Some(l) if l.wants.texels => Some(&mut l.gathered.texels),
            _ => None,
        },
    };
    shader.shade_block(env.level, &mut block);
    if !env.config.discards {
        return 0;
    }
    let mut discarded = 0;
    for k in 0..PACKETS {
        if (live >> (16 * k)) as u16 != 0 {
            discarded |= u64::from(env.outputs[k].discarded) << (16 * k);
        }
    }
    discarded & live
}

/// Encodes the depths that the shader wrote for the fragments of `live`.
#[inline(always)]
pub(super) fn shader_depths<const D24: bool>(env: &mut Env<'_, '_>, live: u64) -> Box<Block<u32>> {
    let mut block = Box::new(Block([0u32; 64]));
    for i in (0..64).filter(|i| live >> i & 1 != 0) {
        let v = env.outputs[i / LANES].depth[i % LANES];
        let events = &mut env.counters.events;
        events.nan_canonicalised += u64::from(v.is_nan());
        events.depth_clamped += u64::from(!v.is_nan() && !(0.0..=1.0).contains(&v));
        block.0[i] = encode_depth::<D24>(env.config, v);
    }
    block
}

/// A depth that a shader wrote as it is stored.
#[inline(always)]
pub(super) fn encode_depth<const D24: bool>(config: &DrawConfig<'_>, v: f32) -> u32 {
    let [lo, hi] = config.depth_range;
    let encoded = if D24 {
        format::d24_from_f32(v) as i32
    } else {
        let z = if v > 0.0 { v } else { 0.0 };
        (if z < 1.0 { z } else { 1.0 }).to_bits() as i32
    };
    encoded.max(lo).min(hi) as u32
}

/// Pixels of the block on the right side of every user clip plane (rules §4).
#[inline(always)]
pub(super) fn inside_clip_planes<L: Lanes>(
    l: L,
    env: &Env<'_, '_>,
    t: &Triangle,
    place: Place,
) -> u64 {
    if env.config.clip_planes.is_empty() {
        return u64::MAX;
    }
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
