//! Level of detail (`docs/texture-rules.md`, §3).

use crate::math;
use crate::simd::{F32, I32, Lanes, Mask};
use crate::state::{FilterMode, Sampler};

/// What the level of detail comes from.
#[derive(Clone, Copy)]
pub(crate) enum Detail<L: Lanes> {
    /// The change of the coordinate inside 2×2 quads.
    Quads,
    /// The change of the coordinate from pixel to pixel, in x and y.
    Gradients([[F32<L>; 3]; 2]),
    /// The level itself.
    Level(F32<L>),
}

/// ½·log₂ of the larger squared length of two gradients, in texels of level 0.
#[inline(always)]
pub(super) fn from_gradients<L: Lanes>(
    size: [u32; 3],
    axes: usize,
    gradients: [[F32<L>; 3]; 2],
) -> F32<L> {
    let [x, y] = [
        squared(size, axes, gradients[0]),
        squared(size, axes, gradients[1]),
    ];
    math::log2(x.max(y)) * 0.5
}

#[inline(always)]
fn squared<L: Lanes>(size: [u32; 3], axes: usize, gradient: [F32<L>; 3]) -> F32<L> {
    let first = gradient[0] * size[0] as f32;
    let mut sum = first * first;
    for k in 1..axes {
        let d = gradient[k] * size[k] as f32;
        sum = sum + d * d;
    }
    sum
}

/// Which levels each lane reads, and how.
pub(super) struct Levels<L: Lanes> {
    /// The level read by every lane.
    pub(super) first: I32<L>,
    /// Weight of the level after it; where 0, that one is not read.
    pub(super) fraction: F32<L>,
    /// Lanes that filter linearly inside a level.
    pub(super) linear: Mask<L>,
}

impl<L: Lanes> Levels<L> {
    /// For a limited level of detail and a texture of `levels` mip levels.
    #[inline(always)]
    pub(super) fn select(sampler: &Sampler, lod: F32<L>, levels: u32) -> Self {
        let l = lod.lanes();
        let magnify = lod.le(F32::splat(l, 0.0));
        let mag = Mask::splat(l, sampler.mag == FilterMode::Linear);
        let min = Mask::splat(l, sampler.min == FilterMode::Linear);
        let linear = (magnify & mag) | (!magnify & min);
        let last = (levels - 1) as f32;
        if sampler.mip == FilterMode::Nearest {
            let first = (lod + 0.5).floor().clamp(0.0, last).to_i32();
            return Self {
                first,
                fraction: F32::splat(l, 0.0),
                linear,
            };
        }
        let limited = lod.clamp(0.0, last);
        let floor = limited.floor();
        Self {
            first: floor.to_i32(),
            fraction: limited - floor,
            linear,
        }
    }
}

/// The level of detail after bias and the sampler's limits.
#[inline(always)]
pub(super) fn limited<L: Lanes>(sampler: &Sampler, lod: F32<L>, bias: f32) -> F32<L> {
    (lod + bias).clamp(sampler.lod[0], sampler.lod[1])
}
