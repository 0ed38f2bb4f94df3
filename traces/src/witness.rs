//! What is kept of the contents of blocks: after each event that wrote to one, how far a
//! codec would shrink it; after each draw, a hash.

use gnomon_raster::{BlockView, BlockWitness, ColorBlock, Format};
use xxhash_rust::xxh3::xxh3_64;

use crate::profile::codec::{COLOR_LEVELS, RAW, class, depth_stencil_class};

/// Depth, stencil and four attachments of 16 bytes a pixel.
const MOST_BYTES: usize = 64 * (4 + 1 + 4 * 16);
/// Depth, stencil and an attachment of 8 bytes a pixel: what nearly all passes have.
const FEW_BYTES: usize = 64 * (4 + 1 + 8);
/// Colour attachments whose class is kept.
const COLORS: usize = 3;
/// Tells the classes of a block that was written to from no witness.
const SEEN: u64 = 1 << 8;

/// After an event: classes of the codec HILO in the low 8 bits, two bits each, of depth and
/// stencil, then of the colour attachments 0 to 2.
#[derive(Clone, Copy, Debug, Default)]
pub struct Witness;

impl BlockWitness for Witness {
    fn after(&self, block: &BlockView<'_>) -> u64 {
        let depth_class = block.depth_stencil.map_or(RAW, |(depth, stencil)| {
            depth_stencil_class(block.level, depth, stencil)
        });
        let mut classes = u64::from(depth_class);
        for i in 0..block.color.len().min(COLORS) {
            let color = match (block.color[i], block.formats[i]) {
                (ColorBlock::B32(words), Format::Rgba8Unorm) => {
                    class(block.level, words, COLOR_LEVELS)
                }
                _ => RAW,
            };
            classes |= u64::from(color) << (2 * (i + 1));
        }
        classes | SEEN
    }
}

/// The class of depth and stencil (`0`) or of colour attachment `client - 1` in what
/// [`Witness`] says; [`RAW`] for the fourth attachment, of which none is kept.
#[must_use]
pub fn class_of(witness: u64, client: usize) -> u8 {
    match client {
        0..=COLORS => (witness >> (2 * client)) as u8 & 3,
        _ => RAW,
    }
}

/// After a draw: 56 bits of a hash of the block's pixels inside the image, of all
/// attachments.
#[derive(Clone, Copy, Debug, Default)]
pub struct Contents;

impl BlockWitness for Contents {
    fn after(&self, block: &BlockView<'_>) -> u64 {
        let hash = match bytes(block) {
            ..=FEW_BYTES => hash::<FEW_BYTES>(block),
            _ => hash::<MOST_BYTES>(block),
        };
        // The low byte was taken when traces kept both in one word.
        hash >> 8
    }
}

/// Bytes of all 64 pixels.
fn bytes(block: &BlockView<'_>) -> usize {
    let depth = if block.depth_stencil.is_some() { 5 } else { 0 };
    let color = block.formats.iter().map(|f| f.bytes() as usize);
    64 * (depth + color.sum::<usize>())
}

fn hash<const MOST: usize>(block: &BlockView<'_>) -> u64 {
    let mut bytes = Bytes {
        buffer: [0; MOST],
        length: 0,
        inside: block.inside,
    };
    if let Some((depth, stencil)) = block.depth_stencil {
        bytes.put(depth, u32::to_le_bytes);
        bytes.put(stencil, u8::to_le_bytes);
    }
    for block in block.color {
        match block {
            ColorBlock::B8(b) => bytes.put(b, u8::to_le_bytes),
            ColorBlock::B16(b) => bytes.put(b, u16::to_le_bytes),
            ColorBlock::B32(b) => bytes.put(b, u32::to_le_bytes),
            ColorBlock::B16x4(b) => b.iter().for_each(|c| bytes.put(c, u16::to_le_bytes)),
            ColorBlock::B32x4(b) => b.iter().for_each(|c| bytes.put(c, u32::to_le_bytes)),
        }
    }
    xxh3_64(&bytes.buffer[..bytes.length])
}

/// Pixels one after the other, those outside the image as zeros.
struct Bytes<const MOST: usize> {
    buffer: [u8; MOST],
    length: usize,
    inside: u64,
}

