//! Which 8×8 blocks of a tile a triangle touches, and which pixels of them.

use super::Recorder;
use super::block::{self, Env};
use super::target::rect_mask;
use crate::geometry::Triangle;
use crate::simd::{I32, LANES, Lanes, each3, outlined, round_to_i32};

const IX: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7];
const IY: [i32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];

/// Largest edge value that is kept inside a tile: beyond it the sign cannot
/// change within 128 pixels.
const EDGE_LIMIT: f64 = (1u32 << 30) as f64;

/// Rasterises the triangles of one bin in order.
#[inline(always)]
pub(super) fn bin<L: Lanes, R: Recorder, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    recorder: &mut R,
    bin: &[u32],
) {
    outlined(
        l,
        #[inline(always)]
        || {
            for &i in bin {
                let t = &env.chunk.chunk.triangles[i as usize];
                triangle::<L, R, D24>(l, env, recorder, t);
            }
        },
    );
}

/// The triangle's edges as the tile sees them.
struct TileEdges {
    /// Edge values at the tile's origin pixel.
    e: [i32; 3],
    dx: [i32; 3],
    dy: [i32; 3],
}

impl TileEdges {
    #[inline(always)]
    fn new(t: &Triangle, x: u32, y: u32) -> Self {
        let (x, y) = (f64::from(x), f64::from(y));
        let e = each3(
            #[inline(always)]
            |k| {
                let v = t.c[k] + (f64::from(t.dx[k]) * y - f64::from(t.dy[k]) * x);
                let v = if v < EDGE_LIMIT { v } else { EDGE_LIMIT };
                round_to_i32(if v > -EDGE_LIMIT { v } else { -EDGE_LIMIT })
            },
        );
        Self { e, dx: t.dx, dy: t.dy }
    }

    /// Value of edge `k` at the origin of block (bx, by) of the tile.
    #[inline(always)]
    fn at_block(&self, k: usize, bx: i32, by: i32) -> i32 {
        self.e[k] + 8 * (self.dx[k] * by - self.dy[k] * bx)
    }

    /// Smallest and largest value of edge `k` over a square of `n` pixels,
    /// relative to its origin.
    #[inline(always)]
    fn span(&self, k: usize, n: i32) -> (i32, i32) {
        let (a, b) = (self.dx[k] * (n - 1), -self.dy[k] * (n - 1));
        (a.min(0) + b.min(0), a.max(0) + b.max(0))
    }

    /// Pixels of block (bx, by) inside all three edges.
    #[inline(always)]
    fn mask<L: Lanes>(&self, l: L, bx: i32, by: i32) -> u64 {
        let (ix, iy) = (I32::from_array(l, &IX), I32::from_array(l, &IY));
        let mut e: [I32<L>; 3] = each3(
            #[inline(always)]
            |k| {
                (iy * I32::splat(l, self.dx[k]) - ix * I32::splat(l, self.dy[k]))
                    + I32::splat(l, self.at_block(k, bx, by))
            },
        );
        let step: [I32<L>; 3] = each3(
            #[inline(always)]
            |k| I32::splat(l, 2 * self.dx[k]),
        );
        let zero = I32::splat(l, 0);
        let mut m = 0;
        for p in 0..4 {
            let inside = (e[0] | e[1] | e[2]).ge(zero);
            m |= u64::from(inside.bits()) << (16 * p);
            for k in 0..3 {
                e[k] = e[k] + step[k];
            }
        }
        m
    }
}

