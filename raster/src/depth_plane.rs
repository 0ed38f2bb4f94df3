//! The depth of a triangle over one 8×8 block (rules §5): what the tile stage tests and a
//! fragment shader may read.

use crate::format::D24_MAX;
use crate::simd::{F32, I32, LANES, Lanes, each4, round_to_i32};
use crate::texture::PACKETS;

/// D24 depth planes carry this many fractional bits.
pub(crate) const D24_FRACTION: u32 = 5;
/// Limit of a steep plane's depth: far outside of any range, well inside of 32 bits.
const STEEP_LIMIT: f64 = 1_073_741_824.0;
/// Half a D24 step in the fraction of D24 planes.
pub(crate) const D24_HALF: i32 = 1 << (D24_FRACTION - 1);

const IX: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7];
const IY: [i32; LANES] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];

/// A triangle's depth over one 8×8 block: `base` is the D24 integer with its
/// fraction, or the bits of a float.
#[derive(Clone, Copy)]
pub(crate) struct DepthBlock<const D24: bool> {
    pub(crate) base: i32,
    pub(crate) slope: [i32; 2],
    pub(crate) range: [i32; 2],
    /// Base and gradients in doubles, of a plane too steep for fixed point.
    pub(crate) steep: Option<[f64; 3]>,
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
    pub(crate) const UNUSED: Self = Self {
        base: 0,
        slope: [0; 2],
        range: [0; 2],
        steep: None,
    };

    /// As a fragment shader sees it.
    #[inline(always)]
    pub(crate) fn for_shader(&self) -> ShaderDepth {
        let Self {
            base,
            slope,
            range,
            steep,
        } = *self;
        if D24 {
            ShaderDepth::D24(DepthBlock {
                base,
                slope,
                range,
                steep,
            })
        } else {
            ShaderDepth::Float(DepthBlock {
                base,
                slope,
                range,
                steep,
            })
        }
    }

    /// Depth of one pixel of a steep plane (rules §5).
    fn steep_at([base, gx, gy]: [f64; 3], ix: i32, iy: i32) -> i32 {
        let z = ((base + gx * f64::from(ix)) + gy * f64::from(iy)) * f64::from(D24_MAX);
        let z = if z < STEEP_LIMIT { z } else { STEEP_LIMIT };
        round_to_i32(if z > -STEEP_LIMIT { z } else { -STEEP_LIMIT })
    }

    /// Depth of one pixel before clamping: an ordered integer (D24) or float bits.
    #[inline(always)]
    fn raw_at(&self, ix: i32, iy: i32) -> i32 {
        if let Some(plane) = self.steep {
            Self::steep_at(plane, ix, iy)
        } else if D24 {
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
            let z = if z > f(self.range[0]) {
                z
            } else {
                f(self.range[0])
            };
            (if z < f(self.range[1]) {
                z
            } else {
                f(self.range[1])
            })
            .to_bits() as i32
        }
    }

    /// Corner coordinates where the plane is smallest, and where it is largest.
    #[inline(always)]
    fn corners(&self) -> ([i32; 2], [i32; 2]) {
        // The sign bit of a float's bits and of an integer are in one place.
        let [fx, fy] = [self.slope[0] < 0, self.slope[1] < 0];
        let far = |falls: bool| if falls { 7 } else { 0 };
        ([far(fx), far(fy)], [far(!fx), far(!fy)])
    }

    /// Smallest and largest clamped depth of the block's 64 pixels.
    #[inline(always)]
    pub(crate) fn span(&self) -> [i32; 2] {
        let (lo, hi) = self.corners();
        [
            self.clamped(self.raw_at(lo[0], lo[1])),
            self.clamped(self.raw_at(hi[0], hi[1])),
        ]
    }

    /// Depths of packet `k` before clamping.
    #[inline(always)]
    pub(crate) fn raw_packet<L: Lanes>(&self, l: L, k: usize) -> I32<L> {
        let ix = I32::from_array(l, &IX);
        let iy = I32::from_array(l, &IY) + I32::splat(l, 2 * k as i32);
        if let Some(plane) = self.steep {
            let z = core::array::from_fn(|i| Self::steep_at(plane, IX[i], IY[i] + 2 * k as i32));
            I32::from_array(l, &z)
        } else if D24 {
            let z = ix * I32::splat(l, self.slope[0]) + iy * I32::splat(l, self.slope[1]);
            (z + I32::splat(l, self.base + D24_HALF)) >> D24_FRACTION
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            let [base, sx, sy] = [f(self.base), f(self.slope[0]), f(self.slope[1])];
            let z = (F32::splat(l, base) + ix.to_f32() * sx) + iy.to_f32() * sy;
            z.raw_bits().to_i32()
        }
    }

    /// Stored depths of packet `k`.
    #[inline(always)]
    pub(crate) fn packet<L: Lanes>(&self, l: L, k: usize) -> I32<L> {
        let raw = self.raw_packet(l, k);
        if D24 {
            raw.max(I32::splat(l, self.range[0]))
                .min(I32::splat(l, self.range[1]))
        } else {
            let f = |b: i32| f32::from_bits(b as u32);
            raw.to_u32()
                .to_f32_bits()
                .clamp(f(self.range[0]), f(self.range[1]))
                .raw_bits()
                .to_i32()
        }
    }

    /// Stored depths of all packets.
    #[inline(always)]
    pub(crate) fn packets<L: Lanes>(&self, l: L) -> [I32<L>; PACKETS] {
        if !D24 || self.steep.is_some() {
            return each4(
                #[inline(always)]
                |k| self.packet(l, k),
            );
        }
        // Integers wrap: sums are the same in any order.
        let [sx, sy] = self.slope;
        let across = I32::from_array(l, &IX) * I32::splat(l, sx);
        let first = (I32::from_array(l, &IY) * I32::splat(l, sy) + across)
            + I32::splat(l, self.base + D24_HALF);
        let [lo, hi] = self.range;
        each4(
            #[inline(always)]
            |k| {
                let z = (first + I32::splat(l, 2 * k as i32 * sy)) >> D24_FRACTION;
                z.max(I32::splat(l, lo)).min(I32::splat(l, hi))
            },
        )
    }
}
