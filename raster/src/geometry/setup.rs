//! Triangle set-up, 16 at a time (rules §3.4–§3.6, §5).

use super::assemble::{Chunk, ChunkInput};
use super::{DepthEncoding, GeometryState};
use crate::simd::{F32, F64, I32, LANES, Lanes, Mask, SimdLevel, each3, with_lanes};
use crate::state::{CullMode, FrontFace};

/// A triangle on its way into set-up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) v: [u32; 3],
    pub(crate) primitive: u32,
    pub(crate) piece: u16,
    /// Part of a line or point: front-facing whatever its winding.
    pub(crate) widened: bool,
    /// A corner lies beyond the far plane.
    pub(crate) far: bool,
}

/// D24 depth planes carry this many fractional bits.
pub(crate) const D24_FRACTION: u32 = 5;
/// Depth 1 of D24 with its fraction.
pub(crate) const D24_SCALE: f64 = 16_777_215.0 * 32.0;
/// Limit of a D24 plane's value at a block's origin, and of its slope.
pub(crate) const D24_BASE_LIMIT: f64 = 1_677_721_583.0;
const D24_SLOPE_LIMIT: f64 = 33_554_432.0;

/// A triangle ready for rasterisation.
///
/// At pixel (i, j) edge k has the value `c[k] + dx[k]·j − dy[k]·i`; the pixel is
/// covered where all three are ≥ 0. The eight bits below the pixel grid and the
/// top-left rule are folded into `c`, exactly.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Triangle {
    pub(crate) c: [f64; 3],
    pub(crate) dx: [i32; 3],
    pub(crate) dy: [i32; 3],
    /// Covered pixels lie inside x0, y0, x1, y1, both ends inclusive.
    pub(crate) bounds: [i16; 4],
    /// Depth gradients, and the bias.
    pub(crate) zx: f64,
    pub(crate) zy: f64,
    pub(crate) bias: f64,
    /// Vertex 0: snapped position and depth.
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    /// Depth gradients as the block kernels use them: D24 integers or float bits.
    pub(crate) slope: [i32; 2],
    pub(crate) v: [u32; 3],
    pub(crate) primitive: u32,
    pub(crate) piece: u16,
    pub(crate) front: bool,
    /// Pixels beyond the far end must be cut off.
    pub(crate) far: bool,
    /// D24 slopes are beyond fixed point: depth is computed in doubles.
    pub(crate) steep: bool,
}

const _: () = assert!(core::mem::size_of::<Triangle>() == 128);

impl Triangle {
    /// Depth at the origin pixel of the block at pixel (x, y), in doubles, without bias.
    #[inline(always)]
    pub(crate) fn depth_base(&self, x: u32, y: u32) -> f64 {
        let dx = (f64::from(x) + 0.5) - f64::from(self.x) * (1.0 / 256.0);
        let dy = (f64::from(y) + 0.5) - f64::from(self.y) * (1.0 / 256.0);
        f64::from(self.z) + (self.zx * dx + self.zy * dy)
    }
}

/// Sets up `pieces` (at most 16) and appends what survives to the chunk.
pub(super) fn packet(
    level: SimdLevel,
    input: &ChunkInput<'_>,
    chunk: &mut Chunk,
    pieces: &[Piece],
) {
    with_lanes!(level, l => packet_lanes(l, input, chunk, pieces));
}

/// Coordinates of 16 triangles: `xyz[vertex][component]`.
struct Corners<L: Lanes> {
    x: [F32<L>; 3],
    y: [F32<L>; 3],
    z: [F32<L>; 3],
}

#[inline(always)]
fn gather<L: Lanes>(l: L, input: &ChunkInput<'_>, chunk: &Chunk, pieces: &[Piece]) -> Corners<L> {
    let mut a = [[[0.0f32; LANES]; 3]; 3];
    for (lane, p) in pieces.iter().enumerate() {
        for (k, &v) in p.v.iter().enumerate() {
            let s = chunk.screen(input.shaded, v);
            a[0][k][lane] = s.x;
            a[1][k][lane] = s.y;
            a[2][k][lane] = s.z;
        }
    }
    let [x, y, z] = each3(
        #[inline(always)]
        |c| {
            each3(
                #[inline(always)]
                |k| F32::from_array(l, &a[c][k]),
            )
        },
    );
    Corners { x, y, z }
}

