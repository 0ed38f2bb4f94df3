//! Primitives of one chunk: rejection, clipping, widening, set-up, binning.

use super::bin::{Bins, TileGrid};
use super::clip::{self, ClipVertex};
use super::setup::{self, Packet, Piece, Triangle};
use super::shade::{
    BEYOND_FAR, NON_FINITE, PLANE_MASK, ScreenVertex, ShadedVertices, VIEW_MASK, W_NOT_POSITIVE,
    project_one,
};
use super::{GeometryState, widen};
use crate::MAX_VARYINGS;
use crate::counters::PrimitiveCounters;
use crate::simd::SimdLevel;
use crate::state::PrimitiveTopology;

/// Set in a vertex reference: it counts into the chunk's own vertices.
pub(crate) const OWN_VERTEX: u32 = 1 << 31;

/// Largest magnitude of a snapped coordinate: 2²² = 16384 pixels.
const COORDINATE_LIMIT: f32 = 4_194_304.0;

/// What a chunk is made from.
pub(crate) struct ChunkInput<'a> {
    pub(crate) state: &'a GeometryState,
    pub(crate) grid: &'a TileGrid,
    pub(crate) shaded: &'a ShadedVertices,
    /// Vertex positions in `shaded`, whole primitives; `None` counts up from `first`.
    pub(crate) indices: Option<&'a [u32]>,
    /// First vertex where there are no indices.
    pub(crate) first: u32,
    /// Primitives of this chunk.
    pub(crate) primitives: u32,
    /// Number of the first of them in its draw.
    pub(crate) first_primitive: u32,
}

/// A run of primitives of one draw, set up and binned.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) bins: Bins,
    /// Vertices that clipping and widening made.
    pub(crate) own: ShadedVertices,
    pub(crate) counters: PrimitiveCounters,
}

impl Chunk {
    /// Screen position of a triangle's vertex.
    #[inline(always)]
    pub(crate) fn screen(&self, shaded: &ShadedVertices, v: u32) -> ScreenVertex {
        if v & OWN_VERTEX == 0 {
            shaded.screen(v)
        } else {
            self.own.screen(v & !OWN_VERTEX)
        }
    }

    /// Varying `i` of `n` of a triangle's vertex.
    #[inline(always)]
    pub(crate) fn varying(&self, shaded: &ShadedVertices, v: u32, i: usize, n: usize) -> f32 {
        if v & OWN_VERTEX == 0 {
            shaded.varying(i, v)
        } else {
            self.own.varyings[(v & !OWN_VERTEX) as usize * n + i]
        }
    }

    /// Clip-space position of a triangle's vertex.
    pub(crate) fn clip_position(&self, shaded: &ShadedVertices, v: u32) -> [f32; 4] {
        if v & OWN_VERTEX == 0 {
            shaded.clip_position(v)
        } else {
            self.own.clip_position(v & !OWN_VERTEX)
        }
    }
}

/// Assembles, clips, sets up and bins the primitives of `input`, in the memory of
/// an old chunk.
pub(crate) fn process_chunk(level: SimdLevel, input: &ChunkInput<'_>, old: Chunk) -> Chunk {
    let mut chunk = old;
    chunk.triangles.clear();
    chunk.bins.clear();
    chunk.own.clear();
    chunk.counters = PrimitiveCounters::default();
    let mut a = Assembler {
        level,
        input,
        chunk,
        packet: Packet::default(),
        poly: Vec::new(),
        spare: Vec::new(),
    };
    a.chunk.triangles.reserve(input.primitives as usize);
    a.chunk.counters.input = u64::from(input.primitives);
    match input.state.topology {
        PrimitiveTopology::TriangleList => (0..input.primitives).for_each(|p| a.triangle(p)),
        PrimitiveTopology::LineList => (0..input.primitives).for_each(|p| a.line(p)),
        PrimitiveTopology::PointList => (0..input.primitives).for_each(|p| a.point(p)),
    }
    a.flush();
    let mut chunk = a.chunk;
    chunk.bins.sort(input.grid.tiles());
    chunk
}

