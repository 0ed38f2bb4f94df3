//! The emulated GPU: a tiled, SIMD, bit-exact, traffic-counting rasteriser.


mod command;
mod counters;
mod error;
pub mod format;
mod observer;
pub mod shader;
pub mod simd;
pub mod state;
pub mod texture;

pub use command::*;
pub use counters::*;
pub use error::Error;
pub use format::Format;
pub use observer::{AccessObserver, BlockAccess};
pub use simd::{F32, I32, LANES, Lanes, Mask, SimdLevel, U32};
pub use texture::{Subresource, Texture, TextureDescriptor, TextureDimension, TextureId};

/// Most colour attachments of a render pass.
pub const MAX_COLOR_ATTACHMENTS: usize = 4;
/// Most varyings of a vertex shader.
pub const MAX_VARYINGS: usize = 16;
/// Most texture slots of a draw.
pub const MAX_TEXTURES: usize = 8;
/// Most user clip planes.
pub const MAX_CLIP_PLANES: usize = 6;
/// Largest width, height or depth of a texture, in texels.
pub const MAX_TEXTURE_SIZE: u32 = 8192;
