//! Images as bytes: exactly what is stored, rows from the top.
//!
//! A colour texel takes its format's bytes, little-endian, red first. A
//! depth-stencil image is its depth plane (the 24-bit integer in 3 bytes, or the
//! float's 4), then its stencil plane.

use super::layout::{BLOCK, Layout};
use super::plane::{ColorBlocks, DepthPlane, Plane};
use super::resource::{Subresource, Texture, image_size, pixels};
use super::{HIZ_STALE, TextureDescriptor};
use crate::error::Error;
use crate::format::Format;
use crate::memory::reserve;

/// Bits of 1.0, the largest depth that is stored as a float.
const FLOAT_ONE: u32 = 0x3f80_0000;

/// Bytes of image `s` of a texture.
///
/// # Errors
/// There is no such image.
pub(crate) fn packed_len(desc: &TextureDescriptor, s: Subresource) -> Result<usize, Error> {
    let [width, height] = image_size(desc, s)?;
    let texel = desc.format.bytes() as usize + usize::from(desc.format.is_depth_stencil());
    Ok(width as usize * height as usize * texel)
}

/// Bytes of a colour channel.
fn channel_bytes(format: Format) -> usize {
    format.bytes() as usize / format.channels()
}

/// Appends a texel's raw channels.
pub(crate) fn pack(format: Format, texel: [u32; 4], to: &mut Vec<u8>) {
    let bytes = channel_bytes(format);
    for channel in &texel[..format.channels()] {
        to.extend_from_slice(&channel.to_le_bytes()[..bytes]);
    }
}

fn unpack(format: Format, texel: &[u8]) -> [u32; 4] {
    let mut channels = [0; 4];
    for (channel, bytes) in channels
        .iter_mut()
        .zip(texel.chunks_exact(channel_bytes(format)))
    {
        *channel = integer(bytes);
    }
    channels
}

/// A little-endian integer of at most 4 bytes.
fn integer(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |v, b| v << 8 | u32::from(*b))
}

impl Texture {
    /// An image as it is stored, as bytes: rows from the top, each texel in its
    /// format's bytes, little-endian; of depth-stencil formats first all depths (3
    /// bytes of D24, 4 of a float), then all stencils.
    ///
    /// # Errors
    /// There is no such image, or memory is short.
    pub fn read_packed(&self, s: Subresource) -> Result<Vec<u8>, Error> {
        let mut bytes = Vec::new();
        let what = || format!("a copy of the texels of `{}`", self.desc.label);
        reserve(&mut bytes, packed_len(&self.desc, s)?, what)?;
        self.visit_packed(s, |row| bytes.extend_from_slice(row))?;
        Ok(bytes)
    }

    /// Shows `visit` what [`Texture::read_packed`] gives, row by row.
    ///
    /// # Errors
    /// There is no such image.
    pub fn visit_packed(&self, s: Subresource, mut visit: impl FnMut(&[u8])) -> Result<(), Error> {
        packed_len(&self.desc, s)?;
        let layout = &self.layouts[s.mip as usize];
        match &self.planes[s.mip as usize][s.layer as usize] {
            Plane::Color(blocks) => read_color(blocks, layout, &mut visit),
            Plane::Depth(plane) => read_depth(plane, self.desc.format, layout, &mut visit),
            Plane::Lent => unreachable!("only while a command list is executed"),
        }
        Ok(())
    }

    /// Replaces an image by bytes that [`Texture::read_packed`] gave: the same stored
    /// integers, whatever they mean.
    ///
    /// # Errors
    /// There is no such image, `bytes` has the wrong length, or a depth is not one of
    /// 0..=1; nothing has been written then.
    pub fn write_packed(&mut self, s: Subresource, bytes: &[u8]) -> Result<(), Error> {
        check_packed(&self.desc, s, bytes)?;
        let layout = &self.layouts[s.mip as usize];
        match &mut self.planes[s.mip as usize][s.layer as usize] {
            Plane::Color(blocks) => write_color(blocks, self.desc.format, layout, bytes),
            Plane::Depth(plane) => write_depth(plane, self.desc.format, layout, bytes),
            Plane::Lent => unreachable!("only while a command list is executed"),
        }
        Ok(())
    }
}

