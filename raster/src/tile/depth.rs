//! Depth of fragments, block ranges and the depth comparison (rules §5, §7).

use crate::format::D24_MAX;
use crate::geometry::{D24_BASE_LIMIT, D24_FRACTION, D24_SCALE, Triangle};
use crate::simd::{F32, I32, LANES, Lanes, round_to_i32};
use crate::state::CompareFunction;
use crate::texture::{Block, HizEntry};

/// Half a D24 step in the fraction of D24 planes.
const D24_HALF: i32 = 1 << (D24_FRACTION - 1);

const IX: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7];
const IY: [i32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];

/// A triangle's depth over one 8×8 block: `base` is the D24 integer with its
/// fraction, or the bits of a float.
#[derive(Clone, Copy)]
pub(crate) struct DepthBlock<const D24: bool> {
    base: i32,
    slope: [i32; 2],
    range: [i32; 2],
}

/// The same for a fragment shader, which does not care for the format.
#[derive(Clone, Copy)]
pub(crate) enum ShaderDepth {
    D24(DepthBlock<true>),
    Float(DepthBlock<false>),
}

impl ShaderDepth {
    /// Depths of packet `k` in 0..=1.
    #[inline(always)]
    pub(crate) fn packet<L: Lanes>(&self, l: L, k: usize) -> F32<L> {
        match self {
            Self::D24(b) => b.packet(l, k).to_f32() / D24_MAX as f32,
            Self::Float(b) => b.packet(l, k).to_u32().to_f32_bits(),
        }
    }
}

impl<const D24: bool> DepthBlock<D24> {
    /// Where nobody looks at depth.
    pub(crate) const UNUSED: Self = Self { base: 0, slope: [0; 2], range: [0; 2] };

    /// As a fragment shader sees it.
    #[inline(always)]
    pub(super) fn for_shader(&self) -> ShaderDepth {
        let Self { base, slope, range } = *self;
        if D24 {
            ShaderDepth::D24(DepthBlock { base, slope, range })
        } else {
            ShaderDepth::Float(DepthBlock { base, slope, range })
        }
    }

    #[inline(always)]
    pub(super) fn new(t: &Triangle, x: u32, y: u32, range: [i32; 2]) -> Self {
        let base = t.depth_base(x, y);
        let base = if D24 {
            let b = base * D24_SCALE;
            let b = if b < D24_BASE_LIMIT { b } else { D24_BASE_LIMIT };
            round_to_i32(if b > -D24_BASE_LIMIT { b } else { -D24_BASE_LIMIT })
        } else {
            (base as f32).to_bits() as i32
        };
        Self { base, slope: t.slope, range }
    }

    /// Depth of one pixel before clamping: an ordered integer (D24) or float bits.
    #[inline(always)]
    fn raw_at(&self, ix: i32, iy: i32) -> i32 {
        if D24 {
            (self.base + self.slope[0] * ix + self.slope[1] * iy + D24_HALF) >> D24_FRACTION
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            let z = (f(self.base) + f(self.slope[0]) * ix as f32) + f(self.slope[1]) * iy as f32;
            z.to_bits() as i32
        }
    }

    #[inline(always)]
    fn clamped(&self, raw: i32) -> i32 {
        if D24 {
            raw.max(self.range[0]).min(self.range[1])
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            let z = f(raw);
            let z = if z > f(self.range[0]) { z } else { f(self.range[0]) };
            (if z < f(self.range[1]) { z } else { f(self.range[1]) }).to_bits() as i32
        }
    }

    /// Corner coordinates where the plane is smallest, and where it is largest.
    #[inline(always)]
    fn corners(&self) -> ([i32; 2], [i32; 2]) {
        // The sign bit of a float's bits and of an integer are in one place.
        let falls = self.slope.map(|s| s < 0);
        (falls.map(|f| if f { 7 } else { 0 }), falls.map(|f| if f { 0 } else { 7 }))
    }

    /// Smallest and largest clamped depth of the block's 64 pixels.
    #[inline(always)]
    pub(super) fn range(&self) -> [i32; 2] {
        let (lo, hi) = self.corners();
        [self.clamped(self.raw_at(lo[0], lo[1])), self.clamped(self.raw_at(hi[0], hi[1]))]
    }

    /// Depths of packet `k` before clamping.
    #[inline(always)]
    fn raw_packet<L: Lanes>(&self, l: L, k: usize) -> I32<L> {
        let ix = I32::from_array(l, &IX);
        let iy = I32::from_array(l, &IY) + I32::splat(l, 2 * k as i32);
        if D24 {
            let z = ix * I32::splat(l, self.slope[0]) + iy * I32::splat(l, self.slope[1]);
            (z + I32::splat(l, self.base + D24_HALF)) >> D24_FRACTION
        } else {
            let [base, sx, sy] = [self.base, self.slope[0], self.slope[1]].map(|b| f32::from_bits(b as u32));
            let z = (F32::splat(l, base) + ix.to_f32() * sx) + iy.to_f32() * sy;
            z.to_bits().to_i32()
        }
    }

