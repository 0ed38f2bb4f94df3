//! Which texels may have patches on the light.

use gnomon_raster::math::log2;
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use super::{Backprojection, MOST_REFINEMENTS};
use crate::convolution::prefilter::texel_at;
use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, kernel};
use crate::soft_volumes::reads;
use crate::vector::each2;

/// A texel of the next level of a pyramid: the least of the four under it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeastOfFour {
    /// The level that is read.
    pub mip: u32,
}
uniforms!(LeastOfFour { mip });

impl FragmentShader for LeastOfFour {
    fn outputs(&self) -> FragmentOutputs {
        reads(1)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let one = I32::splat(l, 1);
        let [x, y] = [f.column() << 1, f.row() << 1];
        let mut least = texel_at(l, f, 0, [x, y], self.mip)[0];
        for at in [[x + one, y], [x, y + one], [x + one, y + one]] {
            least = least.min(texel_at(l, f, 0, at, self.mip)[0]);
        }
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [least, zero, zero, zero]);
    }
}

/// A square of texels round a receiver.
#[derive(Clone, Copy)]
pub struct Region<L: Lanes> {
    /// Half its width and height, in texels.
    pub half: [F32<L>; 2],
    /// Receivers before which something is nearer to the light.
    pub some: Mask<L>,
}

impl<L: Lanes> Region<L> {
    /// As wide as the light seems at the view's near distance, then at the least depth
    /// that is found in there.
    #[inline(always)]
    pub(super) fn find<C>(
        l: L,
        f: &mut Fragment<'_, L>,
        by: &Backprojection<C>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> Self {
        let near = F32::splat(l, mapping.range.near);
        let mut half = kernel(mapping, by.light_half, near, receiver);
        let mut some = Mask::splat(l, true);
        for _ in 0..by.refinements.min(MOST_REFINEMENTS) {
            let least = least_depth(l, f, by.pyramid, mapping.size, receiver.at, half);
            some = some & least.lt(receiver.reference);
            if !(some & f.live()).any() {
                break;
            }
            let nearest = mapping.range.distance(least.min(receiver.reference));
            let smaller = kernel(mapping, by.light_half, nearest, receiver);
            half = each2(
                #[inline(always)]
                |k| half[k].min(smaller[k]),
            );
        }
        Self { half, some }
    }
}

/// How much wider regions are taken than they are, so that rounding loses no texel.
const WIDER: f32 = 1.001;

/// The least depth of a region, or less: from the finest level on which it is no wider
/// than a texel, and so touches four at most.
#[inline(always)]
fn least_depth<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    slot: usize,
    side: u32,
    at: [F32<L>; 2],
    half: [F32<L>; 2],
) -> F32<L> {
    let size = side as f32;
    let low = each2(
        #[inline(always)]
        |k| (at[k] - half[k] * WIDER).clamp(0.0, size),
    );
    let high = each2(
        #[inline(always)]
        |k| (at[k] + half[k] * WIDER).clamp(0.0, size),
    );
    let width = (high[0] - low[0]).max(high[1] - low[1]);
    let lod = log2(width.clamp(1.0, size) * WIDER).ceil();
    let lod = lod.min(F32::splat(l, side.trailing_zeros() as f32));
    let texel = power_of_two(l, lod.to_i32());
    let first = each2(
        #[inline(always)]
        |k| (low[k] / texel).floor(),
    );
    let last = each2(
        #[inline(always)]
        |k| {
            let most = F32::splat(l, size) / texel - 1.0;
            (high[k] / texel).floor().min(most).max(first[k])
        },
    );
    let scale = texel * (1.0 / size);
    let zero = F32::splat(l, 0.0);
    let mut least = F32::splat(l, 1.0);
    for y in [first[1], last[1]] {
        for x in [first[0], last[0]] {
            let place = [(x.min(last[0]) + 0.5) * scale, (y + 0.5) * scale, zero];
            least = least.min(f.sample_level(slot, place, lod)[0]);
        }
    }
    least
}

/// 2ⁿ for 0 ≤ n < 128.
#[inline(always)]
pub(super) fn power_of_two<L: Lanes>(l: L, n: I32<L>) -> F32<L> {
    ((n + I32::splat(l, 127)) << 23).to_u32().to_f32_bits()
}
