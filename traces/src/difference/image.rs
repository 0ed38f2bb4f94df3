//! An aspect of an image, in rows from the top, whatever its format.

use gnomon_raster::{Error, Gpu, Subresource, TextureId};

/// What of an image is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aspect {
    Color,
    Depth,
    Stencil,
}

impl Aspect {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Stencil => "stencil",
        }
    }
}

/// Raw texels; depth and stencil are the first channel.
pub(super) struct Image {
    width: u32,
    texels: Vec<[u32; 4]>,
}

impl Image {
    pub(super) fn read(
        gpu: &Gpu,
        id: TextureId,
        image: Subresource,
        aspect: Aspect,
    ) -> Result<Self, Error> {
        let texture = gpu.texture(id)?;
        let wide = |v: u32| [v, 0, 0, 0];
        let texels = match aspect {
            Aspect::Color => texture.read_raw(image)?,
            Aspect::Depth => {
                let depths = texture.read_depth_bits(image)?.into_iter();
                depths.map(wide).collect()
            }
            Aspect::Stencil => {
                let stencils = texture.read_stencil(image)?.into_iter();
                stencils.map(|s| wide(s.into())).collect()
            }
        };
        let [width, ..] = texture.mip_size(image.mip);
        Ok(Self { width, texels })
    }

    pub(super) fn at(&self, [x, y]: [u32; 2]) -> [u32; 4] {
        self.texels[(y * self.width + x) as usize]
    }

    /// Pixels that differ from those of `other`, with what both hold.
    pub(super) fn differing<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = ([u32; 2], [[u32; 4]; 2])> + 'a {
        let pairs = self.texels.iter().zip(&other.texels).enumerate();
        let differing = pairs.filter(|(_, (a, b))| a != b);
        differing.map(|(at, (a, b))| {
            let pixel = [at as u32 % self.width, at as u32 / self.width];
            (pixel, [*a, *b])
        })
    }
}