#[inline(always)]
fn packet_lanes<L: Lanes>(l: L, input: &ChunkInput<'_>, chunk: &mut Chunk, pieces: &[Piece]) {
    let state = input.state;
    let q = gather(l, input, chunk, pieces);
    let present = Mask::from_bits(l, ((1u32 << pieces.len()) - 1) as u16);
    let widened = pieces
        .iter()
        .enumerate()
        .fold(0u16, |m, (i, p)| m | u16::from(p.widened) << i);

    let area = doubled_area(&q);
    let zero = F64::splat(l, 0.0);
    let negative = area.lt(zero);
    let positive = zero.lt(area);
    let degenerate = present & !(negative | positive);
    let ccw_front = state.front_face == FrontFace::Ccw;
    let front = Mask::from_bits(
        l,
        if ccw_front {
            negative.bits()
        } else {
            positive.bits()
        } | widened,
    );
    let culled = facing_to_cull(state, front.bits()) & !widened & (present & !degenerate).bits();
    let alive = present.bits() & !degenerate.bits() & !culled;
    let c = &mut chunk.counters;
    c.degenerate += u64::from(degenerate.bits().count_ones());
    c.face_culled += u64::from(culled.count_ones());
    c.rasterized += u64::from(alive.count_ones());
    if alive == 0 {
        return;
    }
    let edges = Edges::new(l, &q, negative);
    let depth = DepthPlanes::new(state, &q, chunk, alive);
    let bounds = pixel_bounds(&q);
    let alive = alive & !covers_nothing(l, &edges, &bounds);
    emit(
        chunk,
        pieces,
        alive,
        front.bits(),
        &edges,
        &depth,
        &bounds,
        &q,
        state.depth_clamp,
    );
}

fn facing_to_cull(state: &GeometryState, front: u16) -> u16 {
    match state.cull_mode {
        CullMode::None => 0,
        CullMode::Front => front,
        CullMode::Back => !front,
    }
}

/// `(X1−X0)(Y2−Y0) − (X2−X0)(Y1−Y0)`, exact.
#[inline(always)]
fn doubled_area<L: Lanes>(q: &Corners<L>) -> F64<L> {
    let (ax, ay) = (
        F64::from_f32(q.x[1] - q.x[0]),
        F64::from_f32(q.y[1] - q.y[0]),
    );
    let (bx, by) = (
        F64::from_f32(q.x[2] - q.x[0]),
        F64::from_f32(q.y[2] - q.y[0]),
    );
    ax * by - bx * ay
}

struct Edges {
    c: [[f64; LANES]; 3],
    dx: [[i32; LANES]; 3],
    dy: [[i32; LANES]; 3],
}

impl Edges {
    #[inline(always)]
    fn new<L: Lanes>(l: L, q: &Corners<L>, negative: Mask<L>) -> Self {
        let mut e = Self {
            c: [[0.0; LANES]; 3],
            dx: [[0; LANES]; 3],
            dy: [[0; LANES]; 3],
        };
        let zero = F32::splat(l, 0.0);
        for k in 0..3 {
            let (a, b) = (k, (k + 1) % 3);
            let (dx, dy) = (q.x[b] - q.x[a], q.y[b] - q.y[a]);
            let (dx, dy) = (negative.select_f32(-dx, dx), negative.select_f32(-dy, dy));
            let owns = dy.lt(zero) | (dy.eq(zero) & dx.gt(zero));
            let bias = F64::from_f32(owns.select_f32(zero, F32::splat(l, 1.0)));
            let half = F32::splat(l, 128.0);
            // E·256 at pixel (0, 0); products and sums of integers below 2⁵³ are exact.
            let at_origin = F64::from_f32(dx) * F64::from_f32(half - q.y[a])
                - F64::from_f32(dy) * F64::from_f32(half - q.x[a]);
            e.c[k] = ((at_origin - bias) * (1.0 / 256.0)).floor().to_array();
            e.dx[k] = dx.to_i32().to_array();
            e.dy[k] = dy.to_i32().to_array();
        }
        e
    }
}

