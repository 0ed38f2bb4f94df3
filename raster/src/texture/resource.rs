//! Textures as the API shows them.

use super::plane::{ColorBlocks, DepthPlane, Plane};
use super::{HIZ_STALE, Layout};
use crate::error::Error;
use crate::format::{self, Format, decode, encode, encode_depth};
use crate::memory::collected;
use crate::{MAX_TEXTURE_BYTES, MAX_TEXTURE_SIZE};

/// Names a texture of a [`crate::Gpu`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub(crate) u32);

impl TextureId {
    /// Its place among the textures of its GPU or recording, in the order of their
    /// creation.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Shape of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureDimension {
    /// width × 1.
    D1,
    /// width × height.
    D2,
    /// width × height × depth, filtered in all three.
    D3,
    /// Six square faces: +x, −x, +y, −y, +z, −z.
    Cube,
}

/// What to create.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureDescriptor {
    /// Shown in errors and reports.
    pub label: String,
    /// Shape.
    pub dimension: TextureDimension,
    /// Texel format.
    pub format: Format,
    /// Width, height, depth of level 0 in texels; the third is 1 but for `D3`.
    pub size: [u32; 3],
    /// Mip levels, at least 1; level k has sizes `max(1, size >> k)`.
    pub mip_levels: u32,
}

impl TextureDescriptor {
    /// A two-dimensional image with one level.
    #[must_use]
    pub fn d2(label: &str, format: Format, width: u32, height: u32) -> Self {
        Self {
            label: label.to_owned(),
            dimension: TextureDimension::D2,
            format,
            size: [width, height, 1],
            mip_levels: 1,
        }
    }

    /// All images of such a texture, level by level.
    pub fn images(&self) -> impl Iterator<Item = Subresource> {
        (0..self.mip_levels).flat_map(|mip| {
            let (_, layers) = level(self, mip);
            (0..layers).map(move |layer| Subresource { mip, layer })
        })
    }
}

/// One two-dimensional image of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Subresource {
    /// Mip level.
    pub mip: u32,
    /// Cube face, or slice of a 3D texture.
    pub layer: u32,
}

/// A decoded colour texel; channels that the format lacks are 0, alpha 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorTexel(pub [f32; 4]);

/// A texture and its storage.
#[derive(Clone)]
pub struct Texture {
    pub(crate) desc: TextureDescriptor,
    /// `layouts[mip]`.
    pub(crate) layouts: Vec<Layout>,
    /// `planes[mip][layer]`.
    pub(crate) planes: Vec<Vec<Plane>>,
}

impl Texture {
    pub(crate) fn new(desc: &TextureDescriptor) -> Result<Self, Error> {
        validate(desc)?;
        let mut layouts = Vec::new();
        let mut planes = Vec::new();
        for mip in 0..desc.mip_levels {
            let (layout, layers) = level(desc, mip);
            layouts.push(layout);
            let image = || Plane::new(desc.format, &layout, || storage_name(desc));
            planes.push((0..layers).map(|_| image()).collect::<Result<_, _>>()?);
        }
        Ok(Self {
            desc: desc.clone(),
            layouts,
            planes,
        })
    }

    /// A texel of a plain image of four floats, zero outside; `None` for others, and where
    /// a number is none: those have their canonical bits.
    #[inline]
    pub(crate) fn plain_texel(&self, [x, y]: [u32; 2]) -> Option<[f32; 4]> {
        let [w, h, _] = self.desc.size;
        let plain = self.desc.dimension == TextureDimension::D2;
        if !plain || self.desc.format != Format::Rgba32Float || x >= w || y >= h {
            return None;
        }
        let Some(Plane::Color(ColorBlocks::B32x4(blocks))) = self.planes[0].first() else {
            return None;
        };
        let (block, place) = self.layouts[0].locate(x, y);
        let [r, g, b, a] = &blocks[block].0;
        let texel = [r[place], g[place], b[place], a[place]].map(f32::from_bits);
        (!texel.iter().any(|c| c.is_nan())).then_some(texel)
    }

