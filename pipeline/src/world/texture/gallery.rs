//! The pictures of a file, or of a scene with all that it names, and what they may add up to.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::error::PictureError;
use super::picture::{MAX_PICTURE_BYTES, Picture};
use super::{MAX_FILE_TEXELS, decode};

/// Bytes of all different pictures of a file at most, as they are coded.
pub const MAX_FILE_PICTURE_BYTES: u64 = 256 << 20;

/// Pictures by what is in them, equal ones once. All that is read into one gallery has the
/// limits of one file together: a scene may name any number of models.
#[derive(Debug)]
pub struct Gallery {
    known: BTreeMap<[u8; 32], Arc<Picture>>,
    /// Texels that may still be decoded.
    texels: u64,
    /// Bytes that may still be kept.
    bytes: u64,
}

impl Default for Gallery {
    fn default() -> Self {
        Self {
            known: BTreeMap::new(),
            texels: MAX_FILE_TEXELS,
            bytes: MAX_FILE_PICTURE_BYTES,
        }
    }
}

impl Gallery {
    /// The picture of a file's bytes; they are copied if it is a new one.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub(crate) fn picture(&mut self, encoded: &[u8]) -> Result<Arc<Picture>, PictureError> {
        let length = encoded.len() as u64;
        if length > MAX_PICTURE_BYTES {
            return Err(PictureError::TooLong);
        }
        let texels = decode::texels(encoded)?;
        let key = *blake3::hash(encoded).as_bytes();
        if let Some(known) = self.known.get(&key) {
            return Ok(known.clone());
        }
        let left = self.bytes.checked_sub(length);
        let bytes = left.ok_or(PictureError::TooManyBytes { left: self.bytes })?;
        let left = self.texels.checked_sub(texels);
        let texels = left.ok_or(PictureError::TooMany { left: self.texels })?;
        (self.bytes, self.texels) = (bytes, texels);
        let picture = Picture::kept(encoded, key)?;
        self.known.insert(key, picture.clone());
        Ok(picture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(width: u32, grey: u8) -> Vec<u8> {
        let image = image::GrayImage::from_pixel(width, 1, image::Luma([grey]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    /// However many copies a file or a scene has, one is decoded; others are charged.
    #[test]
    fn equal_pictures_are_one_and_different_ones_add_up() {
        let (first, second) = (png(4, 1), png(5, 2));
        let mut gallery = Gallery {
            texels: 8,
            bytes: 1000,
            ..Gallery::default()
        };
        let one = gallery.picture(&first).unwrap();
        assert!(Arc::ptr_eq(&one, &gallery.picture(&first).unwrap()));
        assert_eq!(gallery.texels, 4);
        assert_eq!(gallery.bytes, 1000 - first.len() as u64);
        let refused = gallery.picture(&second).unwrap_err();
        assert_eq!(refused, PictureError::TooMany { left: 4 });
        gallery.bytes = 3;
        let refused = gallery.picture(&second).unwrap_err();
        assert_eq!(refused, PictureError::TooManyBytes { left: 3 });
        assert!(gallery.picture(&first).is_ok(), "it is there already");
        let long = vec![0; MAX_PICTURE_BYTES as usize + 1];
        assert_eq!(gallery.picture(&long), Err(PictureError::TooLong));
    }
}
