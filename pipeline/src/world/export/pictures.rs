//! The pictures of a scene's surfaces, each once.

use std::sync::Arc;

use super::Exporting;
use crate::world::texture::{Picture, REPEATED, SurfaceTexture};

/// All pictures of the objects, in the order of their first use.
pub(super) fn pictures(objects: &[Exporting<'_>]) -> Vec<Arc<Picture>> {
    let mut all: Vec<Arc<Picture>> = Vec::new();
    for texture in textures(objects) {
        if number(&all, &texture.picture).is_none() {
            all.push(texture.picture.clone());
        }
    }
    all
}

/// The number of a picture among all.
pub(super) fn number(all: &[Arc<Picture>], picture: &Arc<Picture>) -> Option<usize> {
    all.iter().position(|p| p == picture)
}

fn textures<'a>(objects: &'a [Exporting<'_>]) -> impl Iterator<Item = &'a SurfaceTexture> {
    let parts = objects.iter().flat_map(|o| &o.object.parts);
    parts.filter_map(|p| p.texture.as_ref())
}

/// How many textures are read in a way that OBJ has no words for.
pub(super) fn other_samplers(objects: &[Exporting<'_>]) -> usize {
    let plain = |t: &&SurfaceTexture| t.sampler == REPEATED || t.sampler == clamped();
    textures(objects).filter(|t| !plain(t)).count()
}

/// The sampler that `-clamp on` means.
fn clamped() -> gnomon_raster::Sampler {
    gnomon_raster::Sampler {
        address: [gnomon_raster::AddressMode::ClampToEdge; 3],
        ..REPEATED
    }
}

/// The file of picture `k`.
pub(super) fn file(name: &str, k: usize, picture: &Picture) -> String {
    format!("{name}-{k}.{}", picture.kind().extension())
}