/// Whether snapped coordinates and depth are in the range of set-up.
fn is_usable(s: &ScreenVertex) -> bool {
    s.x.abs() <= COORDINATE_LIMIT && s.y.abs() <= COORDINATE_LIMIT && s.z.is_finite()
}

/// Whether a vertex lies beyond the far plane.
fn is_beyond_far(v: &ClipVertex) -> bool {
    v.position[2] > v.position[3]
}

struct Assembler<'a> {
    level: SimdLevel,
    input: &'a ChunkInput<'a>,
    chunk: Chunk,
    /// Waits until it is full.
    packet: Packet,
    poly: Vec<ClipVertex>,
    spare: Vec<ClipVertex>,
}

impl Assembler<'_> {
    #[inline(always)]
    fn vertices<const N: usize>(&self, primitive: u32) -> [u32; N] {
        let at = primitive as usize * N;
        match self.input.indices {
            Some(i) => i[at..at + N].try_into().expect("whole primitives"),
            None => {
                let mut v = [0; N];
                for k in 0..N {
                    v[k] = self.input.first + (at + k) as u32;
                }
                v
            }
        }
    }

    #[inline(always)]
    fn codes<const N: usize>(&self, v: [u32; N]) -> [u16; N] {
        let mut codes = [0; N];
        for k in 0..N {
            codes[k] = self.input.shaded.codes[v[k] as usize];
        }
        codes
    }

    #[inline(always)]
    fn triangle(&mut self, p: u32) {
        let v = self.vertices::<3>(p);
        let [a, b, c] = self.codes(v);
        let any = a | b | c;
        if any & (PLANE_MASK | NON_FINITE) != 0 {
            return self.unusual_triangle(p, v, any, a & b & c);
        }
        if a & b & c & VIEW_MASK != 0 {
            self.chunk.counters.frustum_culled += 1;
            return;
        }
        let far = any & BEYOND_FAR != 0;
        self.push(Piece {
            v,
            primitive: self.input.first_primitive + p,
            piece: 0,
            widened: false,
            far,
        });
    }

    fn unusual_triangle(&mut self, p: u32, v: [u32; 3], any: u16, all: u16) {
        let outside_view = all & VIEW_MASK != 0 && any & W_NOT_POSITIVE == 0;
        if any & NON_FINITE != 0 {
            self.chunk.counters.non_finite += 1;
        } else if all & PLANE_MASK != 0 || outside_view {
            self.chunk.counters.frustum_culled += 1;
        } else {
            self.chunk.counters.clipped += 1;
            self.clip_triangle(p, v, any & PLANE_MASK);
        }
    }

    fn clip_vertex(&self, v: u32) -> ClipVertex {
        let s = self.input.shaded;
        let mut varyings = [0.0; MAX_VARYINGS];
        for (i, slot) in varyings[..self.input.state.varyings].iter_mut().enumerate() {
            *slot = s.varying(i, v);
        }
        ClipVertex {
            position: s.clip_position(v),
            varyings,
        }
    }

    fn clip_triangle(&mut self, p: u32, v: [u32; 3], mask: u16) {
        let mut poly = core::mem::take(&mut self.poly);
        poly.clear();
        poly.extend(v.map(|v| self.clip_vertex(v)));
        clip::polygon(self.input.state, mask, &mut poly, &mut self.spare);
        if poly.len() < 3 {
            self.chunk.counters.frustum_culled += 1;
        } else {
            let first = self.clip_vertex(v[0]);
            poly.iter_mut().for_each(|c| self.keep_flat(c, &first));
            self.push_fan(p, &poly);
        }
        self.poly = poly;
    }

    /// Flat varyings are those of the primitive's first vertex, wherever it was cut.
    fn keep_flat(&self, c: &mut ClipVertex, first: &ClipVertex) {
        for i in (0..self.input.state.varyings).filter(|i| self.input.state.flat >> i & 1 != 0) {
            c.varyings[i] = first.varyings[i];
        }
    }

    /// The fan of a clipped polygon, unless rounding has thrown a vertex out of
    /// the range that set-up can take (rules §3.2).
    fn push_fan(&mut self, p: u32, poly: &[ClipVertex]) {
        let screen: Vec<ScreenVertex> = poly
            .iter()
            .map(|c| project_one(self.input.state, &c.position))
            .collect();
        if !screen.iter().all(is_usable) {
            self.chunk.counters.non_finite += 1;
            return;
        }
        let fan: Vec<u32> = poly
            .iter()
            .zip(screen)
            .map(|(c, s)| self.push_own(c, s))
            .collect();
        for k in 1..fan.len() - 1 {
            self.push(Piece {
                v: [fan[0], fan[k], fan[k + 1]],
                primitive: self.input.first_primitive + p,
                piece: k as u16 - 1,
                widened: false,
                far: [0, k, k + 1].into_iter().any(|i| is_beyond_far(&poly[i])),
            });
        }
    }

    fn push_own(&mut self, c: &ClipVertex, screen: ScreenVertex) -> u32 {
        let n = self.input.state.varyings;
        self.chunk.own.push(c.position, &c.varyings[..n], screen) | OWN_VERTEX
    }

    fn line(&mut self, p: u32) {
        let v = self.vertices::<2>(p);
        let [a, b] = self.codes(v);
        if (a | b) & NON_FINITE != 0 {
            self.chunk.counters.non_finite += 1;
            return;
        }
        if a & b & PLANE_MASK != 0 {
            self.chunk.counters.frustum_culled += 1;
            return;
        }
        let mask = (a | b) & PLANE_MASK;
        self.chunk.counters.clipped += u64::from(mask != 0);
        let [first, second] = v.map(|v| self.clip_vertex(v));
        let Some(mut ends) = clip::segment(self.input.state, mask, first, second) else {
            self.chunk.counters.frustum_culled += 1;
            return;
        };
        ends.iter_mut().for_each(|e| self.keep_flat(e, &first));
        let screen = ends.map(|e| project_one(self.input.state, &e.position));
        if !screen.iter().all(is_usable) {
            self.chunk.counters.non_finite += 1;
            return;
        }
        match widen::line_corners(screen[0], screen[1], self.input.state.line_width) {
            Some(corners) => self.push_quad(p, corners, [&ends[0], &ends[1], &ends[1], &ends[0]]),
            None => self.chunk.counters.degenerate += 1,
        }
    }

    fn point(&mut self, p: u32) {
        let [v] = self.vertices::<1>(p);
        let [code] = self.codes([v]);
        if code & NON_FINITE != 0 {
            self.chunk.counters.non_finite += 1;
        } else if code & PLANE_MASK != 0 {
            self.chunk.counters.frustum_culled += 1;
        } else {
            let c = self.clip_vertex(v);
            let corners =
                widen::point_corners(self.input.shaded.screen(v), self.input.state.point_size);
            self.push_quad(p, corners, [&c; 4]);
        }
    }

    fn push_quad(&mut self, p: u32, corners: [ScreenVertex; 4], values: [&ClipVertex; 4]) {
        let [a, b, c, d] = core::array::from_fn(|k| self.push_own(values[k], corners[k]));
        let far = values.iter().any(|v| is_beyond_far(v));
        for (piece, v) in [[a, b, c], [a, c, d]].into_iter().enumerate() {
            let primitive = self.input.first_primitive + p;
            self.push(Piece {
                v,
                primitive,
                piece: piece as u16,
                widened: true,
                far,
            });
        }
    }

    #[inline(always)]
    fn push(&mut self, piece: Piece) {
        self.packet.push(piece);
        if self.packet.is_full() {
            self.flush();
        }
    }

    fn flush(&mut self) {
        if !self.packet.is_empty() {
            setup::packet(self.level, self.input, &mut self.chunk, &self.packet);
            self.packet.clear();
        }
    }
}
