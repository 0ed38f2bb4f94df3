//! Which 8×8 blocks of a tile a triangle touches, and which pixels of them.
//!
//! Large triangles are classified 16 blocks at a time, in groups of 4×4 blocks.
//! Groups that start at a multiple of 4 are neighbours in memory (Morton order),
//! so that their zmin/zmax are two vector loads. Blocks that are thrown away, or
//! whose depth test is decided and whose only effect is one stencil operation,
//! never leave the group's loop. Small triangles bring their pixels with them.

use super::block::{self, BlockStage, Env, General, Group, Place};
use super::depth::{Decision, Decisions, DepthBlock, GroupDepth};
use super::target::rect_mask;

use crate::geometry::Triangle;
use crate::simd::{I32, LANES, Lanes, each3, outlined, round_to_i32};
use crate::texture::PACKETS;
use crate::texture::layout::{morton, morton_lanes};

const IX: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7];
const IY: [i32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];

/// Block column and row of the blocks of a group, in Morton order.
const GROUP_X: [i32; LANES] = [0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3];
const GROUP_Y: [i32; LANES] = [0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3];

/// Largest edge value that is kept inside a tile: beyond it the sign cannot
/// change within 128 pixels.
const EDGE_LIMIT: f64 = (1u32 << 30) as f64;

/// Rasterises the triangles of one bin in order.
#[inline(always)]
pub(super) fn bin<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    bin: &[u32],
) {
    let w = Window::new(env);
    let side = (env.target.side >> 3) as i32;
    let (tx, ty) = (env.target.x as i32, env.target.y as i32);
    for &i in bin {
        let t = &env.chunk.chunk.triangles[i as usize];
        env.triangle = i;
        env.varyings.forget();
        if t.mask == 0 {
            outlined(
                l,
                #[inline(always)]
                || large::<L, S, D24>(l, env, &w, t),
            );
            continue;
        }
        let (x, y) = (i32::from(t.bounds[0]) - tx, i32::from(t.bounds[1]) - ty);
        let (bx, by) = (x >> 3, y >> 3);
        let quarters = split_window(t.mask, x as u32 & 7, y as u32 & 7);
        for (k, &m) in quarters.iter().enumerate() {
            let (bx, by) = (bx + (k as i32 & 1), by + (k as i32 >> 1));
            // A window may hang over the tile's edges.
            let m = if m != 0 && (bx as u32) < side as u32 && (by as u32) < side as u32 {
                m & w.mask(bx, by)
            } else {
                0
            };
            if m != 0 {
                one_block::<L, S, D24>(l, env, t, [bx, by], m);
            }
        }
    }
}

/// Cuts an 8×8 window that starts `x` columns and `y` rows inside a block into
/// that block's pixels, its right neighbour's, and those of the two below.
#[inline(always)]
fn split_window(mask: u64, x: u32, y: u32) -> [u64; 4] {
    const COLUMNS: u64 = 0x0101_0101_0101_0101;
    // Columns that stay in the left blocks.
    let stay = COLUMNS * (0xff >> x);
    let left = (mask & stay) << x;
    // Shifted in two steps: by 8 − x and 64 − 8y, which may be the whole width.
    let right = ((mask & !stay) >> 1) >> (7 - x);
    let below = |m: u64| (m >> 1) >> (63 - 8 * y);
    [left << (8 * y), right << (8 * y), below(left), below(right)]
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
        Self {
            e,
            dx: t.dx,
            dy: t.dy,
        }
    }

    /// Value of edge `k` at the origin of block (bx, by) of the tile.
    #[inline(always)]
    fn at_block(&self, k: usize, bx: i32, by: i32) -> i32 {
        self.e[k] + 8 * (self.dx[k] * by - self.dy[k] * bx)
    }

    /// Smallest and largest value of edge `k` over a square of `n` pixels,
    /// relative to its origin.
    #[inline(always)]
    fn span(&self, k: usize, n: i32) -> [i32; 2] {
        let (a, b) = (self.dx[k] * (n - 1), -self.dy[k] * (n - 1));
        [a.min(0) + b.min(0), a.max(0) + b.max(0)]
    }
}

