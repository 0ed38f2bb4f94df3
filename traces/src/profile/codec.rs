//! How far a lossless codec shrinks a block of 64 words of 32 bits: HILO, as the
//! simulator ATTILA has it (`src/emul/HiloCompressorEmulator.cpp`).
//!
//! All words share their high bits with one of four references: the smallest and the
//! largest of the block, one step above the one and one below the other. What is left of
//! each word is its low bits and which reference it is.

/// Low bits that are kept, by level.
const LOW_BITS: [u32; 3] = [5, 13, 21];
/// Levels of packed depth and stencil.
pub const DEPTH_STENCIL_LEVELS: usize = 3;
/// Levels of colour.
pub const COLOR_LEVELS: usize = 2;
/// The class of a block that does not compress.
pub const RAW: u8 = 3;

/// The lowest of the first `levels` levels (at most 3) that holds `words`, or [`RAW`]. A
/// block of class `c` takes `64 · (c + 1)` bytes.
#[must_use]
pub fn class(words: &[u32; 64], levels: usize) -> u8 {
    let (min, max) = words
        .iter()
        .fold((u32::MAX, 0), |(low, high), w| (low.min(*w), high.max(*w)));
    let bits = LOW_BITS.iter().take(levels);
    let level = bits.enumerate().find(|(_, b)| holds(words, **b, min, max));
    level.map_or(RAW, |(i, _)| i as u8)
}

fn holds(words: &[u32; 64], low_bits: u32, min: u32, max: u32) -> bool {
    let (high, step) = (u32::MAX << low_bits, 1 << low_bits);
    let (low, top) = (min & high, max & high);
    let references = [low, top, low.wrapping_add(step), top.wrapping_sub(step)];
    words.iter().all(|w| references.contains(&(w & high)))
}

/// Depth and stencil as one word.
#[must_use]
pub fn depth_stencil_words(depth: &[u32; 64], stencil: &[u8; 64]) -> [u32; 64] {
    core::array::from_fn(|i| u32::from(stencil[i]) << 24 | (depth[i] & 0xff_ffff))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(value: impl Fn(u32) -> u32) -> [u32; 64] {
        core::array::from_fn(|i| value(i as u32))
    }

    #[test]
    fn a_plain_block_takes_the_first_level() {
        assert_eq!(class(&block(|_| 0xffff_ffff), 3), 0);
        assert_eq!(class(&block(|i| 32 * (i % 2) + i % 32), 3), 0);
    }

    #[test]
    fn a_step_beside_each_extreme_is_a_reference() {
        // High parts 0, 1, 8, 9 of 32: smallest, above it, below the largest, largest.
        let four = [0, 32, 8 * 32, 9 * 32];
        assert_eq!(class(&block(|i| four[i as usize % 4] + i % 32), 3), 0);
        let five = [0, 32, 4 * 32, 8 * 32, 9 * 32];
        assert_eq!(class(&block(|i| five[i as usize % 5]), 3), 1);
    }

    #[test]
    fn levels_keep_5_13_and_21_low_bits() {
        let spread = |bits: u32| block(move |i| (i % 5) << bits);
        assert_eq!(class(&spread(4), 3), 0);
        assert_eq!(class(&spread(5), 3), 1);
        assert_eq!(class(&spread(12), 3), 1);
        assert_eq!(class(&spread(13), 3), 2);
        assert_eq!(class(&spread(20), 3), 2);
        assert_eq!(class(&spread(21), 3), RAW);
    }

    #[test]
    fn colors_have_two_levels() {
        let words = block(|i| (i % 5) << 13);
        assert_eq!(class(&words, DEPTH_STENCIL_LEVELS), 2);
        assert_eq!(class(&words, COLOR_LEVELS), RAW);
    }

    #[test]
    fn references_wrap_around() {
        // Two steps only: what lies above the largest and below the smallest is nowhere.
        assert_eq!(class(&block(|i| u32::MAX << (i % 2)), 3), 0);
        assert_eq!(class(&block(|i| (i % 2) * u32::MAX), 3), 0);
    }

    #[test]
    fn stencil_is_the_high_byte() {
        let words = depth_stencil_words(&[0x12_3456; 64], &[0xab; 64]);
        assert_eq!(words, [0xab12_3456; 64]);
    }
}
