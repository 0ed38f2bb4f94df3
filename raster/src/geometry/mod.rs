//! From vertices to binned triangle set-ups.
//!
//! `shade` runs the vertex shader and projects; `assemble` takes primitives of a
//! chunk, clips the few that need it (`clip`) and widens lines and points
//! (`widen`); `setup` turns 16 triangles at a time into [`Triangle`]s; `bin` sorts
//! them into execution tiles. Chunks are independent of one another, and their
//! order is submission order.

mod assemble;
mod bin;
mod clip;
mod setup;
mod shade;
mod widen;

pub(crate) use assemble::{Chunk, ChunkInput, process_chunk};
pub(crate) use bin::TileGrid;
pub(crate) use setup::{D24_BASE_LIMIT, D24_SCALE, Triangle};
pub(crate) use shade::{ScreenVertex, ShadedVertices, shade_part};

use crate::state::{CullMode, FrontFace, PrimitiveTopology, Viewport};

/// First and last-but-one pixel that a coordinate may reach before clipping.
pub(crate) const GUARD_MIN: f32 = -4096.0;
pub(crate) const GUARD_MAX: f32 = 12288.0;

/// What the depth buffer's format makes of a depth plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DepthEncoding {
    D24,
    Float,
}

/// Everything of a draw that the geometry stage looks at.
#[derive(Clone, Debug)]
pub(crate) struct GeometryState {
    pub(crate) topology: PrimitiveTopology,
    pub(crate) front_face: FrontFace,
    pub(crate) cull_mode: CullMode,
    pub(crate) depth_clamp: bool,
    /// Width of lines and side of points in pixels.
    pub(crate) line_width: f32,
    pub(crate) point_size: f32,
    pub(crate) viewport: ViewportTransform,
    pub(crate) encoding: DepthEncoding,
    pub(crate) bias: crate::state::DepthBias,
    /// Pixels that may be drawn: x0, y0, x1, y1, half-open.
    pub(crate) rect: [i32; 4],
    pub(crate) varyings: usize,
    /// Bit i: varying i is flat.
    pub(crate) flat: u32,
}

/// The viewport in the form in which vertices use it (rules §2, §3.1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewportTransform {
    pub(crate) half: [f32; 2],
    pub(crate) center: [f32; 2],
    pub(crate) depth_scale: f32,
    pub(crate) depth_offset: f32,
    /// Guard band in NDC: right, left, bottom, top.
    pub(crate) guard: [f32; 4],
}

impl ViewportTransform {
    pub(crate) fn new(v: &Viewport) -> Self {
        let half = [v.width * 0.5, v.height * 0.5];
        let center = [v.x + half[0], v.y + half[1]];
        let guard = [
            (GUARD_MAX - center[0]) / half[0],
            (center[0] - GUARD_MIN) / half[0],
            (GUARD_MAX - center[1]) / half[1],
            (center[1] - GUARD_MIN) / half[1],
        ];
        Self {
            half,
            center,
            depth_scale: v.max_depth - v.min_depth,
            depth_offset: v.min_depth,
            guard,
        }
    }
}
