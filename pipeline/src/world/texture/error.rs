//! Kinds of pictures, and why bytes are none that can be drawn.

use thiserror::Error;

/// Texels of a picture at most; larger ones are not decoded.
pub const MAX_PICTURE_TEXELS: u64 = 1 << 24;

/// How a picture is coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureKind {
    /// PNG.
    Png,
    /// JPEG.
    Jpeg,
}

impl PictureKind {
    /// The end of a file's name.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
        }
    }

    /// Its media type.
    pub fn mime(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
        }
    }
}

/// Why bytes are no picture that can be drawn.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PictureError {
    /// Another format.
    #[error("is no PNG or JPEG file")]
    Unknown,
    /// Too many texels, or none.
    #[error(
        "has {}x{} texels; valid are sides of at most {} and {MAX_PICTURE_TEXELS} texels in all",
        .size[0], .size[1], gnomon_raster::MAX_TEXTURE_SIZE
    )]
    Size {
        /// Width and height.
        size: [u64; 2],
    },
    /// More texels than are left for it.
    #[error(
        "has more texels than the {left} that are left of {} for all pictures of a file",
        super::MAX_FILE_TEXELS
    )]
    TooMany {
        /// Texels that may still be read.
        left: u64,
    },
    /// Its file is too long.
    #[error(
        "is longer than {} bytes, the most that is read of a picture",
        super::MAX_PICTURE_BYTES
    )]
    TooLong,
    /// More bytes than are left for it.
    #[error(
        "has more bytes than the {left} that are left of {} for all pictures of a file",
        super::MAX_FILE_PICTURE_BYTES
    )]
    TooManyBytes {
        /// Bytes that may still be read.
        left: u64,
    },
    /// The decoder refuses it.
    #[error("cannot be decoded: {0}")]
    Undecodable(String),
}