impl<const MOST: usize> Bytes<MOST> {
    #[inline(always)]
    fn put<T: Copy, const N: usize>(&mut self, words: &[T; 64], bytes: impl Fn(T) -> [u8; N]) {
        let to = &mut self.buffer[self.length..self.length + 64 * N];
        self.length += 64 * N;
        // Plain loops: what iterators call would be called for each word.
        let to = to.as_chunks_mut::<N>().0;
        let to = &mut to[..64];
        for i in 0..64 {
            to[i] = bytes(words[i]);
        }
        if self.inside != u64::MAX {
            for i in 0..64 {
                if self.inside >> i & 1 == 0 {
                    to[i] = [0; N];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: [u32; 64] = [7; 64];

    fn view<'a>(
        depth: &'a [u32; 64],
        stencil: &'a [u8; 64],
        color: &'a [ColorBlock<'a>],
    ) -> BlockView<'a> {
        let formats = &[Format::Rgba8Unorm; 4][..color.len()];
        BlockView::new(Some((depth, stencil)), color, formats)
    }

    #[test]
    fn classes_are_those_of_each_attachment() {
        let mixed: [u32; 64] = core::array::from_fn(|i| (i as u32 % 5) << 13);
        let middle: [u32; 64] = core::array::from_fn(|i| (i as u32 % 5) << 12);
        let color = [ColorBlock::B32(&middle), ColorBlock::B32(&mixed)];
        let witness = Witness.after(&view(&mixed, &[3; 64], &color));
        let classes = [0, 1, 2, 3, 4].map(|c| class_of(witness, c));
        assert_eq!(classes, [2, 1, RAW, 0, RAW]);
        let plain = Witness.after(&view(&PLAIN, &[0; 64], &[]));
        assert_eq!([class_of(plain, 0), class_of(plain, 1)], [0, 0]);
        assert_ne!(plain, 0, "it is told from no witness");
    }

    #[test]
    fn floats_do_not_compress() {
        let color = [ColorBlock::B16x4(&[[0; 64]; 4])];
        let halves = [Format::Rgba16Float];
        let block = BlockView::new(Some((&[1 << 24; 64], &[0; 64])), &color, &halves);
        let witness = Witness.after(&block);
        assert_eq!([class_of(witness, 0), class_of(witness, 1)], [RAW; 2]);
    }

    #[test]
    fn every_bit_inside_changes_the_hash_and_none_outside() {
        let color = [ColorBlock::B32(&PLAIN)];
        let plain = view(&PLAIN, &[0; 64], &color);
        let mut depth = PLAIN;
        depth[63] ^= 1;
        let mut stencil = [0; 64];
        stencil[63] = 1;
        let other = [ColorBlock::B32(&depth)];
        let changed = [
            view(&depth, &[0; 64], &color),
            view(&PLAIN, &stencil, &color),
            view(&PLAIN, &[0; 64], &other),
        ];
        let cut = |mut block: BlockView<'_>| {
            block.inside = u64::MAX >> 1;
            Contents.after(&block)
        };
        for changed in changed {
            assert_ne!(Contents.after(&changed), Contents.after(&plain));
            assert_eq!(cut(changed), cut(plain));
        }
    }

    /// Files hold these hashes: they are of these bytes, in small blocks and large ones.
    #[test]
    fn hashes_are_of_the_bytes_in_their_order() {
        let stencil = [9; 64];
        let depth: [u32; 64] = core::array::from_fn(|i| 1000 + i as u32);
        let wide = [[1_u32; 64], [2; 64], [3; 64], [4; 64]];
        let mut bytes: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();
        bytes.extend(stencil);
        let few = BlockView::new(Some((&depth, &stencil)), &[], &[]);
        assert_eq!(Contents.after(&few), xxh3_64(&bytes) >> 8);
        bytes.extend(wide.as_flattened().iter().flat_map(|w| w.to_le_bytes()));
        let color = [ColorBlock::B32x4(&wide)];
        let many = BlockView::new(Some((&depth, &stencil)), &color, &[Format::Rgba32Float]);
        assert_eq!(Contents.after(&many), xxh3_64(&bytes) >> 8);
    }
}