/// The edges on lanes, found once a triangle and tile.
struct EdgeLanes<L: Lanes> {
    /// At the origins of the 16 blocks of the group at block (0, 0).
    origins: [I32<L>; 3],
    /// From a block's origin to its smallest and largest value.
    span: [[i32; 2]; 3],
    /// Over the first packet of a block, relative to its origin.
    packet: [I32<L>; 3],
    /// From packet to packet.
    step: [I32<L>; 3],
}

impl<L: Lanes> EdgeLanes<L> {
    #[inline(always)]
    fn new(l: L, e: &TileEdges) -> Self {
        let (gx, gy) = (
            I32::from_array(l, &GROUP_X) << 3,
            I32::from_array(l, &GROUP_Y) << 3,
        );
        let (ix, iy) = (I32::from_array(l, &IX), I32::from_array(l, &IY));
        let zero = I32::splat(l, 0);
        let mut lanes = Self {
            origins: [zero; 3],
            span: [[0; 2]; 3],
            packet: [zero; 3],
            step: [zero; 3],
        };
        for k in 0..3 {
            let (dx, dy) = (I32::splat(l, e.dx[k]), I32::splat(l, e.dy[k]));
            lanes.origins[k] = (gy * dx - gx * dy) + I32::splat(l, e.e[k]);
            lanes.span[k] = e.span(k, 8);
            lanes.packet[k] = iy * dx - ix * dy;
            lanes.step[k] = dx + dx;
        }
        lanes
    }

    /// Edge values at the origins of the blocks of the group at (gx, gy).
    #[inline(always)]
    fn origins(&self, l: L, e: &TileEdges, [gx, gy]: [i32; 2]) -> [I32<L>; 3] {
        each3(
            #[inline(always)]
            |k| self.origins[k] + I32::splat(l, 8 * (e.dx[k] * gy - e.dy[k] * gx)),
        )
    }

    /// Blocks with these origins that may hold covered pixels, and those that hold
    /// nothing else.
    #[inline(always)]
    fn classify(&self, l: L, origins: &[I32<L>; 3]) -> [u16; 2] {
        let zero = I32::splat(l, 0);
        let (mut low, mut high) = (zero, zero);
        for k in 0..3 {
            let [lo, hi] = self.span[k];
            low = low | (origins[k] + I32::splat(l, lo));
            high = high | (origins[k] + I32::splat(l, hi));
        }
        [high.ge(zero).bits(), low.ge(zero).bits()]
    }

    /// Pixels inside all three edges of the block with this origin.
    #[inline(always)]
    fn mask(&self, l: L, origin: [i32; 3]) -> u64 {
        let mut v: [I32<L>; 3] = each3(
            #[inline(always)]
            |k| self.packet[k] + I32::splat(l, origin[k]),
        );
        let zero = I32::splat(l, 0);
        let mut m = 0;
        for p in 0..PACKETS {
            let inside = (v[0] | v[1] | v[2]).ge(zero);
            m |= u64::from(inside.bits()) << (16 * p);
            for k in 0..3 {
                v[k] = v[k] + self.step[k];
            }
        }
        m
    }
}

/// Pixels that a draw may touch in a tile, relative to it, inclusive.
struct Window {
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

impl Window {
    #[inline(always)]
    fn new(env: &Env<'_, '_>) -> Self {
        let (tx, ty) = (env.target.x as i32, env.target.y as i32);
        let last = env.target.side as i32 - 1;
        let r = &env.config.rect;
        Self {
            x0: (r[0] - tx).max(0),
            y0: (r[1] - ty).max(0),
            x1: (r[2] - 1 - tx).min(last),
            y1: (r[3] - 1 - ty).min(last),
        }
    }

