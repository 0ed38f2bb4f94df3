//! Depth of fragments, block ranges and the depth comparison (rules §5, §7).

use super::target::TileTarget;
pub(super) use crate::depth_plane::DepthBlock;
use crate::depth_plane::{D24_FRACTION, D24_HALF};
use crate::geometry::{D24_BASE_LIMIT, D24_SCALE, Triangle};
use crate::simd::{F32, F64, I32, LANES, Lanes, round_to_i32};
use crate::state::CompareFunction;
use crate::texture::Block;

impl<const D24: bool> DepthBlock<D24> {
    #[inline(always)]
    pub(super) fn new(t: &Triangle, x: u32, y: u32, range: [i32; 2]) -> Self {
        Self::at_depth(t, t.depth_base(x, y) + t.bias, range)
    }

    #[inline(always)]
    fn at_depth(t: &Triangle, base: f64, range: [i32; 2]) -> Self {
        let steep = (D24 && t.is_steep()).then_some([base, t.zx, t.zy]);
        let base = if D24 {
            let b = base * D24_SCALE;
            let b = if b < D24_BASE_LIMIT {
                b
            } else {
                D24_BASE_LIMIT
            };
            round_to_i32(if b > -D24_BASE_LIMIT {
                b
            } else {
                -D24_BASE_LIMIT
            })
        } else {
            (base as f32).to_bits() as i32
        };
        Self {
            base,
            slope: t.slope,
            range,
            steep,
        }
    }

    /// The block whose `base` a [`GroupDepth`] has found.
    #[inline(always)]
    pub(super) fn with_base(t: &Triangle, base: i32, range: [i32; 2]) -> Self {
        Self {
            base,
            slope: t.slope,
            range,
            steep: None,
        }
    }

    /// Pixels of the block at (x, y) whose depth, before bias and clamping, is not
    /// beyond the far end of the viewport's range (rules §4).
    #[inline(always)]
    pub(super) fn not_beyond_far<L: Lanes>(
        l: L,
        t: &Triangle,
        x: u32,
        y: u32,
        range: [i32; 2],
        reversed: bool,
    ) -> u64 {
        let plane = Self::at_depth(t, t.depth_base(x, y), range);
        let far = range[usize::from(!reversed)];
        let mut m = 0;
        for k in 0..4 {
            let z = plane.raw_packet(l, k);
            let within = match (D24, reversed) {
                (true, false) => z.le(I32::splat(l, far)),
                (true, true) => z.ge(I32::splat(l, far)),
                (false, false) => z
                    .to_u32()
                    .to_f32_bits()
                    .le(F32::splat(l, f32::from_bits(far as u32))),
                (false, true) => z
                    .to_u32()
                    .to_f32_bits()
                    .ge(F32::splat(l, f32::from_bits(far as u32))),
            };
            m |= u64::from(within.bits()) << (16 * k);
        }
        m
    }
}

/// Pixels from the group's origin to each block's.
const GROUP_DX: [f64; LANES] = [
    0., 8., 0., 8., 16., 24., 16., 24., 0., 8., 0., 8., 16., 24., 16., 24.,
];
const GROUP_DY: [f64; LANES] = [
    0., 0., 8., 8., 0., 0., 8., 8., 16., 16., 24., 24., 16., 16., 24., 24.,
];

/// The same for the 16 blocks of a group.
pub(super) struct GroupDepth<L: Lanes, const D24: bool> {
    base: I32<L>,
    slope: [i32; 2],
    range: [i32; 2],
}

impl<L: Lanes, const D24: bool> GroupDepth<L, D24> {
    /// Planes over the blocks of the group at block (gx, gy) of the tile.
    #[inline(always)]
    pub(super) fn new(
        l: L,
        t: &Triangle,
        target: &TileTarget<'_>,
        [gx, gy]: [i32; 2],
        range: [i32; 2],
    ) -> Self {
        // Exact in any order: numbers of 24 bits with 8 behind the point.
        let x = f64::from(target.x as i32 + 8 * gx) + 0.5 - f64::from(t.x) * (1.0 / 256.0);
        let y = f64::from(target.y as i32 + 8 * gy) + 0.5 - f64::from(t.y) * (1.0 / 256.0);
        let dx = F64::from_array(l, &GROUP_DX) + x;
        let dy = F64::from_array(l, &GROUP_DY) + y;
        let along = F64::splat(l, t.zx) * dx + F64::splat(l, t.zy) * dy;
        let z = (F64::splat(l, f64::from(t.z)) + along) + t.bias;
        let base = if D24 {
            (z * D24_SCALE).round_to_i32(D24_BASE_LIMIT)
        } else {
            z.to_f32().raw_bits().to_i32()
        };
        Self {
            base,
            slope: t.slope,
            range,
        }
    }

