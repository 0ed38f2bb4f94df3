//! Textures of base colours: pictures from files, and where on a mesh they lie.
//!
//! Texture coordinates are those of glTF and of the texture rules: (0, 0) is the corner of
//! the picture's first texel, v goes down its rows. Readers of formats that count v from
//! below turn it round.

mod decode;
mod error;
mod gallery;
mod mips;
mod picture;
mod sample;
mod seams;

use std::sync::Arc;

use gnomon_raster::Sampler;
use gnomon_raster::state::{AddressMode, FilterMode};

pub use error::{MAX_PICTURE_TEXELS, PictureError, PictureKind};
pub use gallery::{Gallery, MAX_FILE_PICTURE_BYTES};
pub use mips::Level;
pub use picture::{MAX_PICTURE_BYTES, Picture};
pub(crate) use seams::split;

/// Texture coordinates of a triangle's corners.
pub type CornerCoordinates = [[f32; 2]; 3];

/// Texels of all different pictures of a file at most, without smaller levels.
pub const MAX_FILE_TEXELS: u64 = 1 << 26;

/// A picture on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceTexture {
    /// The picture.
    pub picture: Arc<Picture>,
    /// How it is read.
    pub sampler: Sampler,
}

impl SurfaceTexture {
    /// Repeated, linear between texels and between levels: what files mean that say nothing.
    pub fn repeated(picture: Arc<Picture>) -> Self {
        Self {
            picture,
            sampler: REPEATED,
        }
    }
}

/// The sampler of [`SurfaceTexture::repeated`].
pub const REPEATED: Sampler = Sampler {
    address: [AddressMode::Repeat; 3],
    mag: FilterMode::Linear,
    min: FilterMode::Linear,
    mip: FilterMode::Linear,
    lod: [0.0, 1000.0],
    lod_bias: 0.0,
    border: [0.0; 4],
};

/// Coordinates of triangles whose second and third corners changed places, as
/// [`Shape::transformed`](crate::world::shape::Shape::transformed) does where it mirrors.
pub(crate) fn turned_round(coordinates: &mut [CornerCoordinates]) {
    coordinates.iter_mut().for_each(|c| c.swap(1, 2));
}
