//! Textures: block-linear storage shared by attachments and sampled images.

pub(crate) mod layout;
mod mipmap;
mod packed;
mod plane;
mod resource;

pub use layout::BLOCK;
pub(crate) use layout::{Layout, PACKETS};
pub(crate) use packed::{check_packed, pack};
pub(crate) use plane::{Block, Block4, ColorBlocks, DepthPlane, HIZ_STALE, Plane};
pub use resource::{
    ColorTexel, Subresource, Texture, TextureDescriptor, TextureDimension, TextureId,
};
pub(crate) use resource::{image_size, validate};
