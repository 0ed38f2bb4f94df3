//! Occlusion maps: shadows of occluders on a plane, convolved with a square light.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes};

use crate::bounded::bounded_uniforms;
use crate::soft_volumes::texel_of;

/// Most taps to a side of a texel.
pub const MOST_REACH: u32 = 1024;

/// The mean over a box along one axis, within one cell of an atlas in texture 0: the
/// square is a box across and a box down (§6.2.1). Beyond the cell nothing is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxAlong {
    /// First column and row of the cell.
    pub low: [u32; 2],
    /// Texels along a side of the cell.
    pub side: u32,
    /// 0 across, 1 down.
    pub axis: u32,
    /// Width of the box, texels; a narrower one than a texel is one texel.
    pub width: f32,
    /// Texels to each side that the box reaches.
    pub reach: u32,
}
bounded_uniforms!(BoxAlong { low, side, axis, width, reach }: |it| [
    ("reach", it.reach.into(), MOST_REACH.into()),
    ("axis", it.axis.into(), 1),
    ("side", it.side.into(), 8192),
]);

impl FragmentShader for BoxAlong {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let axis = self.axis as usize;
        let own = if axis == 0 { f.column() } else { f.row() };
        let low = self.low[axis.min(1)] as i32;
        let (first, end) = (I32::splat(l, low), I32::splat(l, low + self.side as i32));
        let width = if self.width > 1.0 { self.width } else { 1.0 };
        let zero = F32::splat(l, 0.0);
        let mut sum = zero;
        for tap in -(self.reach as i32)..=self.reach as i32 {
            let share = width * 0.5 + 0.5 - tap.unsigned_abs() as f32;
            let share = if share < 1.0 { share } else { 1.0 };
            if share <= 0.0 {
                continue;
            }
            let along = own + I32::splat(l, tap);
            let inside = along.ge(first) & along.lt(end);
            let at = if axis == 0 {
                [along, f.row(), I32::splat(l, 0)]
            } else {
                [f.column(), along, I32::splat(l, 0)]
            };
            let texel = texel_of(l, f, 0, at)[0];
            sum = sum + inside.select_f32(texel, zero) * share;
        }
        f.set_color(0, [sum / width, zero, zero, zero]);
    }
}