    /// The blocks' bases.
    #[inline(always)]
    pub(super) fn bases(&self) -> [i32; LANES] {
        self.base.to_array()
    }

    /// Clamped depth at one and the same pixel of every block.
    #[inline(always)]
    fn at(&self, [ix, iy]: [i32; 2]) -> I32<L> {
        let l = self.base.l;
        if D24 {
            let offset = self.slope[0] * ix + self.slope[1] * iy + D24_HALF;
            let z = (self.base + I32::splat(l, offset)) >> D24_FRACTION;
            z.max(I32::splat(l, self.range[0]))
                .min(I32::splat(l, self.range[1]))
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            let ([sx, sy], [lo, hi]) = (
                [f(self.slope[0]), f(self.slope[1])],
                [f(self.range[0]), f(self.range[1])],
            );
            let z = (self.base.to_u32().to_f32_bits() + sx * ix as f32) + sy * iy as f32;
            z.clamp(lo, hi).raw_bits().to_i32()
        }
    }

    /// Smallest and largest clamped depth of each block.
    #[inline(always)]
    pub(super) fn span(&self) -> [I32<L>; 2] {
        let corner = |k: usize, far: i32| {
            if (self.slope[k] < 0) == (far == 0) {
                7
            } else {
                0
            }
        };
        [
            self.at([corner(0, 0), corner(1, 0)]),
            self.at([corner(0, 1), corner(1, 1)]),
        ]
    }
}

/// What zmin/zmax say about the depth tests of a group's blocks.
#[derive(Clone, Copy, Default)]
pub(super) struct Decisions {
    pub(super) pass: u16,
    pub(super) fail: u16,
}

impl Decisions {
    #[inline(always)]
    pub(super) fn of(self, i: usize) -> Decision {
        if self.pass >> i & 1 != 0 {
            Decision::Pass
        } else if self.fail >> i & 1 != 0 {
            Decision::Fail
        } else {
            Decision::Unknown
        }
    }
}

/// Rules §7.1 for 16 blocks: ranges [a, b] against stored [min, max].
#[inline(always)]
pub(super) fn decide_group<L: Lanes>(
    compare: CompareFunction,
    [a, b]: [I32<L>; 2],
    [min, max]: [I32<L>; 2],
) -> Decisions {
    let apart = b.lt(min) | a.gt(max);
    let same = a.eq(b) & min.eq(max) & a.eq(min);
    let (pass, fail) = match compare {
        CompareFunction::Less => (b.lt(min), a.ge(max)),
        CompareFunction::LessEqual => (b.le(min), a.gt(max)),
        CompareFunction::Greater => (a.gt(max), b.le(min)),
        CompareFunction::GreaterEqual => (a.ge(max), b.lt(min)),
        CompareFunction::Equal => (same, apart),
        CompareFunction::NotEqual => (apart, same),
        CompareFunction::Never | CompareFunction::Always => return Decisions::default(),
    };
    Decisions {
        pass: pass.bits(),
        fail: fail.bits() & !pass.bits(),
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
pub(super) fn decide(compare: CompareFunction, [a, b]: [i32; 2], [min, max]: [i32; 2]) -> Decision {
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
    let words: &mut [u32; LANES] = (&mut b.0[16 * k..16 * k + 16])
        .try_into()
        .expect("16 of 64");
    let old = crate::simd::U32::from_array(l, words);
    crate::simd::Mask::from_bits(l, mask)
        .select_u32(z.to_u32(), old)
        .store(words);
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
pub(super) fn block_range<L: Lanes>(l: L, b: &Block<u32>, inside: u64) -> [i32; 2] {
    let mut min = I32::splat(l, i32::MAX);
    let mut max = I32::splat(l, 0);
    for k in 0..4 {
        let z = load(l, b, k);
        let valid = crate::simd::Mask::from_bits(l, (inside >> (16 * k)) as u16);
        min = min.min(valid.select_i32(z, I32::splat(l, i32::MAX)));
        max = max.max(valid.select_i32(z, I32::splat(l, 0)));
    }
    [min.reduce_min(), max.reduce_max()]
}
