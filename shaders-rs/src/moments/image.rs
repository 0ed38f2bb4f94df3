//! Functions of depth as images of integers, one to a tile, for exact summed-area
//! tables.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes};

use super::Moments;
use crate::bounded::bounded_uniforms;
use crate::convolution::Encoding;
use crate::convolution::basis::{Source, set_integer};
use crate::soft_volumes::reads;

/// One function of the depths in texture 0, to attachment 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentImage {
    /// The functions.
    pub moments: Moments,
    /// Which of them.
    pub number: usize,
    /// Where depth comes from.
    pub source: Source,
    /// How values are stored.
    pub encoding: Encoding,
}
bounded_uniforms!(MomentImage { moments, number, source, encoding }: |i| [
    ("the number of a function", i.number as u64, 3),
]);

impl FragmentShader for MomentImage {
    fn outputs(&self) -> FragmentOutputs {
        reads(1)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (depth, some) = self.source.depth(l, f);
        let values = self.moments.of(l, depth);
        let value = values[self.number].clamp(0.0, 1.0);
        let stored = some.select_f32(self.encoding.store(value), F32::splat(l, 0.0));
        set_integer(f, 0, stored);
    }
}