/// Triangles whose bounds hold no pixel centre, or at most 2×2 of which none is
/// covered: nothing downstream could see them.
#[inline(always)]
fn covers_nothing<L: Lanes>(l: L, e: &Edges, bounds: &[[i32; LANES]; 4]) -> u16 {
    let b = [
        I32::from_array(l, &bounds[0]),
        I32::from_array(l, &bounds[1]),
        I32::from_array(l, &bounds[2]),
        I32::from_array(l, &bounds[3]),
    ];
    let one = I32::splat(l, 1);
    let empty = b[0].gt(b[2]).bits() | b[1].gt(b[3]).bits();
    let tiny = ((b[2] - b[0]).le(one) & (b[3] - b[1]).le(one)).bits();
    if tiny == 0 {
        return empty;
    }
    let (x, y) = (F64::from_f32(b[0].to_f32()), F64::from_f32(b[1].to_f32()));
    let mut outside = [I32::splat(l, 0); 4];
    for k in 0..3 {
        let (dx, dy) = (I32::from_array(l, &e.dx[k]), I32::from_array(l, &e.dy[k]));
        let at = F64::from_array(l, &e.c[k])
            + (F64::from_f32(dx.to_f32()) * y - F64::from_f32(dy.to_f32()) * x);
        let v = at.round_to_i32(EDGE_LIMIT);
        outside[0] = outside[0] | v;
        outside[1] = outside[1] | (v - dy);
        outside[2] = outside[2] | (v + dx);
        outside[3] = outside[3] | ((v + dx) - dy);
    }
    let none = outside[0] & outside[1] & outside[2] & outside[3];
    empty | (tiny & none.lt(I32::splat(l, 0)).bits())
}

/// Edge values are limited to this before they become 32-bit integers; their sign
/// is all that matters.
const EDGE_LIMIT: f64 = 1_073_741_824.0;

struct DepthPlanes {
    zx: [f64; LANES],
    zy: [f64; LANES],
    bias: [f64; LANES],
    slope: [[i32; LANES]; 2],
    steep: u16,
}

impl DepthPlanes {
    #[inline(always)]
    fn new<L: Lanes>(state: &GeometryState, q: &Corners<L>, chunk: &mut Chunk, alive: u16) -> Self {
        let (gx, gy) = gradients(q, &q.z);
        let mut steep = 0;
        let slope = match state.encoding {
            DepthEncoding::D24 => {
                let (sx, sy) = (gx * D24_SCALE, gy * D24_SCALE);
                steep = (beyond(sx) | beyond(sy)) & alive;
                chunk.counters.steep_depth_planes += u64::from(steep.count_ones());
                [
                    sx.round_to_i32(D24_SLOPE_LIMIT).to_array(),
                    sy.round_to_i32(D24_SLOPE_LIMIT).to_array(),
                ]
            }
            DepthEncoding::Float => [
                gx.to_f32().to_bits().to_i32().to_array(),
                gy.to_f32().to_bits().to_i32().to_array(),
            ],
        };
        let (zx, zy) = (gx.to_array(), gy.to_array());
        Self {
            zx,
            zy,
            bias: biases(state, &zx, &zy, q),
            slope,
            steep,
        }
    }
}

/// Lanes whose D24 slope rounds to more than the limit.
#[inline(always)]
fn beyond<L: Lanes>(s: F64<L>) -> u16 {
    // The limit is even: halves above it round down to it.
    let limit = F64::splat(s.lanes(), D24_SLOPE_LIMIT + 0.5);
    let below = F64::splat(s.lanes(), -(D24_SLOPE_LIMIT + 0.5));
    limit.lt(s).bits() | s.lt(below).bits()
}

/// `a − b` of snapped coordinates, in pixels.
#[inline(always)]
fn pixels<L: Lanes>(a: F32<L>, b: F32<L>) -> F64<L> {
    F64::from_f32(a - b) * (1.0 / 256.0)
}

/// Screen gradients of a quantity (rules §3.6).
#[inline(always)]
fn gradients<L: Lanes>(q: &Corners<L>, v: &[F32<L>; 3]) -> (F64<L>, F64<L>) {
    let (ax, ay) = (pixels(q.x[1], q.x[0]), pixels(q.y[1], q.y[0]));
    let (bx, by) = (pixels(q.x[2], q.x[0]), pixels(q.y[2], q.y[0]));
    let det = ax * by - bx * ay;
    let first = F64::from_f32(v[0]);
    let (e1, e2) = (F64::from_f32(v[1]) - first, F64::from_f32(v[2]) - first);
    ((e1 * by - e2 * ay) / det, (e2 * ax - e1 * bx) / det)
}