/// Blocks and pixels of a tile that a draw and a triangle's bounds allow.
struct Window {
    /// Pixels relative to the tile, inclusive.
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

impl Window {
    /// Pixels of block (bx, by) that lie in the window.
    #[inline(always)]
    fn mask(&self, bx: i32, by: i32) -> u64 {
        let (x, y) = (8 * bx, 8 * by);
        if self.x0 <= x && self.y0 <= y && self.x1 >= x + 7 && self.y1 >= y + 7 {
            return u64::MAX;
        }
        rect_mask(
            (self.x0 - x).max(0) as u32,
            (self.y0 - y).max(0) as u32,
            (self.x1 + 1 - x).min(8) as u32,
            (self.y1 + 1 - y).min(8) as u32,
        )
    }
}

#[inline(always)]
fn triangle<L: Lanes, R: Recorder, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    recorder: &mut R,
    t: &Triangle,
) {
    let (tx, ty, side) = (env.target.x as i32, env.target.y as i32, env.target.side as i32);
    let r = &env.config.rect;
    let b = t.bounds.map(i32::from);
    // The draw's rectangle may cut pixels off; the bounds only say where none are.
    let w = Window {
        x0: r[0].max(tx) - tx,
        y0: r[1].max(ty) - ty,
        x1: (r[2] - 1).min(tx + side - 1) - tx,
        y1: (r[3] - 1).min(ty + side - 1) - ty,
    };
    let (x0, y0) = ((b[0] - tx).max(w.x0), (b[1] - ty).max(w.y0));
    let (x1, y1) = ((b[2] - tx).min(w.x1), (b[3] - ty).min(w.y1));
    if x0 > x1 || y0 > y1 {
        return;
    }
    let e = TileEdges::new(t, env.target.x, env.target.y);
    let (bx0, by0, bx1, by1) = (x0 >> 3, y0 >> 3, x1 >> 3, y1 >> 3);
    if (bx1 - bx0) * (by1 - by0) <= 1 {
        // Few blocks: their masks are as cheap as asking whether they matter.
        for by in by0..=by1 {
            for bx in bx0..=bx1 {
                let m = e.mask(l, bx, by) & w.mask(bx, by);
                block::run::<L, R, D24>(l, env, recorder, t, [bx, by], m);
            }
        }
        return;
    }
    let whole = (e.e[0] + e.span(0, side).0) | (e.e[1] + e.span(1, side).0) | (e.e[2] + e.span(2, side).0) >= 0;
    if whole {
        for by in by0..=by1 {
            for bx in bx0..=bx1 {
                block::run::<L, R, D24>(l, env, recorder, t, [bx, by], w.mask(bx, by));
            }
        }
        return;
    }
    outlined(
        l,
        #[inline(always)]
        || scan_blocks::<L, R, D24>(l, env, recorder, t, &e, &w, [bx0, by0, bx1, by1]),
    );
}

/// Classifies 8×2 blocks at a time.
#[inline(always)]
fn scan_blocks<L: Lanes, R: Recorder, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    recorder: &mut R,
    t: &Triangle,
    e: &TileEdges,
    w: &Window,
    [bx0, by0, bx1, by1]: [i32; 4],
) {
    let (ix, iy) = (I32::from_array(l, &IX), I32::from_array(l, &IY));
    let zero = I32::splat(l, 0);
    for by in (by0..=by1).step_by(2) {
        for bx in (bx0..=bx1).step_by(8) {
            let mut reject = 0u16;
            let mut accept = u16::MAX;
            for k in 0..3 {
                let v = (iy * I32::splat(l, 8 * e.dx[k]) - ix * I32::splat(l, 8 * e.dy[k]))
                    + I32::splat(l, e.at_block(k, bx, by));
                let (lo, hi) = e.span(k, 8);
                reject |= (v + I32::splat(l, hi)).lt(zero).bits();
                accept &= (v + I32::splat(l, lo)).ge(zero).bits();
            }
            let columns = (1u32 << (bx1 - bx + 1).min(8)) - 1;
            let rows = if by < by1 { 0x101 } else { 1 };
            let mut left = !reject & (columns * rows) as u16;
            while left != 0 {
                let i = left.trailing_zeros() as i32;
                left &= left - 1;
                let (x, y) = (bx + (i & 7), by + (i >> 3));
                let covered = if accept >> i & 1 != 0 { u64::MAX } else { e.mask(l, x, y) };
                block::run::<L, R, D24>(l, env, recorder, t, [x, y], covered & w.mask(x, y));
            }
        }
    }
}
