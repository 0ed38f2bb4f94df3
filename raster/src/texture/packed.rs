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

/// Pixels of a row of a block.
const SIDE: usize = BLOCK as usize;

// Plain loops over arrays of known size, in closures that are inlined without fail: a row of
// a block becomes a few instructions on whole registers.

fn read_color(blocks: &ColorBlocks, layout: &Layout, to: &mut impl FnMut(&[u8])) {
    match blocks {
        ColorBlocks::B8(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| each(row(&v[b].0, y), u8::to_le_bytes),
        ),
        ColorBlocks::B16(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| each(row(&v[b].0, y), u16::to_le_bytes),
        ),
        ColorBlocks::B32(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| each(row(&v[b].0, y), u32::to_le_bytes),
        ),
        ColorBlocks::B16x4(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| {
                let [r, g, b, a] = &v[b].0;
                let [r, g, b, a] = [row(r, y), row(g, y), row(b, y), row(a, y)];
                let mut bytes = [[0; 8]; SIDE];
                for i in 0..SIDE {
                    let low = u64::from(r[i]) | u64::from(g[i]) << 16;
                    let texel = low | u64::from(b[i]) << 32 | u64::from(a[i]) << 48;
                    bytes[i] = texel.to_le_bytes();
                }
                bytes
            },
        ),
        ColorBlocks::B32x4(v) => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| {
                let [r, g, b, a] = &v[b].0;
                let [r, g, b, a] = [row(r, y), row(g, y), row(b, y), row(a, y)];
                let mut bytes = [[0; 16]; SIDE];
                for i in 0..SIDE {
                    let low = u128::from(r[i]) | u128::from(g[i]) << 32;
                    let texel = low | u128::from(b[i]) << 64 | u128::from(a[i]) << 96;
                    bytes[i] = texel.to_le_bytes();
                }
                bytes
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
            |b, y| three_bytes(row(&plane.depth[b].0, y)),
        ),
        _ => read_rows(
            layout,
            to,
            #[inline(always)]
            |b, y| each(row(&plane.depth[b].0, y), u32::to_le_bytes),
        ),
    }
    read_rows(
        layout,
        to,
        #[inline(always)]
        |b, y| each(row(&plane.stencil[b].0, y), u8::to_le_bytes),
    );
}

/// Row `y` of a block.
#[inline(always)]
fn row<T>(block: &[T; SIDE * SIDE], y: usize) -> &[T; SIDE] {
    &block.as_chunks().0[y]
}

#[inline(always)]
fn each<T: Copy, const N: usize>(row: &[T; SIDE], bytes: impl Fn(T) -> [u8; N]) -> [[u8; N]; SIDE] {
    let mut all = [[0; N]; SIDE];
    for i in 0..SIDE {
        all[i] = bytes(row[i]);
    }
    all
}

/// The low three bytes of each word: eight words are three of twice the size.
#[inline(always)]
fn three_bytes(words: &[u32; SIDE]) -> [[u8; 3]; SIDE] {
    let mut w = [0; SIDE];
    for i in 0..SIDE {
        w[i] = u64::from(words[i] & 0xff_ffff);
    }
    let wide = [
        w[0] | w[1] << 24 | w[2] << 48,
        w[2] >> 16 | w[3] << 8 | w[4] << 32 | w[5] << 56,
        w[5] >> 8 | w[6] << 16 | w[7] << 40,
    ];
    let mut bytes = [[0; 3]; SIDE];
    let all = bytes.as_flattened_mut().as_chunks_mut::<8>().0;
    for i in 0..wide.len() {
        all[i] = wide[i].to_le_bytes();
    }
    bytes
}

/// Shows the texels of an image row by row; `texels` gives the bytes of row `y` of a block.
/// All of a block is read at once: blocks lie far apart, so that its rows would be misses of
/// the cache one by one.
#[inline(always)]
fn read_rows<const N: usize>(
    layout: &Layout,
    visit: &mut impl FnMut(&[u8]),
    texels: impl Fn(usize, usize) -> [[u8; N]; SIDE],
) {
    let blocks = layout.width.div_ceil(BLOCK) as usize;
    let mut rows = vec![[[0; N]; SIDE]; SIDE * blocks];
    for y in 0..layout.height.div_ceil(BLOCK) {
        for x in 0..blocks {
            let block = layout.block_index(x as u32, y);
            for r in 0..SIDE {
                rows[r * blocks + x] = texels(block, r);
            }
        }
        let shown = (layout.height - y * BLOCK).min(BLOCK) as usize;
        for row in rows.chunks_exact(blocks).take(shown) {
            let row = &row.as_flattened()[..layout.width as usize];
            visit(row.as_flattened());
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// xorshift.
    fn bytes(count: usize) -> Vec<u8> {
        let mut x = 0x9e37_79b9_u32;
        let mut next = || {
            x ^= x << 13;
            x ^= x >> 17;
            x ^= x << 5;
            x as u8
        };
        (0..count).map(|_| next()).collect()
    }

    /// Whatever goes by rows of blocks is what single texels are.
    #[test]
    fn rows_are_their_texels_in_every_format_and_size() {
        let image = Subresource::default();
        for format in Format::ALL {
            for [width, height] in [[1, 1], [8, 8], [13, 9], [31, 17], [64, 3]] {
                let desc = TextureDescriptor::d2("t", format, width, height);
                let mut texture = Texture::new(&desc).unwrap();
                let mut given = bytes(packed_len(&desc, image).unwrap());
                if format == Format::Depth32FloatStencil8 {
                    // Depths are of 0..=1.
                    let depths = given.len() / 5 * 4;
                    given[3..depths]
                        .iter_mut()
                        .step_by(4)
                        .for_each(|b| *b = 0x3e);
                }
                texture.write_packed(image, &given).unwrap();
                assert_eq!(
                    texture.read_packed(image).unwrap(),
                    given,
                    "{format:?} {width}"
                );
                let mut texels = Vec::new();
                if format.is_depth_stencil() {
                    let depths = texture.read_depth_bits(image).unwrap();
                    let each = format.bytes() as usize;
                    depths
                        .iter()
                        .for_each(|d| texels.extend(&d.to_le_bytes()[..each]));
                    texels.extend(texture.read_stencil(image).unwrap());
                } else {
                    let raw = texture.read_raw(image).unwrap();
                    raw.iter().for_each(|t| pack(format, *t, &mut texels));
                }
                assert_eq!(texels, given, "{format:?} {width}");
            }
        }
    }
}
