//! Where images lie: blocks of 8×8 pixels, and which lines hold them.

use core::ops::Range;

use gnomon_raster::{Format, Subresource, TextureDescriptor, TextureDimension, TextureId};

use super::cache::{Lines, pixels_of};
use crate::shape::FrameShape;

/// An image of a texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Image {
    pub(super) size: [u32; 2],
    /// Bytes of a pixel's word.
    pub(super) bytes: u8,
    /// Lines of a block.
    per_block: u32,
    first_line: u32,
    /// Squares of 64 pixels in a row.
    across: u32,
    squares: u32,
    /// It is of the picture's size.
    pub(super) is_picture: bool,
}

impl Image {
    /// Number of the block at a column and row: squares of 8×8 blocks in rows, Morton
    /// order inside.
    pub(super) fn block(&self, [x, y]: [u16; 2]) -> u32 {
        let (x, y) = (u32::from(x), u32::from(y));
        64 * (y / 8 * self.across + x / 8) + morton(x % 8, y % 8)
    }

    pub(super) fn blocks(&self) -> u32 {
        64 * self.squares
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Its lines.
    pub(super) fn lines(&self) -> Range<u32> {
        self.first_line..self.first_line + self.blocks() * self.per_block
    }

    /// The lines that `masks` of a block touch, with the masks' parts in them.
    pub(super) fn touched(
        &self,
        block: u32,
        masks: [u64; 2],
    ) -> impl Iterator<Item = (u32, [u64; 2])> + use<> {
        let pixels = pixels_of(self.bytes);
        let whole = u64::MAX >> (64 - pixels);
        let first = self.first_line + block * self.per_block;
        let parts = (0..self.per_block).map(move |i| {
            let part = masks.map(|m| m >> (i * pixels) & whole);
            (first + i, part)
        });
        parts.filter(|(_, [read, write])| read | write != 0)
    }
}

/// Bits of x and y in turn.
pub(super) fn morton(x: u32, y: u32) -> u32 {
    let bit = |k: u32| (x >> k & 1) << (2 * k) | (y >> k & 1) << (2 * k + 1);
    (0..6).map(bit).sum()
}

/// All images of a frame.
#[derive(Debug)]
pub(super) struct Images {
    /// By texture; by level, then layer.
    of: Vec<Vec<Image>>,
    layers: Vec<Vec<u32>>,
    pub(super) lines: Lines,
    /// Width and height of the picture: the last pass's attachments.
    pub(super) picture: [u32; 2],
    /// Blocks of the picture in a row.
    columns: u32,
}

impl Images {
    pub(super) fn new(shape: &FrameShape) -> Self {
        let picture = picture(shape);
        let mut images = Self {
            of: Vec::new(),
            layers: Vec::new(),
            lines: Lines::default(),
            picture,
            columns: picture[0].div_ceil(8),
        };
        for texture in &shape.textures {
            images.add(texture);
        }
        images
    }

    fn add(&mut self, texture: &TextureDescriptor) {
        let (mut all, mut firsts) = (Vec::new(), Vec::new());
        for mip in 0..texture.mip_levels {
            firsts.push(all.len() as u32);
            for _ in 0..layers(texture, mip) {
                let image = self.image(texture, mip);
                self.fill(&image);
                all.push(image);
            }
        }
        self.of.push(all);
        self.layers.push(firsts);
    }

    fn image(&self, texture: &TextureDescriptor, mip: u32) -> Image {
        let size = size(texture, mip);
        let bytes = word_bytes(texture.format);
        let [across, down] = size.map(|s| s.div_ceil(64));
        Image {
            size,
            bytes,
            per_block: 64 / pixels_of(bytes),
            first_line: self.lines.state.len() as u32,
            across,
            squares: across * down,
            is_picture: size == self.picture,
        }
    }

    fn fill(&mut self, image: &Image) {
        for block in 0..image.blocks() {
            let cell = match image.is_picture {
                true => self.cell_of_block(image, block),
                false => self.elsewhere(),
            };
            for i in 0..image.per_block {
                let shift = i * pixels_of(image.bytes);
                self.lines.push(cell, shift as u8, image.bytes);
            }
        }
    }

