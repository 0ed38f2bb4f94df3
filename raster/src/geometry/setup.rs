//! Triangle set-up, 16 at a time (rules §3.4–§3.6, §5).

use bytemuck::{Pod, Zeroable};

use super::assemble::{Chunk, ChunkInput};
use super::{DepthEncoding, GeometryState};
use crate::simd::{F32, F64, I32, LANES, Lanes, Mask, SimdLevel, U32, each3, outlined, with_lanes};
use crate::state::{CullMode, FrontFace};

/// Triangles on their way into set-up: one packet, filled lane by lane.
#[derive(Debug, Default)]
pub(crate) struct Packet {
    v: [[u32; LANES]; 3],
    primitive: [u32; LANES],
    piece: [u32; LANES],
    /// Lanes that are part of a line or point: front-facing whatever their winding.
    widened: u16,
    /// Lanes with a corner beyond the far plane.
    far: u16,
    len: usize,
}

/// One triangle of a [`Packet`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) v: [u32; 3],
    pub(crate) primitive: u32,
    pub(crate) piece: u16,
    pub(crate) widened: bool,
    pub(crate) far: bool,
}

impl Packet {
    #[inline(always)]
    pub(super) fn push(&mut self, p: Piece) {
        let i = self.len;
        self.v[0][i] = p.v[0];
        self.v[1][i] = p.v[1];
        self.v[2][i] = p.v[2];
        self.primitive[i] = p.primitive;
        self.piece[i] = u32::from(p.piece);
        self.widened |= u16::from(p.widened) << i;
        self.far |= u16::from(p.far) << i;
        self.len += 1;
    }

    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.len == LANES
    }

    pub(super) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Whatever was left in the lanes stays there: they are masked out.
    pub(super) fn clear(&mut self) {
        (self.len, self.widened, self.far) = (0, 0, 0);
    }
}

/// Depth 1 of D24 with its fraction.
pub(crate) const D24_SCALE: f64 = 16_777_215.0 * 32.0;
/// Limit of a D24 plane's value at a block's origin, and of its slope.
pub(crate) const D24_BASE_LIMIT: f64 = 1_677_721_583.0;
const D24_SLOPE_LIMIT: f64 = 33_554_432.0;

/// Twice the area of a block, in the units of edges: 1/256 of a pixel.
const TWICE_A_BLOCK: u64 = 2 * 2048 * 2048;

/// Side of the window in which small triangles carry their coverage.
const WINDOW: i32 = 8;

const FRONT: u32 = 1;
const FAR: u32 = 2;
const STEEP: u32 = 4;

/// A triangle ready for rasterisation: two cache lines, of which the first is all
/// that a small triangle's fixed function looks at.
///
/// Triangles whose bounds fit in 8×8 pixels carry their covered pixels in `mask`.
/// Of the others `mask` is 0: at pixel (i, j) edge k has the value
/// `c[k] + dx[k]·j − dy[k]·i`, and the pixel is covered where all three are ≥ 0.
/// The eight bits below the pixel grid and the top-left rule are folded into `c`,
/// exactly.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Triangle {
    /// Bit `8·row + column`: the pixel at that distance from the first corner of
    /// `bounds` is covered.
    pub(crate) mask: u64,
    /// Covered pixels lie inside x0, y0, x1, y1, both ends inclusive.
    pub(crate) bounds: [i16; 4],
    /// Depth gradients.
    pub(crate) zx: f64,
    pub(crate) zy: f64,
    /// Vertex 0: snapped position and depth.
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    /// Depth gradients as the block kernels use them: D24 integers or float bits.
    pub(crate) slope: [i32; 2],
    pub(crate) primitive: u32,
    pub(crate) piece: u16,
    flags: u16,
    pub(crate) v: [u32; 3],
    /// Edges; meaningless where `mask` is not 0.
    pub(crate) c: [f64; 3],
    pub(crate) dx: [i32; 3],
    pub(crate) dy: [i32; 3],
    pub(crate) bias: f64,
}

const _: () = assert!(core::mem::size_of::<Triangle>() == 128);
// Set-up writes triangles as columns of 32-bit words.
const _: () = assert!(cfg!(target_endian = "little"));

impl Triangle {
    #[inline(always)]
    pub(crate) fn is_front(&self) -> bool {
        u32::from(self.flags) & FRONT != 0
    }

