//! Samples of a pixel resolved: their mean, in linear light.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each4;
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::soft_volumes::texel_of;

/// The mean of the `side` × `side` texels of texture 0 that a pixel covers: added row by
/// row from the first, then divided once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxResolve {
    /// Samples along a side of a pixel.
    pub side: u32,
}
uniforms!(BoxResolve { side });

impl FragmentShader for BoxResolve {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let side = self.side as i32;
        let lanes = I32::splat(l, side);
        let (x, y) = (f.column() * lanes, f.row() * lanes);
        let mut sum = [F32::splat(l, 0.0); 4];
        for row in 0..side {
            for column in 0..side {
                let at = [
                    x + I32::splat(l, column),
                    y + I32::splat(l, row),
                    I32::splat(l, 0),
                ];
                let texel = texel_of(l, f, 0, at);
                sum = each4(
                    #[inline(always)]
                    |c| sum[c] + texel[c],
                );
            }
        }
        let count = F32::splat(l, (side * side) as f32);
        let mean = each4(
            #[inline(always)]
            |c| sum[c] / count,
        );
        f.set_color(0, mean);
    }
}