    /// Stored depths of packet `k`.
    #[inline(always)]
    pub(super) fn packet<L: Lanes>(&self, l: L, k: usize) -> I32<L> {
        let raw = self.raw_packet(l, k);
        if D24 {
            raw.max(I32::splat(l, self.range[0])).min(I32::splat(l, self.range[1]))
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            raw.to_u32().to_f32_bits().clamp(f(self.range[0]), f(self.range[1])).to_bits().to_i32()
        }
    }

    /// Pixels that are not beyond the far end, before clamping.
    #[inline(always)]
    pub(super) fn not_beyond_far<L: Lanes>(&self, l: L) -> u64 {
        let far: i32 = if D24 { D24_MAX as i32 } else { 1.0f32.to_bits() as i32 };
        let (_, hi) = self.corners();
        let largest = self.raw_at(hi[0], hi[1]);
        let all_near = if D24 { largest <= far } else { f32::from_bits(largest as u32) <= 1.0 };
        if all_near {
            return u64::MAX;
        }
        let mut m = 0;
        for k in 0..4 {
            let z = self.raw_packet(l, k);
            let near = if D24 {
                z.le(I32::splat(l, far))
            } else {
                z.to_u32().to_f32_bits().le(F32::splat(l, 1.0))
            };
            m |= u64::from(near.bits()) << (16 * k);
        }
        m
    }
}

/// What zmin/zmax say about a depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    Unknown,
    Pass,
    Fail,
}

/// Rules §7.1.
#[inline(always)]
pub(super) fn decide(compare: CompareFunction, [a, b]: [i32; 2], stored: HizEntry) -> Decision {
    let HizEntry { min, max } = stored;
    let (pass, fail) = match compare {
        CompareFunction::Less => (b < min, a >= max),
        CompareFunction::LessEqual => (b <= min, a > max),
        CompareFunction::Greater => (a > max, b <= min),
        CompareFunction::GreaterEqual => (a >= max, b < min),
        CompareFunction::Equal => (a == b && min == max && a == min, b < min || a > max),
        CompareFunction::NotEqual => (b < min || a > max, a == b && min == max && a == min),
        CompareFunction::Never | CompareFunction::Always => (false, false),
    };
    match (pass, fail) {
        (true, _) => Decision::Pass,
        (_, true) => Decision::Fail,
        _ => Decision::Unknown,
    }
}

/// Loads packet `k` of a depth block.
#[inline(always)]
pub(super) fn load<L: Lanes>(l: L, b: &Block<u32>, k: usize) -> I32<L> {
    let words: &[u32; LANES] = b.0[16 * k..16 * k + 16].try_into().expect("16 of 64");
    crate::simd::U32::from_array(l, words).to_i32()
}

/// Stores the lanes of `mask` to packet `k`.
#[inline(always)]
pub(super) fn store<L: Lanes>(l: L, b: &mut Block<u32>, k: usize, z: I32<L>, mask: u16) {
    let words: &mut [u32; LANES] = (&mut b.0[16 * k..16 * k + 16]).try_into().expect("16 of 64");
    if mask == u16::MAX {
        return z.to_u32().store(words);
    }
    let old = crate::simd::U32::from_array(l, words);
    crate::simd::Mask::from_bits(l, mask).select_u32(z.to_u32(), old).store(words);
}

/// Pixels that pass, from those that are less than and equal to the stored depth.
#[inline(always)]
pub(super) fn outcome(f: CompareFunction, less: u64, equal: u64) -> u64 {
    match f {
        CompareFunction::Never => 0,
        CompareFunction::Less => less,
        CompareFunction::Equal => equal,
        CompareFunction::LessEqual => less | equal,
        CompareFunction::Greater => !(less | equal),
        CompareFunction::NotEqual => !equal,
        CompareFunction::GreaterEqual => !less,
        CompareFunction::Always => u64::MAX,
    }
}

/// zmin and zmax of the pixels of `inside`.
#[inline(always)]
pub(super) fn block_range<L: Lanes>(l: L, b: &Block<u32>, inside: u64) -> HizEntry {
    let mut min = I32::splat(l, i32::MAX);
    let mut max = I32::splat(l, 0);
    for k in 0..4 {
        let z = load(l, b, k);
        let valid = crate::simd::Mask::from_bits(l, (inside >> (16 * k)) as u16);
        min = min.min(valid.select_i32(z, I32::splat(l, i32::MAX)));
        max = max.max(valid.select_i32(z, I32::splat(l, 0)));
    }
    HizEntry { min: min.reduce_min(), max: max.reduce_max() }
}
