//! What can be wrong with a use of the API: the actual value, and the limit.

use crate::format::Format;
use crate::texture::Subresource;

/// Invalid use of the emulated GPU.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(
    missing_docs,
    reason = "each variant's message says what its fields are"
)]
#[non_exhaustive]
pub enum Error {
    #[error("texture `{texture}` cannot be {}×{}×{}: {reason}", .size[0], .size[1], .size[2])]
    InvalidTexture {
        texture: String,
        size: [u32; 3],
        reason: String,
    },
    #[error("texture id {id} does not exist; {count} textures have been created")]
    NoSuchTexture { id: u32, count: usize },
    #[error("the frame has no result `{name}`; it has: {outputs}")]
    NoSuchOutput { name: String, outputs: String },
    #[error(
        "texture `{texture}` has no mip {}, layer {}; it has {mip_levels} mip levels, this one with {layers} layers",
        .subresource.mip, .subresource.layer
    )]
    NoSuchSubresource {
        texture: String,
        subresource: Subresource,
        mip_levels: u32,
        /// Of the mip asked for; 0 where there is no such mip.
        layers: usize,
    },
    #[error("texture `{texture}` is {format:?} and has no {wanted} aspect")]
    WrongAspect {
        texture: String,
        format: Format,
        wanted: &'static str,
    },
    #[error("texture `{texture}` takes {expected} texels, {given} were given")]
    TexelCount {
        texture: String,
        given: usize,
        expected: usize,
    },
    #[error("texture `{texture}`: the image takes {expected} bytes, {given} were given")]
    ByteCount {
        texture: String,
        given: usize,
        expected: usize,
    },
    #[error(
        "texture `{texture}`: stored depth {bits:#010x} is not that of a float in 0..=1; the largest is 0x3f800000"
    )]
    StoredDepth { texture: String, bits: u32 },
    #[error(
        "render pass `{pass}` has no attachment; give it a colour or a depth-stencil attachment"
    )]
    NoAttachment { pass: String },
    #[error("render pass `{pass}` has {given} colour attachments; the limit is {limit}")]
    TooManyAttachments {
        pass: String,
        given: usize,
        limit: usize,
    },
    #[error(
        "render pass `{pass}`: attachment `{texture}` is {}×{}, the others are {}×{}",
        .given[0], .given[1], .expected[0], .expected[1]
    )]
    AttachmentSize {
        pass: String,
        texture: String,
        given: [u32; 2],
        expected: [u32; 2],
    },
    #[error("render pass `{pass}`: texture `{texture}` is attached twice")]
    AttachedTwice { pass: String, texture: String },
    #[error("render pass `{pass}`: `{texture}` is {format:?} and cannot be a {wanted} attachment")]
    AttachmentFormat {
        pass: String,
        texture: String,
        format: Format,
        wanted: &'static str,
    },
    #[error(
        "draw `{draw}`: the render pipeline has {given} colour targets, the render pass {expected}"
    )]
    ColorTargetCount {
        draw: String,
        given: usize,
        expected: usize,
    },
    #[error("draw `{draw}`: colour target {target} ({format:?}) cannot be blended so: {reason}")]
    Unblendable {
        draw: String,
        target: usize,
        format: Format,
        reason: &'static str,
    },
    #[error(
        "draw `{draw}`: depth or stencil state needs a depth-stencil attachment, render pass `{pass}` has none"
    )]
    NoDepthStencil { draw: String, pass: String },
    #[error("draw `{draw}`: shader reads texture slot {slot}, {bound} are bound")]
    MissingTexture {
        draw: String,
        slot: usize,
        bound: usize,
    },
    #[error("draw `{draw}`: texture `{texture}` is bound and attached in the same render pass")]
    FeedbackLoop { draw: String, texture: String },
    #[error("draw `{draw}`: {what} is {given}, the limit is {limit}")]
    Limit {
        draw: String,
        what: &'static str,
        given: usize,
        limit: usize,
    },
    #[error("draw `{draw}`: {what} {given} is out of range; {valid}")]
    OutOfRange {
        draw: String,
        what: &'static str,
        given: String,
        valid: String,
    },
    #[error(
        "draw `{draw}`: index {index} at position {at} is beyond the {vertices} vertices of the buffer"
    )]
    IndexOutOfRange {
        draw: String,
        index: u32,
        at: usize,
        vertices: usize,
    },
    #[error("vertex {vertex} is beyond the {vertices} vertices of the buffer")]
    VertexOutOfRange { vertex: u32, vertices: usize },
    #[error("execution tile of {given} pixels is not supported; valid are 16, 32, 64, 128")]
    TileSize { given: u32 },
    #[error("{given} threads cannot be started: {reason}")]
    Threads { given: usize, reason: String },
    #[error("{what} takes {bytes} bytes, which the system does not give")]
    OutOfMemory { what: String, bytes: u64 },
    #[error(
        "the floating-point unit flushes denormals to zero; results would differ between machines"
    )]
    DenormalsFlushed,
}