    /// Pixels beyond the far end must be cut off.
    #[inline(always)]
    pub(crate) fn is_cut_far(&self) -> bool {
        u32::from(self.flags) & FAR != 0
    }

    /// D24 slopes are beyond fixed point: depth is computed in doubles.
    #[inline(always)]
    pub(crate) fn is_steep(&self) -> bool {
        u32::from(self.flags) & STEEP != 0
    }

    /// Blocks that it covers at most: those of its bounds, or those inside it and those
    /// that its outline passes through, each edge a column or a row further at a time.
    pub(crate) fn most_blocks(&self) -> u64 {
        let [x0, y0, x1, y1] = self.bounds.map(|b| i64::from(b >> 3));
        let [w, h] = [x1 - x0 + 1, y1 - y0 + 1].map(|n| n.max(0) as u64);
        if self.mask != 0 {
            return w * h;
        }
        let [a, b] = [0, 1].map(|i| [self.dx[i], self.dy[i]].map(i64::from));
        let twice = (a[0] * b[1] - a[1] * b[0]).unsigned_abs();
        (w * h).min(twice / TWICE_A_BLOCK + 2 * (w + h) + 4)
    }

    /// Whether fixed function must look closer: at the far end, or in doubles.
    #[inline(always)]
    pub(crate) fn is_special(&self) -> bool {
        u32::from(self.flags) & (FAR | STEEP) != 0
    }

    /// Depth at the origin pixel of the block at pixel (x, y), in doubles, without bias.
    #[inline(always)]
    pub(crate) fn depth_base(&self, x: u32, y: u32) -> f64 {
        let dx = (f64::from(x) + 0.5) - f64::from(self.x) * (1.0 / 256.0);
        let dy = (f64::from(y) + 0.5) - f64::from(self.y) * (1.0 / 256.0);
        f64::from(self.z) + (self.zx * dx + self.zy * dy)
    }
}

/// Sets up the triangles of `packet` and appends what survives to the chunk.
pub(super) fn packet(level: SimdLevel, input: &ChunkInput<'_>, chunk: &mut Chunk, packet: &Packet) {
    with_lanes!(level, l => packet_lanes(l, input, chunk, packet));
}

/// Coordinates of 16 triangles: one vector a vertex.
struct Corners<L: Lanes> {
    x: [F32<L>; 3],
    y: [F32<L>; 3],
    z: [F32<L>; 3],
}