    fn cell_of_block(&self, image: &Image, block: u32) -> u32 {
        let (square, inside) = (block / 64, block % 64);
        let pick = |shift: u32| {
            (0..3)
                .map(|k| (inside >> (2 * k + shift) & 1) << k)
                .sum::<u32>()
        };
        let x = 8 * (square % image.across) + pick(0);
        let y = 8 * (square / image.across) + pick(1);
        self.cell([x as u16, y as u16])
    }

    /// The picture's cell of a block.
    pub(super) fn cell(&self, [x, y]: [u16; 2]) -> u32 {
        let (x, y) = (u32::from(x), u32::from(y));
        if x < self.columns && y < self.picture[1].div_ceil(8) {
            y * self.columns + x
        } else {
            self.elsewhere()
        }
    }

    /// The cell of everything that is not a place of the picture.
    pub(super) fn elsewhere(&self) -> u32 {
        self.columns * self.picture[1].div_ceil(8)
    }

    /// Columns and rows of the picture's blocks.
    pub(super) fn grid(&self) -> [u32; 2] {
        [self.columns, self.picture[1].div_ceil(8)]
    }

    /// An image; the first of the texture where there is no such one.
    pub(super) fn get(&self, texture: TextureId, s: Subresource) -> Image {
        let images = &self.of[texture.index()];
        let first = self.layers[texture.index()].get(s.mip as usize);
        let at = (first.copied().unwrap_or(0) + s.layer) as usize;
        images[at.min(images.len() - 1)]
    }

    /// All lines of a texture.
    pub(super) fn texture_lines(&self, texture: TextureId) -> Range<u32> {
        let images = &self.of[texture.index()];
        let end = images.last().map_or(0, |i| i.lines().end);
        images.first().map_or(0, |i| i.first_line)..end
    }
}

/// Size of the last pass's attachments.
fn picture(shape: &FrameShape) -> [u32; 2] {
    let Some(pass) = shape.passes.last() else {
        return [0; 2];
    };
    let color = pass.color.first().map(|c| (c.texture, c.subresource));
    let depth = pass.depth_stencil.as_ref();
    let attached = color.or(depth.map(|d| (d.texture, d.subresource)));
    attached.map_or([0; 2], |(t, s)| size(&shape.textures[t.index()], s.mip))
}

fn size(texture: &TextureDescriptor, mip: u32) -> [u32; 2] {
    [0, 1].map(|k| (texture.size[k] >> mip.min(31)).max(1))
}

fn layers(texture: &TextureDescriptor, mip: u32) -> u32 {
    match texture.dimension {
        TextureDimension::Cube => 6,
        _ => (texture.size[2] >> mip.min(31)).max(1),
    }
}

/// Bytes of a pixel's word: depth and stencil share one.
fn word_bytes(format: Format) -> u8 {
    match format {
        Format::Depth24Stencil8 => 4,
        Format::Depth32FloatStencil8 => 8,
        color => color.bytes() as u8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_a_line_and_a_cell_of_its_own() {
        let texture = TextureDescriptor::d2("", Format::Rgba8Unorm, 200, 75);
        let mut images = Images::new(&FrameShape::default());
        (images.picture, images.columns) = ([200, 75], 25);
        images.add(&texture);
        let image = images.of[0][0];
        let mut seen = vec![false; image.blocks() as usize];
        for y in 0..10 {
            for x in 0..25 {
                let block = image.block([x, y]);
                assert!(!core::mem::replace(&mut seen[block as usize], true));
                let cell = images.lines.cell[block as usize];
                assert_eq!(cell, images.cell([x, y]));
            }
        }
    }

    #[test]
    fn wide_pixels_take_several_lines() {
        let texture = TextureDescriptor::d2("", Format::Rgba16Float, 8, 8);
        let mut images = Images::new(&FrameShape::default());
        images.add(&texture);
        let touched: Vec<_> = images.of[0][0].touched(0, [1 << 32, 1]).collect();
        assert_eq!(touched, [(0, [0, 1]), (1, [1, 0])]);
    }
}