    /// What it was created from.
    #[must_use]
    pub fn descriptor(&self) -> &TextureDescriptor {
        &self.desc
    }

    /// Width, height and depth (or 1) of level `mip` in texels.
    #[must_use]
    #[inline]
    pub fn mip_size(&self, mip: u32) -> [u32; 3] {
        mip_size(&self.desc, mip)
    }

    pub(crate) fn check_subresource(&self, s: Subresource) -> Result<(), Error> {
        image_size(&self.desc, s).map(|_| ())
    }

    pub(crate) fn color(&self, s: Subresource) -> Result<&ColorBlocks, Error> {
        self.check_subresource(s)?;
        match &self.planes[s.mip as usize][s.layer as usize] {
            Plane::Color(c) => Ok(c),
            _ => Err(self.wrong_aspect("color")),
        }
    }

    pub(crate) fn depth(&self, s: Subresource) -> Result<&DepthPlane, Error> {
        self.check_subresource(s)?;
        match &self.planes[s.mip as usize][s.layer as usize] {
            Plane::Depth(d) => Ok(d),
            _ => Err(self.wrong_aspect("depth")),
        }
    }

    /// What `texel` gives for each pixel's block and place in it, rows from the top.
    fn read<T>(
        &self,
        s: Subresource,
        texel: impl Fn((usize, usize)) -> T,
    ) -> Result<Vec<T>, Error> {
        let l = &self.layouts[s.mip as usize];
        let n = l.width as usize * l.height as usize;
        let texels = pixels(l).map(|(x, y)| texel(l.locate(x, y)));
        collected(texels, n, || {
            format!("a copy of the texels of `{}`", self.desc.label)
        })
    }

    fn wrong_aspect(&self, wanted: &'static str) -> Error {
        Error::WrongAspect {
            texture: self.desc.label.clone(),
            format: self.desc.format,
            wanted,
        }
    }

    /// Raw channel bits of every texel of a colour image, row by row from the
    /// top: unorm bytes, half bits, float bits or integers.
    ///
    /// # Errors
    /// Where the subresource does not exist or is not colour, or memory is short.
    pub fn read_raw(&self, s: Subresource) -> Result<Vec<[u32; 4]>, Error> {
        let blocks = self.color(s)?;
        self.read(s, |at| blocks.get(self.desc.format, at))
    }

    /// Decoded texels, row by row from the top. Integers become floats.
    ///
    /// # Errors
    /// Where the subresource does not exist or is not colour, or memory is short.
    pub fn read_color(&self, s: Subresource) -> Result<Vec<ColorTexel>, Error> {
        let (blocks, f) = (self.color(s)?, self.desc.format);
        self.read(s, |at| ColorTexel(decode(f, blocks.get(f, at))))
    }

    /// The first image in eight bits, row by row from the top, as a shader's output is
    /// stored in `Rgba8Unorm`: values outside 0..=1 are cut off, channels that the format
    /// lacks are 0, alpha 1.
    ///
    /// # Errors
    /// Where the texture is not colour, or memory is short.
    pub fn read_rgba8(&self) -> Result<Vec<[u8; 4]>, Error> {
        let image = Subresource::default();
        let (blocks, f) = (self.color(image)?, self.desc.format);
        self.read(image, |at| {
            let rgba = decode(f, blocks.get(f, at));
            encode(Format::Rgba8Unorm, rgba).map(|channel| channel as u8)
        })
    }

    /// Depth of every pixel in 0..=1, row by row from the top.
    ///
    /// # Errors
    /// Where the subresource does not exist or has no depth, or memory is short.
    pub fn read_depth(&self, s: Subresource) -> Result<Vec<f32>, Error> {
        let float = self.desc.format == Format::Depth32FloatStencil8;
        let plane = self.depth(s)?;
        self.read(s, |(b, i)| match plane.depth[b].0[i] {
            bits if float => f32::from_bits(bits),
            bits => format::f32_from_d24(bits),
        })
    }

