//! The pictures of a scene's surfaces, as textures of a frame.

use std::sync::Arc;

use gnomon_raster::{
    Format, Recording, Subresource, TextureBinding, TextureDescriptor, TextureDimension, TextureId,
};

use crate::technique::TechniqueError;
use crate::world::scene::Scene;
use crate::world::texture::{Picture, SurfaceTexture};

/// Textures of pictures that surfaces have, each once.
#[derive(Default)]
pub(crate) struct SurfaceTextures {
    known: Vec<(Arc<Picture>, TextureId)>,
}

impl SurfaceTextures {
    /// Adds the pictures of a scene to a recording; none for a scene without.
    pub(crate) fn create(scene: &Scene, recording: &mut Recording) -> Result<Self, TechniqueError> {
        let mut own = Self::default();
        let parts = scene.objects.iter().flat_map(|o| &o.parts);
        for texture in parts.filter_map(|p| p.texture.as_ref()) {
            if own.find(&texture.picture).is_none() {
                let id = create(&texture.picture, own.known.len(), recording)?;
                own.known.push((texture.picture.clone(), id));
            }
        }
        Ok(own)
    }

    fn find(&self, picture: &Arc<Picture>) -> Option<TextureId> {
        let same = |(known, _): &&(Arc<Picture>, TextureId)| known == picture;
        self.known.iter().find(same).map(|(_, id)| *id)
    }

    /// A picture with the sampler of a surface.
    pub(crate) fn binding(&self, of: &SurfaceTexture) -> Option<TextureBinding> {
        let texture = self.find(&of.picture)?;
        Some(TextureBinding {
            texture,
            sampler: of.sampler,
        })
    }
}

fn create(
    picture: &Picture,
    number: usize,
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let [width, height] = picture.size();
    let id = recording.create(&TextureDescriptor {
        label: format!("base color {number}"),
        dimension: TextureDimension::D2,
        format: Format::Rgba16Float,
        size: [width, height, 1],
        mip_levels: picture.levels().len() as u32,
    })?;
    for (mip, level) in picture.levels().iter().enumerate() {
        let image = Subresource {
            mip: mip as u32,
            layer: 0,
        };
        recording.write_packed(id, image, level.packed.clone())?;
    }
    Ok(id)
}
