//! Occlusion maps that stay from frame to frame: those of pairs that did not move are not
//! drawn again (§6.2.1).

use gnomon_raster::TextureId;

use crate::parts::passes::SceneDraws;
use crate::parts::surface_draw::SurfaceDraw;
use crate::technique::{KeptPictures, PictureKey, PictureToKeep};

/// Bytes of textures whose maps are kept at most; what is beyond is drawn in each frame.
const MOST_BYTES: usize = 256 << 20;

/// Maps of the frame before, and those that the next one may need.
pub(super) struct Keeping<'k> {
    before: &'k KeptPictures,
    /// Of everything that each surface is drawn from, in the order of the draws.
    surfaces: Vec<[u8; 32]>,
    pictures: Vec<PictureToKeep>,
    bytes: usize,
    found: usize,
}

impl<'k> Keeping<'k> {
    pub(super) fn new(before: &'k KeptPictures, draws: &SceneDraws<'_>) -> Self {
        Self {
            before,
            surfaces: draws.surfaces().iter().map(hash_of).collect(),
            pictures: Vec::new(),
            bytes: 0,
            found: 0,
        }
    }

    /// Whether there is room for another texture of so many bytes, which then is taken.
    pub(super) fn takes(&mut self, bytes: usize) -> bool {
        let fits = self.bytes + bytes <= MOST_BYTES;
        self.bytes += if fits { bytes } else { 0 };
        fits
    }

    /// Hash of what a surface is drawn from.
    pub(super) fn surface(&self, number: usize) -> &[u8; 32] {
        &self.surfaces[number]
    }

    /// Keeps a map for the next frame; gives its texels where the frame before had it.
    pub(super) fn keep(
        &mut self,
        key: PictureKey,
        texture: TextureId,
        (at, side): ([u32; 2], u32),
    ) -> (PictureToKeep, Option<&'k [u8]>) {
        let picture = PictureToKeep {
            key,
            texture,
            at,
            side,
        };
        self.pictures.push(picture);
        let rows = self.before.find(&key);
        self.found += usize::from(rows.is_some());
        (picture, rows.map(|rows| &**rows))
    }

    /// Maps that were there.
    pub(super) fn found(&self) -> usize {
        self.found
    }

    /// What the next frame may need.
    pub(super) fn finish(self) -> Vec<PictureToKeep> {
        self.pictures
    }
}

fn hash_of(surface: &SurfaceDraw<'_>) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    let data = &surface.vertices().data;
    hasher.update(&(data.len() as u64).to_le_bytes());
    let bytes: Vec<u8> = data
        .iter()
        .flat_map(|v| v.to_bits().to_le_bytes())
        .collect();
    hasher.update(&bytes);
    let corners = surface.triangles().flatten();
    let bytes: Vec<u8> = corners.flat_map(u32::to_le_bytes).collect();
    hasher.update(&bytes);
    *hasher.finalize().as_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_an_end_to_what_is_kept() {
        let mut keeping = Keeping {
            before: &KeptPictures::default(),
            surfaces: Vec::new(),
            pictures: Vec::new(),
            bytes: 0,
            found: 0,
        };
        let taken = [200, 100, 56, 1].map(|mib| keeping.takes(mib << 20));
        assert_eq!(taken, [true, false, true, false]);
    }
}
