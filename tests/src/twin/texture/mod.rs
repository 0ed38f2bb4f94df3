//! Texture look-ups: `docs/texture-rules.md`, one pixel at a time.

mod axis;
mod cube;
mod detail;
mod fetch;
mod filter;
mod log2;
mod texel;

use gnomon_raster::{Format, Sampler, TextureDimension};

pub(super) use detail::Detail;

use super::case::{DepthImage, TwinCase};
use super::depth::Encoding;
use super::image::{Images, depth_bytes, texel_bytes};

/// A texture that no pass draws into.
#[derive(Clone, Debug)]
pub struct TwinTexture {
    /// Its format.
    pub format: Format,
    /// Its shape.
    pub dimension: TextureDimension,
    /// Width, height and depth of level 0.
    pub size: [u32; 3],
    /// `images[level][layer]`: stored texels, row by row from the top. Raw
    /// channels, or depth as stored and stencil.
    pub images: Vec<Vec<Vec<[u32; 4]>>>,
}

impl TwinTexture {
    /// Width, height and depth of a level.
    #[must_use]
    pub fn level_size(&self, level: usize) -> [u32; 3] {
        self.size.map(|s| (s >> level).max(1))
    }
}

/// What a slot reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureSource {
    /// A texture of the case.
    Texture(usize),
    /// A colour image of the case, as earlier passes left it.
    Color(usize),
    /// The depth-stencil image, as earlier passes left it.
    Depth,
}

/// A texture slot of a draw.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureUse {
    /// What is read.
    pub source: TextureSource,
    /// How it is read.
    pub sampler: Sampler,
}

/// A slot while its draw runs.
pub(super) struct Bound {
    texture: TwinTexture,
    sampler: Sampler,
}

/// A texel that was read: level, layer, column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TexelRead {
    pub(super) level: usize,
    pub(super) layer: usize,
    pub(super) at: [i64; 2],
}

/// A looked-up value, and the texels read for it.
pub(super) type Looked = ([f32; 4], Vec<TexelRead>);

impl Bound {
    pub(super) fn new(case: &TwinCase, images: &Images, used: &TextureUse) -> Self {
        let texture = match used.source {
            TextureSource::Texture(k) => case.textures[k].clone(),
            TextureSource::Color(k) => {
                attachment(case, images.color[k].format, images.color[k].texels.clone())
            }
            TextureSource::Depth => {
                let d = images.depth.as_ref().expect("the case has one");
                let texels = d.depth.iter().zip(&d.stencil);
                let stored = texels.map(|(&d, &s)| [d, u32::from(s), 0, 0]).collect();
                attachment(case, d.format, stored)
            }
        };
        Self {
            texture,
            sampler: used.sampler,
        }
    }

    /// Bytes of a texel; of depth formats, of the depth aspect.
    pub(super) fn bytes(&self) -> u64 {
        let f = self.texture.format;
        if is_depth(f) {
            depth_bytes(f).0
        } else {
            texel_bytes(f)
        }
    }

    /// Number of axes that the texture has.
    fn axes(&self) -> usize {
        match self.texture.dimension {
            TextureDimension::D1 => 1,
            TextureDimension::D2 | TextureDimension::Cube => 2,
            TextureDimension::D3 => 3,
        }
    }

    fn is_cube(&self) -> bool {
        self.texture.dimension == TextureDimension::Cube
    }

    /// A stored texel of a level.
    fn stored(&self, read: TexelRead) -> [u32; 4] {
        let [x, y] = read.at;
        let width = i64::from(self.texture.level_size(read.level)[0]);
        self.texture.images[read.level][read.layer][(y * width + x) as usize]
    }
}

/// An attachment as a texture of one level.
fn attachment(case: &TwinCase, format: Format, texels: Vec<[u32; 4]>) -> TwinTexture {
    TwinTexture {
        format,
        dimension: TextureDimension::D2,
        size: [case.size[0], case.size[1], 1],
        images: vec![vec![texels]],
    }
}

pub(super) fn is_depth(f: Format) -> bool {
    matches!(f, Format::Depth24Stencil8 | Format::Depth32FloatStencil8)
}

/// Depth and stencil of an image of a depth-stencil texture, as they were before being stored.
#[must_use]
pub fn depth_image(format: Format, texels: &[[u32; 4]]) -> DepthImage {
    let encoding = Encoding::of(Some(format));
    DepthImage {
        format,
        depth: texels.iter().map(|t| encoding.decode(t[0])).collect(),
        stencil: texels.iter().map(|t| t[1] as u8).collect(),
    }
}
