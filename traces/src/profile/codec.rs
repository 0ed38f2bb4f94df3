//! How far a lossless codec shrinks a block of 64 words of 32 bits: HILO, as the
//! simulator ATTILA has it (`src/emul/HiloCompressorEmulator.cpp`).
//!
//! All words share their high bits with one of four references: the smallest and the
//! largest of the block, one step above the one and one below the other. What is left of
//! each word is its low bits and which reference it is.
//!
//! Recording asks after every event that wrote to a block: so it is lane code.

use gnomon_raster::simd::{LaneProgram, each4};
use gnomon_raster::{LANES, Lanes, SimdLevel, U32};

/// Low bits that are kept, by level.
const LOW_BITS: [u32; 3] = [5, 13, 21];
/// Levels of packed depth and stencil.
pub const DEPTH_STENCIL_LEVELS: usize = 3;
/// Levels of colour.
pub const COLOR_LEVELS: usize = 2;
/// The class of a block that does not compress.
pub const RAW: u8 = 3;
/// Bits of a depth: what is above has no room beside the stencil.
const DEPTH: u32 = 0xff_ffff;

/// The lowest of the first `levels` levels (at most 3) that holds `words`, or [`RAW`]. A
/// block of class `c` takes `64 · (c + 1)` bytes.
#[must_use]
pub fn class(on: SimdLevel, words: &[u32; 64], levels: usize) -> u8 {
    on.run(Words { words, levels })
}

/// The same of words that have the stencil in the high byte and the depth below: [`RAW`]
/// where a depth needs the high byte, as floats do.
#[must_use]
pub fn depth_stencil_class(on: SimdLevel, depth: &[u32; 64], stencil: &[u8; 64]) -> u8 {
    on.run(DepthStencil { depth, stencil })
}

struct Words<'a> {
    words: &'a [u32; 64],
    levels: usize,
}

impl LaneProgram for Words<'_> {
    type Output = u8;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> u8 {
        hilo(l, load(l, self.words), self.levels)
    }
}

struct DepthStencil<'a> {
    depth: &'a [u32; 64],
    stencil: &'a [u8; 64],
}

impl LaneProgram for DepthStencil<'_> {
    type Output = u8;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> u8 {
        let depth = load(l, self.depth);
        let all = (depth[0] | depth[1]) | (depth[2] | depth[3]);
        if all.gt(U32::splat(l, DEPTH)).any() {
            return RAW;
        }
        let stencil = self.stencil.as_chunks::<LANES>().0;
        let words = each4(
            #[inline(always)]
            |k| (U32::from_bytes(l, &stencil[k]) << 24) | depth[k],
        );
        hilo(l, words, DEPTH_STENCIL_LEVELS)
    }
}

#[inline(always)]
fn load<L: Lanes>(l: L, words: &[u32; 64]) -> [U32<L>; 4] {
    let packets = words.as_chunks::<LANES>().0;
    each4(
        #[inline(always)]
        |k| U32::from_array(l, &packets[k]),
    )
}

/// The first level that holds the words.
#[inline(always)]
fn hilo<L: Lanes>(l: L, w: [U32<L>; 4], levels: usize) -> u8 {
    let min = w[0].min(w[1]).min(w[2].min(w[3])).reduce_min();
    let max = w[0].max(w[1]).max(w[2].max(w[3])).reduce_max();
    for (level, bits) in LOW_BITS.iter().enumerate().take(levels) {
        let step = 1 << bits;
        let (low, top) = (min & !(step - 1), max & !(step - 1));
        // References are low, low + step, top − step and top. Where they leave no gap,
        // they hold every word; else no word may be in it.
        if (top - low) >> bits <= 3 {
            return level as u8;
        }
        let first = low + 2 * step;
        let (gap, first) = (U32::splat(l, top - step - first), U32::splat(l, first));
        let inside = each4(
            #[inline(always)]
            |k| (w[k] - first).lt(gap),
        );
        if !((inside[0] | inside[1]) | (inside[2] | inside[3])).any() {
            return level as u8;
        }
    }
    RAW
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the emulator says it: each word's high bits are those of a reference.
    fn plainly(words: &[u32; 64], levels: usize) -> u8 {
        let (min, max) = (words.iter().min().unwrap(), words.iter().max().unwrap());
        let holds = |bits: u32| {
            let (high, step) = (u32::MAX << bits, 1 << bits);
            let (low, top) = (min & high, max & high);
            let references = [low, top, low.wrapping_add(step), top.wrapping_sub(step)];
            words.iter().all(|w| references.contains(&(w & high)))
        };
        let level = LOW_BITS[..levels].iter().position(|bits| holds(*bits));
        level.map_or(RAW, |i| i as u8)
    }

    /// What every SIMD level says, which is what is said plainly.
    fn class(words: &[u32; 64], levels: usize) -> u8 {
        for on in SimdLevel::available() {
            let class = super::class(on, words, levels);
            assert_eq!(class, plainly(words, levels), "{on}: {words:x?}");
        }
        plainly(words, levels)
    }

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
        // One word in the first and the last place of the gap.
        for inside in [64, 8 * 32 - 1] {
            assert_eq!(class(&block(|i| [0, inside, 288][i as usize % 3]), 3), 1);
        }
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

    /// Words around a few centres, of all spreads: every class comes.
    #[test]
    fn lanes_say_what_is_said_plainly() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state as u32
        };
        let mut seen = [0; 4];
        for case in 0..4000 {
            let centers = [next(), next(), next()];
            let (kinds, spread) = (1 + case % 3, 1 << (next() % 24));
            let words = block(|_| 0).map(|_| {
                let center = centers[(next() % kinds) as usize];
                center.wrapping_add(next() % spread)
            });
            seen[usize::from(class(&words, 3))] += 1;
        }
        assert!(seen.iter().all(|n| *n > 300), "{seen:?}");
    }

    #[test]
    fn stencil_is_the_high_byte_and_depth_must_leave_it_free() {
        let depth = block(|i| 0x12_3456 + (i % 3));
        let mut stencil = [0xab; 64];
        stencil[63] = 0x7f;
        let words = block(|i| u32::from(stencil[i as usize]) << 24 | depth[i as usize]);
        for on in SimdLevel::available() {
            let found = depth_stencil_class(on, &depth, &stencil);
            assert_eq!(found, plainly(&words, 3));
            let mut float = depth;
            float[17] = DEPTH + 1;
            assert_eq!(depth_stencil_class(on, &float, &stencil), RAW);
            float[17] = DEPTH;
            assert_eq!(
                depth_stencil_class(on, &float, &[0; 64]),
                plainly(&float, 3)
            );
        }
    }
}
