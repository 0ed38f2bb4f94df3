//! Coverage from a four-dimensional texture, split over 8-bit buffers (paper IV, §4.2.2:
//! the shader for textured lights).

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes, uniforms};

use super::{Halves, split};
use crate::coverage::{Edge, Projector, clip};
use crate::soft_volumes::{Covering, HardPlane, own_texels, reads, receiver};

/// The penumbra of one edge. Textures: positions, one that is not read, and those of the
/// covering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitTextured<C> {
    /// The light.
    pub light: Projector,
    /// How coverage is found.
    pub covering: C,
    /// The edge, in the light's coordinates.
    pub edge: Edge,
    /// What side of its hard shadow quad a fragment is on.
    pub plane: HardPlane,
    /// Where the coverage goes: with both halves that of the first colour alone; else the
    /// colours' to an attachment each.
    pub halves: Halves,
    /// How many colours have buffers, 1 or 3.
    pub colors: u32,
}
uniforms!(SplitTextured<C> { light, covering, edge, plane, halves, colors });

impl<C: Covering> FragmentShader for SplitTextured<C> {
    fn outputs(&self) -> FragmentOutputs {
        reads(C::TEXTURES)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [position] = own_texels(l, f, 1);
        let (from, shadowable) = receiver(l, position, self.light.origin());
        let projected = self.light.project(l, from, &self.edge);
        let mut segment = clip(l, self.light.image(), &projected);
        segment.some = segment.some & shadowable;
        let share = self.covering.share(l, f, &self.light, &segment);
        let inside = self.plane.umbra_side(l, from);
        let zero = F32::splat(l, 0.0);
        let [first, ..] = share;
        match self.halves {
            Halves::Both => {
                f.set_color(0, split(l, inside.select_f32(first, zero)));
                f.set_color(1, split(l, inside.select_f32(zero, first)));
            }
            Halves::Inner | Halves::Outer => {
                let wanted = if self.halves == Halves::Inner {
                    inside
                } else {
                    !inside
                };
                for i in 0..(self.colors as usize).min(3) {
                    f.set_color(i, split(l, wanted.select_f32(share[i], zero)));
                }
            }
        }
    }
}
