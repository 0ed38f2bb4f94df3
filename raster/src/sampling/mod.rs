//! Texture look-ups: the arithmetic of `docs/texture-rules.md`, over the storage of
//! [`crate::texture`].

mod address;
mod cube;
mod fetch;
mod lod;
mod log;
mod sample;

pub(crate) use fetch::{Aspect, NO_WORDS};
pub(crate) use lod::Detail;
pub(crate) use log::{SlotLog, TexelLog};
pub(crate) use sample::{decode_fetched, fetch_words, look_up};

use crate::state::Sampler;
use crate::texture::Texture;

/// A texture and sampler while a pass is executed.
pub(crate) struct BoundTexture<'a> {
    pub(crate) texture: &'a Texture,
    pub(crate) sampler: Sampler,
}