    /// Pixels of block (bx, by) that lie in the window.
    #[inline(always)]
    fn mask(&self, bx: i32, by: i32) -> u64 {
        let (x, y) = (8 * bx, 8 * by);
        if self.x0 <= x && self.y0 <= y && self.x1 >= x + 7 && self.y1 >= y + 7 {
            return u64::MAX;
        }
        rect_mask(
            (self.x0 - x).clamp(0, 8) as u32,
            (self.y0 - y).clamp(0, 8) as u32,
            (self.x1 + 1 - x).clamp(0, 8) as u32,
            (self.y1 + 1 - y).clamp(0, 8) as u32,
        )
    }
}

/// A triangle that does not fit in a window.
#[inline(always)]
fn large<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    w: &Window,
    t: &Triangle,
) {
    let (tx, ty) = (env.target.x as i32, env.target.y as i32);
    let [b0, b1, b2, b3] = [
        i32::from(t.bounds[0]),
        i32::from(t.bounds[1]),
        i32::from(t.bounds[2]),
        i32::from(t.bounds[3]),
    ];
    let (x0, y0) = ((b0 - tx).max(w.x0), (b1 - ty).max(w.y0));
    let (x1, y1) = ((b2 - tx).min(w.x1), (b3 - ty).min(w.y1));
    if x0 > x1 || y0 > y1 {
        return;
    }
    let e = TileEdges::new(t, env.target.x, env.target.y);
    let lanes = EdgeLanes::new(l, &e);
    let [bx0, by0, bx1, by1] = [x0 >> 3, y0 >> 3, x1 >> 3, y1 >> 3];
    if t.is_steep() {
        // Groups know fixed-point depth only.
        for by in by0..=by1 {
            for bx in bx0..=bx1 {
                let origin = each3(
                    #[inline(always)]
                    |k| e.at_block(k, bx, by),
                );
                let m = lanes.mask(l, origin) & w.mask(bx, by);
                if m != 0 {
                    outlined(
                        l,
                        #[inline(always)]
                        || one_block::<L, General, D24>(l, env, t, [bx, by], m),
                    );
                }
            }
        }
        return;
    }
    // A triangle that fits in 4×4 blocks is one group, wherever they start.
    let straddles = (bx0 ^ bx1) | (by0 ^ by1) > 3;
    let aligned = !(straddles && bx1 - bx0 < 4 && by1 - by0 < 4);
    let start = if aligned { !3 } else { !0 };
    let mut gy = by0 & start;
    while gy <= by1 {
        let mut gx = bx0 & start;
        while gx <= bx1 {
            let blocks = [bx0, by0, bx1, by1];
            group::<L, S, D24>(l, env, t, (&e, &lanes), w, blocks, [gx, gy], aligned);
            gx += 4;
        }
        gy += 4;
    }
}

#[inline(always)]
fn place(env: &Env<'_, '_>, bx: i32, by: i32) -> Place {
    Place {
        index: morton(bx as u32, by as u32),
        x: env.target.x + 8 * bx as u32,
        y: env.target.y + 8 * by as u32,
    }
}

#[inline(always)]
fn one_block<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    [bx, by]: [i32; 2],
    mask: u64,
) {
    let p = place(env, bx, by);
    let plane = if env.config.needs_depth {
        DepthBlock::<D24>::new(t, p.x, p.y, env.config.depth_range)
    } else {
        DepthBlock::UNUSED
    };
    S::run::<L, D24>(l, env, t, p, &plane, None, mask);
}

/// The covered pixels of the blocks of one group.
struct GroupMasks<'a, L: Lanes> {
    lanes: &'a EdgeLanes<L>,
    window: &'a Window,
    at: [i32; 2],
    /// Edge values at the blocks' origins.
    origins: [[i32; LANES]; 3],
    /// Blocks that lie in the window.
    unclipped: u16,
}

impl<L: Lanes> GroupMasks<'_, L> {
    #[inline(always)]
    fn of(&self, l: L, i: usize) -> u64 {
        let inside = self.lanes.mask(
            l,
            [self.origins[0][i], self.origins[1][i], self.origins[2][i]],
        );
        if self.unclipped >> i & 1 != 0 {
            inside
        } else {
            let [gx, gy] = self.at;
            inside & self.window.mask(gx + GROUP_X[i], gy + GROUP_Y[i])
        }
    }
}