    /// Stored depth of every pixel: the D24 integer, or the float's bits.
    ///
    /// # Errors
    /// Where the subresource does not exist or has no depth, or memory is short.
    pub fn read_depth_bits(&self, s: Subresource) -> Result<Vec<u32>, Error> {
        let plane = self.depth(s)?;
        self.read(s, |(b, i)| plane.depth[b].0[i])
    }

    /// Stencil of every pixel, row by row from the top.
    ///
    /// # Errors
    /// Where the subresource does not exist or has no stencil, or memory is short.
    pub fn read_stencil(&self, s: Subresource) -> Result<Vec<u8>, Error> {
        let plane = self.depth(s)?;
        self.read(s, |(b, i)| plane.stencil[b].0[i])
    }

    /// Replaces a colour image; values are converted as a shader's output would
    /// be. `texels` are rows from the top.
    ///
    /// # Errors
    /// Where the subresource does not exist, is not colour, or `texels` has the
    /// wrong length.
    pub fn write_color(&mut self, s: Subresource, texels: &[[f32; 4]]) -> Result<(), Error> {
        let f = self.desc.format;
        self.write_with(s, texels.len(), |i| encode(f, texels[i]))
    }

    /// Replaces a colour image by raw channel bits, as [`Texture::read_raw`] gives them.
    ///
    /// # Errors
    /// As [`Texture::write_color`].
    pub fn write_raw(&mut self, s: Subresource, texels: &[[u32; 4]]) -> Result<(), Error> {
        self.write_with(s, texels.len(), |i| texels[i])
    }

    fn write_with(
        &mut self,
        s: Subresource,
        len: usize,
        texel: impl Fn(usize) -> [u32; 4],
    ) -> Result<(), Error> {
        self.color(s)?;
        let l = self.layouts[s.mip as usize];
        let expected = l.width as usize * l.height as usize;
        if len != expected {
            return Err(Error::TexelCount {
                texture: self.desc.label.clone(),
                given: len,
                expected,
            });
        }
        let Plane::Color(blocks) = &mut self.planes[s.mip as usize][s.layer as usize] else {
            unreachable!("checked")
        };
        for (i, (x, y)) in pixels(&l).enumerate() {
            blocks.set(self.desc.format, l.locate(x, y), texel(i));
        }
        Ok(())
    }

    /// Replaces depth (0..=1) and stencil of an image, rows from the top.
    ///
    /// # Errors
    /// Where the subresource does not exist or has no depth, or a length is wrong.
    pub fn write_depth_stencil(
        &mut self,
        s: Subresource,
        depth: &[f32],
        stencil: &[u8],
    ) -> Result<(), Error> {
        self.depth(s)?;
        let l = self.layouts[s.mip as usize];
        let expected = l.width as usize * l.height as usize;
        for given in [depth.len(), stencil.len()] {
            if given != expected {
                return Err(Error::TexelCount {
                    texture: self.desc.label.clone(),
                    given,
                    expected,
                });
            }
        }
        let f = self.desc.format;
        let Plane::Depth(plane) = &mut self.planes[s.mip as usize][s.layer as usize] else {
            unreachable!("checked")
        };
        for (i, (x, y)) in pixels(&l).enumerate() {
            let (b, k) = l.locate(x, y);
            plane.depth[b].0[k] = encode_depth(f, depth[i]);
            plane.stencil[b].0[k] = stencil[i];
            [plane.hiz.min[b], plane.hiz.max[b]] = HIZ_STALE;
        }
        Ok(())
    }
}