/// Whether `bytes` may become image `s` of a texture.
pub(crate) fn check_packed(
    desc: &TextureDescriptor,
    s: Subresource,
    bytes: &[u8],
) -> Result<(), Error> {
    let expected = packed_len(desc, s)?;
    if bytes.len() != expected {
        return Err(Error::ByteCount {
            texture: desc.label.clone(),
            given: bytes.len(),
            expected,
        });
    }
    if desc.format != Format::Depth32FloatStencil8 {
        return Ok(());
    }
    let depths = bytes[..expected / 5 * 4].chunks_exact(4).map(integer);
    match depths.into_iter().find(|d| *d > FLOAT_ONE) {
        None => Ok(()),
        Some(bits) => Err(Error::StoredDepth {
            texture: desc.label.clone(),
            bits,
        }),
    }
}

// Plain loops over numbers, and closures that are inlined without fail: iterators and
// `copy_from_slice` can stay calls for each texel.

fn read_color(blocks: &ColorBlocks, layout: &Layout, to: &mut impl FnMut(&[u8])) {
    match blocks {
        ColorBlocks::B8(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| v[b].0[i].to_le_bytes(),
        ),
        ColorBlocks::B16(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| v[b].0[i].to_le_bytes(),
        ),
        ColorBlocks::B32(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| v[b].0[i].to_le_bytes(),
        ),
        ColorBlocks::B16x4(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| {
                let c = &v[b].0;
                let [c0, c1, c2, c3] = [c[0][i], c[1][i], c[2][i], c[3][i]];
                let low = u64::from(c0) | u64::from(c1) << 16;
                (low | u64::from(c2) << 32 | u64::from(c3) << 48).to_le_bytes()
            },
        ),
        ColorBlocks::B32x4(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| {
                let c = &v[b].0;
                let [c0, c1, c2, c3] = [c[0][i], c[1][i], c[2][i], c[3][i]];
                let low = u128::from(c0) | u128::from(c1) << 32;
                (low | u128::from(c2) << 64 | u128::from(c3) << 96).to_le_bytes()
            },
        ),
    }
}

fn read_depth(plane: &DepthPlane, format: Format, layout: &Layout, to: &mut impl FnMut(&[u8])) {
    match format.bytes() {
        3 => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| {
                let [low, middle, high, _] = plane.depth[b].0[i].to_le_bytes();
                [low, middle, high]
            },
        ),
        _ => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, i| plane.depth[b].0[i].to_le_bytes(),
        ),
    }
    read_rows(
        layout,
        to,
        #[inline(always)]
        |b, i| [plane.stencil[b].0[i]],
    );
}

/// Shows the texels of an image row by row; `texel` gives the bytes of a pixel of a block.
#[inline(always)]
fn read_rows<const N: usize>(
    layout: &Layout,
    visit: &mut impl FnMut(&[u8]),
    texel: impl Fn(usize, usize) -> [u8; N],
) {
    const SIDE: usize = BLOCK as usize;
    let blocks = layout.width.div_ceil(BLOCK) as usize;
    let mut row = vec![[[0; N]; SIDE]; blocks];
    for y in 0..layout.height {
        let first = SIDE * (y as usize % SIDE);
        for x in 0..blocks {
            let block = layout.block_index(x as u32, y / BLOCK);
            let to = &mut row[x];
            for i in 0..SIDE {
                to[i] = texel(block, first + i);
            }
        }
        let row = &row.as_flattened()[..layout.width as usize];
        visit(row.as_flattened());
    }
}

fn write_color(blocks: &mut ColorBlocks, format: Format, layout: &Layout, bytes: &[u8]) {
    let texels = bytes.chunks_exact(format.bytes() as usize);
    for ((x, y), texel) in pixels(layout).zip(texels) {
        blocks.set(format, layout.locate(x, y), unpack(format, texel));
    }
}

fn write_depth(plane: &mut DepthPlane, format: Format, layout: &Layout, bytes: &[u8]) {
    let each = format.bytes() as usize;
    let (depths, stencils) = bytes.split_at(bytes.len() / (each + 1) * each);
    for ((x, y), (depth, stencil)) in pixels(layout).zip(depths.chunks_exact(each).zip(stencils)) {
        let (block, pixel) = layout.locate(x, y);
        plane.depth[block].0[pixel] = integer(depth);
        plane.stencil[block].0[pixel] = *stencil;
        [plane.hiz.min[block], plane.hiz.max[block]] = HIZ_STALE;
    }
}
