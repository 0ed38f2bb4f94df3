//! Base colours from textures: which picture, how it is read, and where it lies.

use std::collections::BTreeMap;
use std::sync::Arc;

use gnomon_raster::Sampler;
use gnomon_raster::state::{AddressMode, FilterMode};

use super::buffers::Buffers;
use super::error::{Checked, GltfProblem, element};
use super::notes::Notes;
use super::schema::{Attributes, Root, TextureOfMaterial, TextureSampler, TextureTransform};
use crate::world::texture::{
    CornerCoordinates, Gallery, MAX_PICTURE_BYTES, Picture, REPEATED, SurfaceTexture,
};

/// Bytes of all pictures of a file that are looked at, equal ones too: a file may say a
/// hundred thousand times that one is in a view.
const MAX_LOOKED_AT: u64 = 1 << 30;

/// Pictures of a file, each read once.
pub(super) struct Pictures<'a> {
    known: BTreeMap<usize, Option<Arc<Picture>>>,
    gallery: &'a mut Gallery,
    /// Bytes that may still be looked at.
    left: u64,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(gallery: &'a mut Gallery) -> Self {
        Self {
            known: BTreeMap::new(),
            gallery,
            left: MAX_LOOKED_AT,
        }
    }

    /// The texture of a material's base colour. Numbers that mean nothing are errors; a
    /// picture that cannot be used is noted, for a model without its paint is still a model.
    pub(super) fn texture(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        of: &TextureOfMaterial,
        notes: &mut Notes,
        place: &str,
    ) -> Checked<Option<SurfaceTexture>> {
        let texture = element(&root.textures, of.index, "textures", place)?;
        let place = format!("textures[{}]", of.index);
        let sampler = match texture.sampler {
            Some(number) => sampler(element(&root.samplers, number, "samplers", &place)?),
            None => REPEATED,
        };
        let Some(image) = texture.source else {
            // Of a format that an extension brings.
            (notes.missing_maps).add(|| format!("{place}: source is missing"));
            return Ok(None);
        };
        let known = match self.known.get(&image) {
            Some(known) => known.clone(),
            None => {
                let read = self.read(root, buffers, image, &place)?;
                let read = read.map_err(|why| {
                    notes.missing_maps.add(|| format!("images[{image}]: {why}"));
                });
                self.known.insert(image, read.clone().ok());
                read.ok()
            }
        };
        Ok(known.map(|picture| SurfaceTexture { picture, sampler }))
    }

    fn read(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        number: usize,
        place: &str,
    ) -> Checked<Result<Arc<Picture>, String>> {
        let image = element(&root.images, number, "images", place)?;
        let place = format!("images[{number}]");
        let named = |why: String| match &image.uri {
            Some(uri) if !uri.starts_with("data:") => {
                format!("'{}' {why}", crate::world::tally::beginning(uri, 80))
            }
            _ => why,
        };
        let limit = MAX_PICTURE_BYTES.min(self.left);
        let read: Vec<u8>;
        let bytes = match (image.buffer_view, &image.uri) {
            (Some(view), _) => buffers.view(view, &place)?.0,
            (None, Some(uri)) => match buffers.picture(uri, limit) {
                Ok(bytes) => {
                    read = bytes;
                    &read
                }
                Err(problem) => return Ok(Err(named(problem.to_string()))),
            },
            (None, None) => {
                let what = "uri or bufferView";
                return Err(GltfProblem::Missing { what }.at(place));
            }
        };
        let length = bytes.len() as u64;
        if length > limit {
            let why = format!("has {length} bytes; valid are at most {limit}");
            return Ok(Err(named(why)));
        }
        self.left -= length;
        Ok((self.gallery.picture(bytes)).map_err(|e| named(e.to_string())))
    }
}

/// Unknown numbers are those of a file that gives none.
fn sampler(of: &TextureSampler) -> Sampler {
    let address = |wrap| match wrap {
        Some(33071) => AddressMode::ClampToEdge,
        Some(33648) => AddressMode::MirrorRepeat,
        _ => AddressMode::Repeat,
    };
    let (min, mip, levels) = match of.min_filter {
        Some(9728) => (FilterMode::Nearest, FilterMode::Nearest, false),
        Some(9729) => (FilterMode::Linear, FilterMode::Nearest, false),
        Some(9984) => (FilterMode::Nearest, FilterMode::Nearest, true),
        Some(9985) => (FilterMode::Linear, FilterMode::Nearest, true),
        Some(9986) => (FilterMode::Nearest, FilterMode::Linear, true),
        _ => (FilterMode::Linear, FilterMode::Linear, true),
    };
    Sampler {
        address: [address(of.wrap_s), address(of.wrap_t), AddressMode::Repeat],
        mag: match of.mag_filter {
            Some(9728) => FilterMode::Nearest,
            _ => FilterMode::Linear,
        },
        min,
        mip,
        lod: [0.0, if levels { 1000.0 } else { SMALLEST }],
        ..REPEATED
    }
}

/// A level of detail above 0, so that what is made smaller is filtered with `min`, and of
/// the first level all the same.
pub(crate) const SMALLEST: f32 = 0.25;

/// The accessor of texture coordinates `set`.
pub(super) fn accessor(attributes: &Attributes, set: usize) -> Option<usize> {
    let sets = [
        attributes.first,
        attributes.second,
        attributes.third,
        attributes.fourth,
    ];
    sets.get(set).copied().flatten()
}

/// Which set of coordinates a texture is for.
pub(super) fn set(of: &TextureOfMaterial) -> usize {
    let transform = of.extensions.transform.as_ref();
    transform.and_then(|t| t.tex_coord).unwrap_or(of.tex_coord)
}

/// Moves coordinates as `KHR_texture_transform` says: scaled, turned, moved.
pub(super) fn transform(of: &TextureTransform, triangle: &mut CornerCoordinates) {
    let (sin, cos) = (libm::sin(of.rotation), libm::cos(of.rotation));
    for at in triangle {
        let [u, v] = [0, 1].map(|k| f64::from(at[k]) * of.scale[k]);
        let turned = [u * cos + v * sin, v * cos - u * sin];
        *at = [0, 1].map(|k| (turned[k] + of.offset[k]) as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samplers_are_those_of_the_format() {
        let of = |min, wrap| {
            sampler(&TextureSampler {
                min_filter: min,
                wrap_s: wrap,
                ..TextureSampler::default()
            })
        };
        assert_eq!(of(None, None), REPEATED);
        assert_eq!(of(Some(9987), Some(10497)), REPEATED);
        let nearest = of(Some(9728), Some(33071));
        assert_eq!(nearest.address[0], AddressMode::ClampToEdge);
        assert_eq!(nearest.address[1], AddressMode::Repeat);
        assert!(nearest.min == FilterMode::Nearest && nearest.lod[1] < 0.5);
        assert_eq!(of(None, Some(33648)).address[0], AddressMode::MirrorRepeat);
        assert_eq!(of(Some(9985), None).mip, FilterMode::Nearest);
    }

    /// By the matrices of the extension: a quarter turn takes (1, 0) to (0, -1).
    #[test]
    fn coordinates_are_scaled_then_turned_then_moved() {
        let mut triangle = [[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]];
        let of = TextureTransform {
            offset: [0.25, 0.5],
            rotation: std::f64::consts::FRAC_PI_2,
            scale: [2.0, 4.0],
            tex_coord: None,
        };
        transform(&of, &mut triangle);
        let expected = [[0.25, -1.5], [4.25, 0.5], [2.25, -0.5]];
        for (a, b) in triangle.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 1e-6, "{triangle:?}");
        }
    }
}