/// How an error names the storage of a texture.
fn storage_name(desc: &TextureDescriptor) -> String {
    let [w, h, d] = desc.size;
    let depth = if d == 1 {
        String::new()
    } else {
        format!("×{d}")
    };
    format!(
        "an image of texture `{}` ({w}×{h}{depth}, {:?})",
        desc.label, desc.format
    )
}

/// Every pixel, row by row from the top.
pub(super) fn pixels(l: &Layout) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (w, h) = (l.width, l.height);
    (0..h).flat_map(move |y| (0..w).map(move |x| (x, y)))
}

#[inline]
fn mip_size(desc: &TextureDescriptor, mip: u32) -> [u32; 3] {
    // Not `map`, which is a call of its own in the code of a wide level.
    let [w, h, d] = desc.size;
    let mip = mip.min(31);
    [(w >> mip).max(1), (h >> mip).max(1), (d >> mip).max(1)]
}

/// Layout of the images of a level, and their number.
fn level(desc: &TextureDescriptor, mip: u32) -> (Layout, u32) {
    let [w, h, d] = mip_size(desc, mip);
    let layers = if desc.dimension == TextureDimension::Cube {
        6
    } else {
        d
    };
    (Layout::new(w, h), layers)
}

/// Width and height of image `s`, where there is one.
pub(crate) fn image_size(desc: &TextureDescriptor, s: Subresource) -> Result<[u32; 2], Error> {
    let (layout, layers) = level(desc, s.mip);
    let layers = if s.mip < desc.mip_levels { layers } else { 0 };
    if s.layer < layers {
        return Ok([layout.width, layout.height]);
    }
    Err(Error::NoSuchSubresource {
        texture: desc.label.clone(),
        subresource: s,
        mip_levels: desc.mip_levels,
        layers: layers as usize,
    })
}

/// Bytes of all levels with their padding, zmin/zmax left out.
fn storage_bytes(desc: &TextureDescriptor) -> u64 {
    let texel = if desc.format.is_depth_stencil() {
        5
    } else {
        desc.format.bytes()
    };
    let texels = |mip| {
        let (layout, layers) = level(desc, mip);
        64 * layout.blocks() as u64 * u64::from(layers)
    };
    texel * (0..desc.mip_levels).map(texels).sum::<u64>()
}

/// Whether such a texture is possible.
pub(crate) fn validate(desc: &TextureDescriptor) -> Result<(), Error> {
    let [w, h, d] = desc.size;
    let bad = |reason: String| {
        Err(Error::InvalidTexture {
            texture: desc.label.clone(),
            size: desc.size,
            reason,
        })
    };
    if w == 0 || h == 0 || d == 0 {
        return bad("every size must be at least 1".into());
    }
    if w.max(h).max(d) > MAX_TEXTURE_SIZE {
        return bad(format!("the limit is {MAX_TEXTURE_SIZE}"));
    }
    let largest = if desc.dimension == TextureDimension::D3 {
        w.max(h).max(d)
    } else {
        w.max(h)
    };
    let levels = 32 - largest.leading_zeros();
    if desc.mip_levels == 0 || desc.mip_levels > levels {
        return bad(format!(
            "{} mip levels asked for, valid is 1..={levels}",
            desc.mip_levels
        ));
    }
    match desc.dimension {
        TextureDimension::D1 if h != 1 || d != 1 => {
            bad("a 1D texture has height and depth 1".into())
        }
        TextureDimension::D2 if d != 1 => bad("a 2D texture has depth 1".into()),
        TextureDimension::Cube if w != h || d != 1 => {
            bad("a cube map has square faces and depth 1".into())
        }
        TextureDimension::D3 if desc.format.is_depth_stencil() => {
            bad("a 3D texture cannot be depth-stencil".into())
        }
        _ => match storage_bytes(desc) {
            0..=MAX_TEXTURE_BYTES => Ok(()),
            bytes => bad(format!(
                "its storage takes {bytes} bytes, the limit is {MAX_TEXTURE_BYTES}"
            )),
        },
    }
}
