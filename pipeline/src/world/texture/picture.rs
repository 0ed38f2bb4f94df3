//! A decoded picture with its mip chain.

use std::fmt;
use std::sync::Arc;

use super::decode;
use super::error::{PictureError, PictureKind};
use super::mips::{self, Level};
use crate::world::memo::Memo;

/// Bytes of a picture's file that are read at most.
pub const MAX_PICTURE_BYTES: u64 = 64 << 20;

/// A picture with its smaller levels: linear light in halves, opaque.
///
/// sRGB is decoded once, so that filters work on light. GPUs keep the eight bits and decode
/// at each look-up; here a texel takes eight bytes instead of four, and is counted so.
pub struct Picture {
    kind: PictureKind,
    /// The hash of its file.
    key: [u8; 32],
    encoded: Arc<[u8]>,
    size: [u32; 2],
    levels: Vec<Level>,
}

impl Picture {
    /// Decodes a file's bytes. Any bytes are accepted or refused, and nothing is decoded
    /// that is too large.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn decode(bytes: &[u8]) -> Result<Self, PictureError> {
        Self::of(bytes, *blake3::hash(bytes).as_bytes())
    }

    fn of(bytes: &[u8], key: [u8; 32]) -> Result<Self, PictureError> {
        let (kind, first) = decode::decode(bytes)?;
        Ok(Self {
            kind,
            key,
            encoded: bytes.into(),
            size: first.size,
            levels: mips::chain(first),
        })
    }

    /// The same of bytes whose hash is `key`, once for equal ones as long as there is room:
    /// frames of an animation read their models again.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub(super) fn kept(bytes: &[u8], key: [u8; 32]) -> Result<Arc<Self>, PictureError> {
        static KEPT: Memo<Picture> = Memo::new(1 << 28);
        if let Some(found) = KEPT.find(&key) {
            return Ok(found);
        }
        let own = Arc::new(Self::of(bytes, key)?);
        let levels: usize = own.levels.iter().map(|l| l.packed.len()).sum();
        KEPT.keep(key, own.clone(), own.encoded.len() + levels);
        Ok(own)
    }

    /// How its file is coded.
    pub fn kind(&self) -> PictureKind {
        self.kind
    }

    /// Its file.
    pub fn encoded(&self) -> &[u8] {
        &self.encoded
    }

    /// Width and height in texels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Levels, the largest first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Texels of the first level.
    pub fn texels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

impl PartialEq for Picture {
    /// Files alone, by their hashes: all else follows from them.
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(f, "Picture({:?} {width}x{height})", self.kind)
    }
}
