//! Fixed-function state as plain data, in WebGPU's and Vulkan's vocabulary.
//!
//! Every type is `Copy` or cheap to clone, has a default that switches its stage
//! off, and named presets for what shadow algorithms use.

mod blend;
mod depth_stencil;
mod primitive;
mod sampler;

pub use blend::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
};
pub use depth_stencil::{
    CompareFunction, DepthBias, DepthState, DepthStencilState, StencilFaceState, StencilOperation,
    StencilState,
};
pub use primitive::{
    CullMode, FrontFace, PrimitiveState, PrimitiveTopology, ScissorRect, Viewport,
};
pub use sampler::{AddressMode, FilterMode, Sampler};