/// Depth bias of each triangle (rules §5).
#[inline(always)]
fn biases<L: Lanes>(
    state: &GeometryState,
    zx: &[f64; LANES],
    zy: &[f64; LANES],
    q: &Corners<L>,
) -> [f64; LANES] {
    let b = state.bias;
    if b.constant == 0.0 && b.slope == 0.0 {
        return [0.0; LANES];
    }
    let z = [q.z[0].to_array(), q.z[1].to_array(), q.z[2].to_array()];
    core::array::from_fn(|i| {
        let largest = z
            .iter()
            .map(|z| z[i].abs())
            .fold(0.0f32, |m, v| if v > m { v } else { m });
        let step = match state.encoding {
            DepthEncoding::D24 => 1.0 / 16_777_216.0,
            DepthEncoding::Float => float_step(largest),
        };
        let slope = if zx[i].abs() > zy[i].abs() {
            zx[i].abs()
        } else {
            zy[i].abs()
        };
        let bias = f64::from(b.constant) * step + f64::from(b.slope) * slope;
        let limit = f64::from(b.clamp);
        if (limit > 0.0 && bias > limit) || (limit < 0.0 && bias < limit) {
            limit
        } else {
            bias
        }
    })
}

/// 2^(e − 23), e the exponent of v; 0 for 0.
fn float_step(v: f32) -> f64 {
    if v == 0.0 {
        return 0.0;
    }
    let bits = f64::from(v).to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i64 - 1023;
    f64::from_bits(((exponent - 23 + 1023) as u64) << 52)
}

/// First and last column and row whose centres can be covered.
#[inline(always)]
fn pixel_bounds<L: Lanes>(q: &Corners<L>) -> [[i32; LANES]; 4] {
    [
        first_pixel(&q.x),
        first_pixel(&q.y),
        last_pixel(&q.x),
        last_pixel(&q.y),
    ]
}

#[inline(always)]
fn first_pixel<L: Lanes>(v: &[F32<L>; 3]) -> [i32; LANES] {
    let low = v[0].min(v[1]).min(v[2]).to_i32();
    ((low + I32::splat(v[0].l, 127)) >> 8).to_array()
}

#[inline(always)]
fn last_pixel<L: Lanes>(v: &[F32<L>; 3]) -> [i32; LANES] {
    let high = v[0].max(v[1]).max(v[2]).to_i32();
    ((high - I32::splat(v[0].l, 128)) >> 8).to_array()
}

#[inline(always)]
#[allow(
    clippy::too_many_arguments,
    reason = "the columns of one table; splitting it would only hide that"
)]
fn emit<L: Lanes>(
    chunk: &mut Chunk,
    pieces: &[Piece],
    alive: u16,
    front: u16,
    e: &Edges,
    d: &DepthPlanes,
    bounds: &[[i32; LANES]; 4],
    q: &Corners<L>,
    depth_clamp: bool,
) {
    let (x, y, z) = (q.x[0].to_array(), q.y[0].to_array(), q.z[0].to_array());
    let mut left = alive;
    while left != 0 {
        let i = left.trailing_zeros() as usize;
        left &= left - 1;
        chunk.triangles.push(Triangle {
            c: [e.c[0][i], e.c[1][i], e.c[2][i]],
            dx: [e.dx[0][i], e.dx[1][i], e.dx[2][i]],
            dy: [e.dy[0][i], e.dy[1][i], e.dy[2][i]],
            bounds: [
                bounds[0][i] as i16,
                bounds[1][i] as i16,
                bounds[2][i] as i16,
                bounds[3][i] as i16,
            ],
            zx: d.zx[i],
            zy: d.zy[i],
            bias: d.bias[i],
            x: x[i],
            y: y[i],
            z: z[i],
            slope: [d.slope[0][i], d.slope[1][i]],
            v: pieces[i].v,
            primitive: pieces[i].primitive,
            piece: pieces[i].piece,
            front: front >> i & 1 != 0,
            far: pieces[i].far && !depth_clamp,
            steep: d.steep >> i & 1 != 0,
        });
    }
}