/// Blocks, or pixels, whose column and row lie in x0, y0, x1, y1, inclusive.
#[inline(always)]
fn between<L: Lanes>([x, y]: [I32<L>; 2], [x0, y0, x1, y1]: [i32; 4]) -> u16 {
    let l = x.l;
    let inside = x.ge(I32::splat(l, x0))
        & x.le(I32::splat(l, x1))
        & y.ge(I32::splat(l, y0))
        & y.le(I32::splat(l, y1));
    inside.bits()
}

/// Classifies and runs the 4×4 blocks at (gx, gy), which are neighbours in memory
/// where they are `aligned` to multiples of 4.
///
/// ```text
/// alive = blocks between the bounds that no edge has wholly outside
/// full = those of them that all edges and the window have wholly inside
/// decided = what zmin/zmax say of alive
/// left = alive without those that run_group has dealt with     no depth looked at
/// for each block of left: run its covered pixels
/// ```
#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the state of one triangle in one tile"
)]
fn group<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    (e, lanes): (&TileEdges, &EdgeLanes<L>),
    w: &Window,
    bounds: [i32; 4],
    at: [i32; 2],
    aligned: bool,
) {
    let bx = I32::from_array(l, &GROUP_X) + I32::splat(l, at[0]);
    let by = I32::from_array(l, &GROUP_Y) + I32::splat(l, at[1]);
    let origins = lanes.origins(l, e, at);
    let [touched, filled] = lanes.classify(l, &origins);
    let alive = between([bx, by], bounds) & touched;
    if alive == 0 {
        return;
    }
    let unclipped = between([bx << 3, by << 3], [w.x0, w.y0, w.x1 - 7, w.y1 - 7]);
    let slots = morton_lanes(bx, by).to_array();
    let depth = env.config.needs_depth.then(
        #[inline(always)]
        || GroupDepth::<L, D24>::new(l, t, env.target, at, env.config.depth_range),
    );
    let mut decided = Decisions::default();
    if env.config.hiz
        && let Some(d) = &depth
    {
        decided = block::ask_group(l, env, &slots, aligned, alive, d);
    }
    let group = Group {
        slots: &slots,
        alive,
        full: alive & filled & unclipped,
        decided,
    };
    let masks = GroupMasks {
        lanes,
        window: w,
        at,
        origins: each3(
            #[inline(always)]
            |k| origins[k].to_array(),
        ),
        unclipped,
    };
    let mut left = alive;
    if S::DECIDED_GROUPS && !t.is_special() {
        left &= !block::run_group(
            l,
            env,
            env.config.face(t),
            &group,
            #[inline(always)]
            |i| masks.of(l, i),
        );
        if left == 0 {
            return;
        }
    }
    let bases = depth.map(
        #[inline(always)]
        |d| d.bases(),
    );
    each_left::<L, S, D24>(l, env, t, &group, &masks, bases.as_ref(), left);
}

/// Runs the blocks of `left` one by one; `bases` are their depths' at the origin, where
/// depth is needed.
#[inline(always)]
fn each_left<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut Env<'_, '_>,
    t: &Triangle,
    group: &Group<'_>,
    masks: &GroupMasks<'_, L>,
    bases: Option<&[i32; LANES]>,
    mut left: u16,
) {
    let [gx, gy] = masks.at;
    while left != 0 {
        let i = left.trailing_zeros() as usize;
        left &= left - 1;
        let m = if group.full >> i & 1 != 0 {
            u64::MAX
        } else {
            outlined(
                l,
                #[inline(always)]
                || masks.of(l, i),
            )
        };
        if m == 0 {
            continue;
        }
        let plane = match bases {
            Some(b) => DepthBlock::<D24>::with_base(t, b[i], env.config.depth_range),
            None => DepthBlock::UNUSED,
        };
        let decision: Option<Decision> = env.config.hiz.then(
            #[inline(always)]
            || group.decided.of(i),
        );
        let place = Place {
            index: group.slots[i] as usize,
            x: env.target.x + 8 * (gx + GROUP_X[i]) as u32,
            y: env.target.y + 8 * (gy + GROUP_Y[i]) as u32,
        };
        S::run::<L, D24>(l, env, t, place, &plane, decision, m);
    }
}
