//! What a trace keeps of the contents of a block after each event that wrote to it: how
//! far a codec would shrink it, and a hash.

use gnomon_raster::{BlockView, BlockWitness, ColorBlock, Format};
use xxhash_rust::xxh3::xxh3_64;

use crate::profile::codec::{COLOR_LEVELS, DEPTH_STENCIL_LEVELS, RAW, class, depth_stencil_words};

/// Depth, stencil and four attachments of 16 bytes a pixel.
const MOST_BYTES: usize = 64 * (4 + 1 + 4 * 16);
/// Colour attachments whose class is kept.
const COLORS: usize = 3;

/// The low 8 bits are classes of the codec HILO, two bits each: depth and stencil, then
/// colour attachments 0 to 2; the upper 56 are a hash of the block's pixels inside the
/// image.
#[derive(Clone, Copy, Debug, Default)]
pub struct Witness;

impl BlockWitness for Witness {
    fn after(&self, block: &BlockView<'_>) -> u64 {
        let parts = Parts {
            inside: block.inside,
            depth_stencil: block.depth_stencil,
            color: block.color,
            formats: block.formats,
        };
        parts.witness()
    }
}

/// The class of depth and stencil (`0`) or of colour attachment `client - 1` in a witness;
/// [`RAW`] for the fourth attachment, of which none is kept.
#[must_use]
pub fn class_of(witness: u64, client: usize) -> u8 {
    match client {
        0..=COLORS => (witness >> (2 * client)) as u8 & 3,
        _ => RAW,
    }
}

/// The hash in a witness.
#[must_use]
pub fn hash_of(witness: u64) -> u64 {
    witness >> 8
}

struct Parts<'a> {
    inside: u64,
    depth_stencil: Option<(&'a [u32; 64], &'a [u8; 64])>,
    color: &'a [ColorBlock<'a>],
    formats: &'a [Format],
}

impl Parts<'_> {
    fn witness(&self) -> u64 {
        self.classes() | self.hash() << 8
    }

    fn classes(&self) -> u64 {
        let mut classes = u64::from(self.depth_class());
        for (i, block) in self.color.iter().take(COLORS).enumerate() {
            let color = color_class(*block, self.formats.get(i).copied());
            classes |= u64::from(color) << (2 * (i + 1));
        }
        classes
    }

    /// Depth as a float fills its word: what is left has no room for the stencil.
    fn depth_class(&self) -> u8 {
        match self.depth_stencil {
            Some((depth, stencil)) if depth.iter().all(|d| d >> 24 == 0) => {
                class(&depth_stencil_words(depth, stencil), DEPTH_STENCIL_LEVELS)
            }
            _ => RAW,
        }
    }

    fn hash(&self) -> u64 {
        let mut bytes = Bytes {
            buffer: [0; MOST_BYTES],
            length: 0,
            inside: self.inside,
        };
        if let Some((depth, stencil)) = self.depth_stencil {
            bytes.put(depth, u32::to_le_bytes);
            bytes.put(stencil, u8::to_le_bytes);
        }
        for block in self.color {
            match block {
                ColorBlock::B8(b) => bytes.put(b, u8::to_le_bytes),
                ColorBlock::B16(b) => bytes.put(b, u16::to_le_bytes),
                ColorBlock::B32(b) => bytes.put(b, u32::to_le_bytes),
                ColorBlock::B16x4(b) => b.iter().for_each(|c| bytes.put(c, u16::to_le_bytes)),
                ColorBlock::B32x4(b) => b.iter().for_each(|c| bytes.put(c, u32::to_le_bytes)),
            }
        }
        xxh3_64(&bytes.buffer[..bytes.length]) >> 8
    }
}

fn color_class(block: ColorBlock<'_>, format: Option<Format>) -> u8 {
    match (block, format) {
        (ColorBlock::B32(words), Some(Format::Rgba8Unorm)) => class(words, COLOR_LEVELS),
        _ => RAW,
    }
}

/// Pixels one after the other, those outside the image as zeros.
struct Bytes {
    buffer: [u8; MOST_BYTES],
    length: usize,
    inside: u64,
}

impl Bytes {
    fn put<T: Copy, const N: usize>(&mut self, words: &[T; 64], bytes: impl Fn(T) -> [u8; N]) {
        let to = &mut self.buffer[self.length..self.length + 64 * N];
        for (i, (to, word)) in to.chunks_exact_mut(N).zip(words).enumerate() {
            if self.inside >> i & 1 != 0 {
                to.copy_from_slice(&bytes(*word));
            }
        }
        self.length += 64 * N;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: [u32; 64] = [7; 64];

    fn parts<'a>(
        depth: &'a [u32; 64],
        stencil: &'a [u8; 64],
        color: &'a [ColorBlock<'a>],
    ) -> Parts<'a> {
        Parts {
            inside: u64::MAX,
            depth_stencil: Some((depth, stencil)),
            color,
            formats: &[Format::Rgba8Unorm; 4],
        }
    }

    #[test]
    fn classes_are_those_of_each_attachment() {
        let mixed: [u32; 64] = core::array::from_fn(|i| (i as u32 % 5) << 13);
        let middle: [u32; 64] = core::array::from_fn(|i| (i as u32 % 5) << 12);
        let color = [ColorBlock::B32(&middle), ColorBlock::B32(&mixed)];
        let witness = parts(&mixed, &[3; 64], &color).witness();
        let classes = [0, 1, 2, 3, 4].map(|c| class_of(witness, c));
        assert_eq!(classes, [2, 1, RAW, 0, RAW]);
    }

    #[test]
    fn floats_do_not_compress() {
        let color = [ColorBlock::B16x4(&[[0; 64]; 4])];
        let witness = parts(&[1 << 24; 64], &[0; 64], &color).witness();
        assert_eq!([class_of(witness, 0), class_of(witness, 1)], [RAW; 2]);
    }

    #[test]
    fn every_bit_inside_changes_the_hash_and_none_outside() {
        let color = [ColorBlock::B32(&PLAIN)];
        let plain = parts(&PLAIN, &[0; 64], &color);
        let mut depth = PLAIN;
        depth[63] ^= 1;
        let mut stencil = [0; 64];
        stencil[63] = 1;
        let other = [ColorBlock::B32(&depth)];
        let changed = [
            parts(&depth, &[0; 64], &color),
            parts(&PLAIN, &stencil, &color),
            parts(&PLAIN, &[0; 64], &other),
        ];
        let inside = u64::MAX >> 1;
        let cut = Parts { inside, ..plain }.hash();
        let plain = parts(&PLAIN, &[0; 64], &color).hash();
        for changed in changed {
            assert_ne!(changed.hash(), plain);
            assert_eq!(Parts { inside, ..changed }.hash(), cut);
        }
        assert_eq!(hash_of(parts(&PLAIN, &[0; 64], &color).witness()), plain);
    }
}