#[inline(always)]
fn gather<L: Lanes>(l: L, input: &ChunkInput<'_>, chunk: &Chunk, packet: &Packet) -> Corners<L> {
    let mut a = [[[0.0f32; LANES]; 3]; 3];
    for k in 0..3 {
        for lane in 0..packet.len {
            let s = chunk.screen(input.shaded, packet.v[k][lane]);
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

/// ```text
/// facing of 16 triangles by their area; without those degenerate or culled
/// depth planes and bounds; without those that touch no pixel that may be drawn
/// edges; of small triangles the mask of the 8×8 window that they fit in;
///     without those whose mask is empty
/// of the others the edges' constants
/// a table with a column for each number and a row for each triangle
/// ```
///
/// Each step ends early where no triangle is left.
#[inline(always)]
fn packet_lanes<L: Lanes>(l: L, input: &ChunkInput<'_>, chunk: &mut Chunk, packet: &Packet) {
    let state = input.state;
    let q = gather(l, input, chunk, packet);
    let facing = Facing::new(l, state, packet, &q);
    let alive = facing.drawn;
    let c = &mut chunk.counters;
    c.degenerate += u64::from(facing.degenerate.count_ones());
    c.face_culled += u64::from(facing.culled.count_ones());
    c.rasterized += u64::from(alive.count_ones());
    if alive == 0 {
        return;
    }
    let depth = outlined(
        l,
        #[inline(always)]
        || DepthPlanes::new(l, state, &q),
    );
    chunk.counters.steep_depth_planes += u64::from((depth.steep & alive).count_ones());
    let bounds = outlined(
        l,
        #[inline(always)]
        || Bounds::new(l, &q, state.rect),
    );
    let alive = alive & bounds.drawable;
    if alive == 0 {
        return;
    }
    let directed = outlined(
        l,
        #[inline(always)]
        || Directed::new(l, &q, facing.negative),
    );
    let small = alive & bounds.small;
    let mask = if small != 0 {
        outlined(
            l,
            #[inline(always)]
            || window_masks(l, &q, &directed, &bounds, small),
        )
    } else {
        [U32::splat(l, 0); 2]
    };
    let empty = (mask[0] | mask[1]).eq(U32::splat(l, 0)).bits() & small;
    let alive = alive & !empty;
    if alive == 0 {
        return;
    }
    let c = if alive & !small != 0 {
        outlined(
            l,
            #[inline(always)]
            || edge_constants(l, &q, &directed),
        )
    } else {
        [F64::splat(l, 0.0); 3]
    };
    let rows = outlined(
        l,
        #[inline(always)]
        || {
            let table = Table {
                packet,
                q: &q,
                bounds: &bounds,
                mask,
                small,
                front: facing.front,
                depth: &depth,
                directed: &directed,
                constants: &c,
            };
            table.rows(l, state)
        },
    );
    emit(chunk, input, alive, alive & small, &bounds, &rows);
}

/// Which way the triangles turn, and what is left of them.
struct Facing<L: Lanes> {
    /// Those of negative area.
    negative: Mask<L>,
    front: u16,
    degenerate: u16,
    culled: u16,
    /// Neither degenerate nor culled.
    drawn: u16,
}

impl<L: Lanes> Facing<L> {
    #[inline(always)]
    fn new(l: L, state: &GeometryState, packet: &Packet, q: &Corners<L>) -> Self {
        let present = ((1u32 << packet.len) - 1) as u16;
        let area = outlined(
            l,
            #[inline(always)]
            || doubled_area(q),
        );
        let zero = F64::splat(l, 0.0);
        let (negative, positive) = (area.lt(zero), zero.lt(area));
        let some = (negative | positive).bits() & present;
        let clockwise = if state.front_face == FrontFace::Ccw {
            negative.bits()
        } else {
            positive.bits()
        };
        let front = clockwise | packet.widened;
        let culled = facing_to_cull(state, front) & !packet.widened & some;
        Self {
            negative,
            front,
            degenerate: present & !some,
            culled,
            drawn: some & !culled,
        }
    }
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

/// Edge directions, turned so that the inside is where values are positive, and
/// the top-left rule as what is subtracted from E·256.
struct Directed<L: Lanes> {
    dx: [F32<L>; 3],
    dy: [F32<L>; 3],
    bias: [F32<L>; 3],
}

impl<L: Lanes> Directed<L> {
    #[inline(always)]
    fn new(l: L, q: &Corners<L>, negative: Mask<L>) -> Self {
        let zero = F32::splat(l, 0.0);
        let mut e = Self {
            dx: [zero; 3],
            dy: [zero; 3],
            bias: [zero; 3],
        };
        for k in 0..3 {
            let b = (k + 1) % 3;
            let (dx, dy) = (q.x[b] - q.x[k], q.y[b] - q.y[k]);
            let (dx, dy) = (negative.select_f32(-dx, dx), negative.select_f32(-dy, dy));
            let owns = dy.lt(zero) | (dy.eq(zero) & dx.gt(zero));
            (e.dx[k], e.dy[k]) = (dx, dy);
            e.bias[k] = owns.select_f32(zero, F32::splat(l, 1.0));
        }
        e
    }
}

/// Edge values at pixel (0, 0).
#[inline(always)]
fn edge_constants<L: Lanes>(l: L, q: &Corners<L>, e: &Directed<L>) -> [F64<L>; 3] {
    let half = F32::splat(l, 128.0);
    each3(
        #[inline(always)]
        |k| {
            // E·256; products and sums of integers below 2⁵³ are exact.
            let at_origin = F64::from_f32(e.dx[k]) * F64::from_f32(half - q.y[k])
                - F64::from_f32(e.dy[k]) * F64::from_f32(half - q.x[k]);
            ((at_origin - F64::from_f32(e.bias[k])) * (1.0 / 256.0)).floor()
        },
    )
}

/// Covered pixels of the 8×8 windows at the first corner of the bounds, low and
/// high word. Only the lanes of `small` mean anything.
#[inline(always)]
fn window_masks<L: Lanes>(
    l: L,
    q: &Corners<L>,
    e: &Directed<L>,
    bounds: &Bounds<L>,
    small: u16,
) -> [U32<L>; 2] {
    // Numbers of a small triangle are below 2²³: 32 bits hold everything.
    let half = I32::splat(l, 128);
    let (x, y) = (
        (bounds.corner[0] << 8) + half,
        (bounds.corner[1] << 8) + half,
    );
    let dx: [I32<L>; 3] = each3(
        #[inline(always)]
        |k| e.dx[k].to_i32(),
    );
    let dy: [I32<L>; 3] = each3(
        #[inline(always)]
        |k| e.dy[k].to_i32(),
    );
    let mut row: [I32<L>; 3] = each3(
        #[inline(always)]
        |k| {
            let at = dx[k] * (y - q.y[k].to_i32()) - dy[k] * (x - q.x[k].to_i32());
            (at - e.bias[k].to_i32()) >> 8
        },
    );
    let lanes = Mask::from_bits(l, small);
    let none = I32::splat(l, 0);
    let across = lanes
        .select_i32(bounds.corner[2] - bounds.corner[0], none)
        .reduce_max();
    let down = lanes
        .select_i32(bounds.corner[3] - bounds.corner[1], none)
        .reduce_max();
    let mut outside = [U32::splat(l, u32::MAX); 2];
    for j in 0..=down as u32 {
        let mut v = row;
        let mut byte = U32::splat(l, 0);
        for i in 0..=across as u32 {
            let sign = (v[0] | v[1] | v[2]).to_u32() >> 31;
            byte = byte | (sign << i);
            for k in 0..3 {
                v[k] = v[k] - dy[k];
            }
        }
        // What lies beyond the widest lane is outside.
        byte = byte | U32::splat(l, (0xfe << across) & 0xff);
        let word = &mut outside[j as usize / 4];
        let shift = 8 * (j % 4);
        *word = *word ^ ((byte ^ U32::splat(l, 0xff)) << shift);
        for k in 0..3 {
            row[k] = row[k] + dx[k];
        }
    }
    [!outside[0], !outside[1]]
}

struct DepthPlanes<L: Lanes> {
    zx: F64<L>,
    zy: F64<L>,
    bias: F64<L>,
    slope: [I32<L>; 2],
    steep: u16,
}

impl<L: Lanes> DepthPlanes<L> {
    #[inline(always)]
    fn new(l: L, state: &GeometryState, q: &Corners<L>) -> Self {
        let (zx, zy) = gradients(q, &q.z);
        let mut steep = 0;
        let slope = match state.encoding {
            DepthEncoding::D24 => {
                let (sx, sy) = (zx * D24_SCALE, zy * D24_SCALE);
                steep = beyond(sx) | beyond(sy);
                [
                    sx.round_to_i32(D24_SLOPE_LIMIT),
                    sy.round_to_i32(D24_SLOPE_LIMIT),
                ]
            }
            DepthEncoding::Float => [
                zx.to_f32().raw_bits().to_i32(),
                zy.to_f32().raw_bits().to_i32(),
            ],
        };
        let b = state.bias;
        let bias = if b.constant == 0.0 && b.slope == 0.0 {
            F64::splat(l, 0.0)
        } else {
            F64::from_array(l, &biases(state, &zx.to_array(), &zy.to_array(), q))
        };
        Self {
            zx,
            zy,
            bias,
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

/// First and last column and row whose centres can be covered, and what follows.
struct Bounds<L: Lanes> {
    /// x0, y0, x1, y1, both ends inclusive.
    corner: [I32<L>; 4],
    /// Some pixel centre lies inside both them and the drawn rectangle.
    drawable: u16,
    /// They fit in a window.
    small: u16,
    /// The same inside the drawn rectangle.
    drawn: [I32<L>; 4],
}

impl<L: Lanes> Bounds<L> {
    #[inline(always)]
    fn new(l: L, q: &Corners<L>, rect: [i32; 4]) -> Self {
        let corner = [
            first_pixel(&q.x),
            first_pixel(&q.y),
            last_pixel(&q.x),
            last_pixel(&q.y),
        ];
        let drawn = [
            corner[0].max(I32::splat(l, rect[0])),
            corner[1].max(I32::splat(l, rect[1])),
            corner[2].min(I32::splat(l, rect[2] - 1)),
            corner[3].min(I32::splat(l, rect[3] - 1)),
        ];
        let side = I32::splat(l, WINDOW);
        let small = (corner[2] - corner[0]).lt(side) & (corner[3] - corner[1]).lt(side);
        let drawable = drawn[0].le(drawn[2]) & drawn[1].le(drawn[3]);
        Self {
            corner,
            drawable: drawable.bits(),
            small: small.bits(),
            drawn,
        }
    }
}

#[inline(always)]
fn first_pixel<L: Lanes>(v: &[F32<L>; 3]) -> I32<L> {
    let low = v[0].min(v[1]).min(v[2]).to_i32();
    (low + I32::splat(v[0].l, 127)) >> 8
}

#[inline(always)]
fn last_pixel<L: Lanes>(v: &[F32<L>; 3]) -> I32<L> {
    let high = v[0].max(v[1]).max(v[2]).to_i32();
    (high - I32::splat(v[0].l, 128)) >> 8
}

/// What is stored of 16 triangles, by column.
struct Table<'a, L: Lanes> {
    packet: &'a Packet,
    q: &'a Corners<L>,
    bounds: &'a Bounds<L>,
    mask: [U32<L>; 2],
    small: u16,
    front: u16,
    depth: &'a DepthPlanes<L>,
    directed: &'a Directed<L>,
    constants: &'a [F64<L>; 3],
}

impl<L: Lanes> Table<'_, L> {
    /// The triangles, as they lie in memory.
    #[inline(always)]
    fn rows(&self, l: L, state: &GeometryState) -> [[[u32; LANES]; LANES]; 2] {
        let &Table {
            packet,
            q,
            bounds,
            mask,
            small,
            front,
            depth: d,
            directed: e,
            constants: c,
        } = self;
        let zero = U32::splat(l, 0);
        let small = Mask::from_bits(l, small);
        let far = if state.depth_clamp { 0 } else { packet.far };
        let flags = flag(l, front, FRONT) | flag(l, far, FAR) | flag(l, d.steep, STEEP);
        let (zx, zy, bias) = (d.zx.words(), d.zy.words(), d.bias.words());
        let (c0, c1, c2) = (c[0].words(), c[1].words(), c[2].words());
        let hot = [
            small.select_u32(mask[0], zero),
            small.select_u32(mask[1], zero),
            halves(bounds.corner[0], bounds.corner[1]),
            halves(bounds.corner[2], bounds.corner[3]),
            zx.0,
            zx.1,
            zy.0,
            zy.1,
            q.x[0].raw_bits(),
            q.y[0].raw_bits(),
            q.z[0].raw_bits(),
            d.slope[0].to_u32(),
            d.slope[1].to_u32(),
            U32::from_array(l, &packet.primitive),
            U32::from_array(l, &packet.piece) | flags,
            U32::from_array(l, &packet.v[0]),
        ];
        let cold = [
            U32::from_array(l, &packet.v[1]),
            U32::from_array(l, &packet.v[2]),
            c0.0,
            c0.1,
            c1.0,
            c1.1,
            c2.0,
            c2.1,
            e.dx[0].to_i32().to_u32(),
            e.dx[1].to_i32().to_u32(),
            e.dx[2].to_i32().to_u32(),
            e.dy[0].to_i32().to_u32(),
            e.dy[1].to_i32().to_u32(),
            e.dy[2].to_i32().to_u32(),
            bias.0,
            bias.1,
        ];
        let mut rows = [[[0; LANES]; LANES]; 2];
        for (half, columns) in rows.iter_mut().zip([hot, cold]) {
            outlined(
                l,
                #[inline(always)]
                || transpose(&columns, half),
            );
        }
        rows
    }
}

/// `flag` in the lanes of `bits`, in the upper half of the word.
#[inline(always)]
fn flag<L: Lanes>(l: L, bits: u16, flag: u32) -> U32<L> {
    Mask::from_bits(l, bits).select_u32(U32::splat(l, flag << 16), U32::splat(l, 0))
}

/// Two 16-bit numbers in a word, the first in the lower half.
#[inline(always)]
fn halves<L: Lanes>(a: I32<L>, b: I32<L>) -> U32<L> {
    (a.to_u32() & U32::splat(a.l, 0xffff)) | (b.to_u32() << 16)
}

/// Makes row `i` lane `i` of every column.
#[inline(always)]
fn transpose<L: Lanes>(columns: &[U32<L>; LANES], rows: &mut [[u32; LANES]; LANES]) {
    let mut v = *columns;
    for _ in 0..LANES.ilog2() {
        // A perfect shuffle of the 256 words; four of them transpose.
        let mut w = v;
        for i in 0..LANES / 2 {
            (w[2 * i], w[2 * i + 1]) = v[i].interleave(v[i + LANES / 2]);
        }
        v = w;
    }
    for i in 0..LANES {
        v[i].store(&mut rows[i]);
    }
}

/// Appends the triangles of `alive` to the chunk and its bins.
#[inline(always)]
fn emit<L: Lanes>(
    chunk: &mut Chunk,
    input: &ChunkInput<'_>,
    alive: u16,
    small: u16,
    bounds: &Bounds<L>,
    rows: &[[[u32; LANES]; LANES]; 2],
) {
    let shift = input.grid.shift;
    let tile = [
        (bounds.drawn[0] >> shift).to_array(),
        (bounds.drawn[1] >> shift).to_array(),
        (bounds.drawn[2] >> shift).to_array(),
        (bounds.drawn[3] >> shift).to_array(),
    ];
    let mut left = alive;
    while left != 0 {
        let i = left.trailing_zeros() as usize;
        left &= left - 1;
        let t: Triangle = bytemuck::cast([rows[0][i], rows[1][i]]);
        let number = chunk.triangles.len() as u32;
        let span = [
            tile[0][i] as u32,
            tile[1][i] as u32,
            tile[2][i] as u32,
            tile[3][i] as u32,
        ];
        if small >> i & 1 != 0 {
            chunk.bins.add_all(number, span, input.grid);
        } else {
            chunk.bins.add_covered(number, &t, span, input.grid);
        }
        chunk.triangles.push(t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of these corners, in 1/256 of a pixel, as far as its blocks go.
    fn triangle(corners: [[i32; 2]; 3]) -> Triangle {
        let edge =
            |axis: usize| core::array::from_fn(|k| corners[(k + 1) % 3][axis] - corners[k][axis]);
        let ends = |axis: usize| {
            let all = corners.map(|c| (c[axis] >> 8) as i16);
            [
                all[0].min(all[1]).min(all[2]),
                all[0].max(all[1]).max(all[2]),
            ]
        };
        let [x, y] = [ends(0), ends(1)];
        Triangle {
            bounds: [x[0], y[0], x[1], y[1]],
            dx: edge(0),
            dy: edge(1),
            ..Triangle::zeroed()
        }
    }

    /// Blocks that have a pixel's centre inside, one by one.
    fn blocks(corners: [[i32; 2]; 3]) -> u64 {
        let cross = |a: [i32; 2], b: [i32; 2], p: [i32; 2]| {
            let [ux, uy, vx, vy] =
                [b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]].map(i64::from);
            ux * vy - uy * vx
        };
        let inside = |p| {
            let signs = [0, 1, 2].map(|k| cross(corners[k], corners[(k + 1) % 3], p));
            signs.iter().all(|s| *s >= 0) || signs.iter().all(|s| *s <= 0)
        };
        let covered = |i: i32| {
            let (bx, by) = (i % 64, i / 64);
            let mut pixels = (0..64).map(|p| [8 * bx + p % 8, 8 * by + p / 8]);
            pixels.any(|p| inside(p.map(|v| 256 * v + 128)))
        };
        (0..64 * 64).filter(|i| covered(*i)).count() as u64
    }

    #[test]
    fn no_triangle_covers_more_blocks_than_it_is_said_to() {
        let mut state = 7u32;
        let mut next = |limit: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 12) as i32 % limit
        };
        for case in 0..60 {
            let limit = [512 * 256, 300 * 256, 40 * 256][case % 3];
            let corners = core::array::from_fn(|_| [next(limit), next(limit)]);
            assert!(
                triangle(corners).most_blocks() >= blocks(corners),
                "{corners:?}"
            );
        }
    }

    #[test]
    fn slender_triangles_are_said_to_cover_few_blocks() {
        let corner = 512 * 256 - 1;
        let diagonal = triangle([[0, 0], [corner, corner], [corner, corner - 256]]);
        assert!(diagonal.most_blocks() < 300, "{}", diagonal.most_blocks());
    }
}
