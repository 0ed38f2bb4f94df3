//! What sections hold, as plain data: the encoding is postcard's, of these structs in
//! the order of their fields. They are never changed; a later layout gets a later version.

use serde::{Deserialize, Serialize};

/// Version of all sections here.
pub(crate) const VERSION: u16 = 1;

/// `FRAM`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Frame {
    pub(crate) textures: Vec<Texture>,
    pub(crate) vertices: Vec<Vertices>,
    pub(crate) indices: Vec<u32>,
    pub(crate) pipelines: Vec<Pipeline>,
    pub(crate) passes: Vec<Pass>,
    pub(crate) outputs: Vec<(String, u32)>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Texture {
    pub(crate) label: String,
    pub(crate) dimension: u8,
    pub(crate) format: u8,
    pub(crate) size: [u32; 3],
    pub(crate) mip_levels: u32,
    /// Mip, layer, blob of images that are not all zeros.
    pub(crate) contents: Vec<(u32, u32, u32)>,
}

/// A vertex buffer: blob of its floats, floats of a vertex.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Vertices {
    pub(crate) blob: u32,
    pub(crate) stride: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pipeline {
    pub(crate) label: String,
    /// Among the frame's shaders.
    pub(crate) vertex: u32,
    pub(crate) fragment: Option<u32>,
    pub(crate) primitive: Primitive,
    pub(crate) depth_stencil: DepthStencil,
    pub(crate) color_targets: Vec<ColorTarget>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Primitive {
    pub(crate) topology: u8,
    pub(crate) front_face: u8,
    pub(crate) cull_mode: u8,
    pub(crate) depth_clamp: bool,
    pub(crate) clip_planes: Vec<[f32; 4]>,
    pub(crate) line_width: f32,
    pub(crate) point_size: f32,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DepthStencil {
    pub(crate) compare: u8,
    pub(crate) write: bool,
    pub(crate) bounds: Option<[f32; 2]>,
    pub(crate) front: Face,
    pub(crate) back: Face,
    /// Constant, slope, clamp.
    pub(crate) bias: [f32; 3],
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Face {
    pub(crate) compare: u8,
    pub(crate) fail_op: u8,
    pub(crate) depth_fail_op: u8,
    pub(crate) pass_op: u8,
    pub(crate) read_mask: u8,
    pub(crate) write_mask: u8,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ColorTarget {
    /// Of colour, then of alpha: source factor, destination factor, operation.
    pub(crate) blend: Option<[[u8; 3]; 2]>,
    pub(crate) write_mask: u8,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pass {
    pub(crate) label: String,
    pub(crate) color: Vec<Color>,
    pub(crate) depth_stencil: Option<Depth>,
    pub(crate) draws: Vec<Draw>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum LoadOp<T> {
    Load,
    Clear(T),
    DontCare,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Color {
    pub(crate) texture: u32,
    pub(crate) mip: u32,
    pub(crate) layer: u32,
    pub(crate) load: LoadOp<[f32; 4]>,
    pub(crate) discard: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Depth {
    pub(crate) texture: u32,
    pub(crate) mip: u32,
    pub(crate) layer: u32,
    pub(crate) depth_load: LoadOp<f32>,
    pub(crate) depth_discard: bool,
    pub(crate) stencil_load: LoadOp<u8>,
    pub(crate) stencil_discard: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Draw {
    pub(crate) label: String,
    pub(crate) pipeline: u32,
    pub(crate) vertices: Option<u32>,
    pub(crate) indices: Option<u32>,
    pub(crate) first: u32,
    pub(crate) count: u32,
    pub(crate) instances: u32,
    pub(crate) stencil_reference: [u8; 2],
    pub(crate) blend_constant: [f32; 4],
    /// x, y, width, height, least and greatest depth.
    pub(crate) viewport: Option<[f32; 6]>,
    /// x, y, width, height.
    pub(crate) scissor: Option<[u32; 4]>,
    pub(crate) textures: Vec<Binding>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Binding {
    pub(crate) texture: u32,
    pub(crate) address: [u8; 3],
    /// Magnification, minification, between levels.
    pub(crate) filters: [u8; 3],
    pub(crate) lod: [f32; 2],
    pub(crate) lod_bias: f32,
    pub(crate) border: [f32; 4],
}

/// `SHAD` is a list of these.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Shader {
    /// 0 vertex, 1 fragment.
    pub(crate) stage: u8,
    pub(crate) name: String,
    pub(crate) version: u32,
    pub(crate) uniforms: Vec<u8>,
    /// It may discard; it writes depth; texture slots that it reads.
    pub(crate) outputs: (bool, bool, u32),
}

/// `HASH`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Hashes {
    /// Of each pass, what its attachments hold at its end: colours, then depth-stencil.
    pub(crate) ends: Vec<Vec<u128>>,
    /// Of each pass, tiles of 64×64 pixels that draws wrote to.
    pub(crate) draws: Vec<Vec<TileHash>>,
}

/// What a draw left in a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct TileHash {
    pub(crate) draw: u32,
    /// Column, row.
    pub(crate) tile: [u16; 2],
    pub(crate) hash: u64,
}

/// `COUN`: counters in the order of `counters.rs`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Counts {
    pub(crate) skipping: Vec<PassCounts>,
    /// Empty where no traffic was recorded.
    pub(crate) unskipped: Vec<PassCounts>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PassCounts {
    pub(crate) clear: Vec<u64>,
    pub(crate) draws: Vec<Vec<u64>>,
}
