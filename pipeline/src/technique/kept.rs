//! What a frame of an animation leaves for the next one.
//!
//! A picture is known by everything that it was drawn from. Where the next frame would
//! draw it from the same again, its texels are there already: fewer draws, equal bits. The
//! same with what a technique works out before it draws.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use gnomon_raster::TextureId;

/// Hash of everything that a picture was drawn from.
pub type PictureKey = [u8; 32];

/// What the frame before left: pictures, and what its technique worked out; nothing before
/// the first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeptPictures {
    pictures: BTreeMap<PictureKey, Arc<[u8]>>,
    /// What the technique worked out.
    pub work: KeptWork,
}

/// What a technique worked out on the CPU for a frame, and may find again in the next one.
/// Its kind is known to the technique alone.
#[derive(Clone, Default)]
pub struct KeptWork(Option<Arc<dyn Any + Send + Sync>>);

impl KeptWork {
    /// Keeps `work`.
    pub fn of<T: Any + Send + Sync>(work: T) -> Self {
        Self(Some(Arc::new(work)))
    }

    /// What was kept, if it is a `T`.
    #[must_use]
    pub fn find<T: Any + Send + Sync>(&self) -> Option<&T> {
        self.0.as_ref()?.downcast_ref()
    }
}

impl PartialEq for KeptWork {
    /// The very same.
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

impl fmt::Debug for KeptWork {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() {
            "KeptWork"
        } else {
            "nothing"
        })
    }
}

/// A square of a colour texture, at mip 0, layer 0, that the next frame may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureToKeep {
    /// What it was drawn from.
    pub key: PictureKey,
    /// Where it is when the frame is done.
    pub texture: TextureId,
    /// First column and row.
    pub at: [u32; 2],
    /// Texels along a side.
    pub side: u32,
}

impl KeptPictures {
    /// Texels of a picture, packed row after row.
    #[must_use]
    pub fn find(&self, key: &PictureKey) -> Option<&Arc<[u8]>> {
        self.pictures.get(key)
    }

    /// Keeps a picture, as packed rows.
    pub fn keep(&mut self, key: PictureKey, rows: Arc<[u8]>) {
        self.pictures.insert(key, rows);
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pictures.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pictures.is_empty()
    }
}

impl PictureToKeep {
    /// The picture's rows out of an image of `width` texels a row and `texel` bytes each.
    #[must_use]
    pub fn cut(&self, image: &[u8], width: u32, texel: u32) -> Arc<[u8]> {
        let rows = (0..self.side).flat_map(|row| &image[self.row(row, width, texel)]);
        rows.copied().collect()
    }

    /// Puts rows where the picture is in such an image.
    pub fn paste(&self, rows: &[u8], image: &mut [u8], width: u32, texel: u32) {
        let own = rows.chunks_exact((self.side * texel) as usize);
        for (row, bytes) in (0..self.side).zip(own) {
            image[self.row(row, width, texel)].copy_from_slice(bytes);
        }
    }

    fn row(&self, row: u32, width: u32, texel: u32) -> std::ops::Range<usize> {
        let first = (self.at[1] + row) as usize * width as usize + self.at[0] as usize;
        let size = texel as usize;
        first * size..(first + self.side as usize) * size
    }
}

#[cfg(test)]
mod tests {
    use gnomon_raster::{Format, Recording, TextureDescriptor};

    use super::*;

    #[test]
    fn what_is_cut_out_is_put_back_where_it_was() {
        let image: Vec<u8> = (0..4 * 3 * 2).collect();
        let descriptor = TextureDescriptor::d2("image", Format::R16Float, 4, 3);
        let picture = PictureToKeep {
            key: [0; 32],
            texture: Recording::default().create(&descriptor).unwrap(),
            at: [1, 1],
            side: 2,
        };
        let rows = picture.cut(&image, 4, 2);
        assert_eq!(*rows, [10, 11, 12, 13, 18, 19, 20, 21]);
        let mut other = vec![0; image.len()];
        picture.paste(&rows, &mut other, 4, 2);
        assert_eq!(other[10..14], [10, 11, 12, 13]);
        assert_eq!(other.iter().filter(|b| **b != 0).count(), 8);
    }
}
