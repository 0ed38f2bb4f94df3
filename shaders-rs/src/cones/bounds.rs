//! Boxes of micro-patches: a tree over the points of a light view's picture. A node has
//! four children, since the points are a picture and no two of them share a texel; its
//! box bounds them in all three axes.
//!
//! Textures are bound whole, so a level cannot be written while another one of the same
//! texture is read. Odd levels are in one pair of textures and even ones in another.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::soft_volumes::texel_of_mip;

/// Level of a texture's first image; the levels of its others follow.
#[inline(always)]
pub(super) fn first_level(level: u32) -> u32 {
    2 - level % 2
}

/// One level of the boxes from the one below: low corners in attachment 0, high ones in
/// attachment 1; alpha is 1 where there is any patch, else 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchBounds {
    /// What is written, from 1. Level 1 reads patches in texture 0; others read low
    /// corners in texture 0 and high ones in texture 1.
    pub level: u32,
}
uniforms!(PatchBounds { level });

impl FragmentShader for PatchBounds {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: if self.level > 1 { 2 } else { 1 },
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let below = self.level.saturating_sub(1);
        let mip = match below {
            0 => 0,
            _ => below - first_level(below),
        };
        let two = I32::splat(l, 2);
        let (column, row) = (f.column() * two, f.row() * two);
        let mut low = [F32::splat(l, f32::INFINITY); 3];
        let mut high = [F32::splat(l, f32::NEG_INFINITY); 3];
        let zero = F32::splat(l, 0.0);
        let mut any = zero;
        for child in 0..4 {
            let at = [
                column + I32::splat(l, child % 2),
                row + I32::splat(l, child / 2),
                I32::splat(l, 0),
            ];
            let bottom = texel_of_mip(l, f, 0, at, mip);
            let top = match below {
                0 => bottom,
                _ => texel_of_mip(l, f, 1, at, mip),
            };
            let there = bottom[3].gt(zero);
            low = each3(
                #[inline(always)]
                |i| there.select_f32(low[i].min(bottom[i]), low[i]),
            );
            high = each3(
                #[inline(always)]
                |i| there.select_f32(high[i].max(top[i]), high[i]),
            );
            any = there.select_f32(F32::splat(l, 1.0), any);
        }
        let there = any.gt(zero);
        for (attachment, corner) in [low, high].into_iter().enumerate() {
            let [x, y, z] = each3(
                #[inline(always)]
                |i| there.select_f32(corner[i], zero),
            );
            f.set_color(attachment, [x, y, z, any]);
        }
    }
}
