//! Textures: block-linear storage shared by attachments and sampled images.

mod address;
mod cube;
mod fetch;
pub(crate) mod layout;
mod lod;
mod mipmap;
mod packed;
mod plane;
mod resource;
mod sample;
#[cfg(test)]
mod twin;

pub use layout::BLOCK;
pub(crate) use layout::Layout;
pub(crate) use packed::{check_packed, pack};
pub(crate) use plane::{Block, Block4, ColorBlocks, DepthPlane, HIZ_STALE, Plane};
pub use resource::{
    ColorTexel, Subresource, Texture, TextureDescriptor, TextureDimension, TextureId,
};
pub(crate) use resource::{encode, encode_depth, image_size, validate};
