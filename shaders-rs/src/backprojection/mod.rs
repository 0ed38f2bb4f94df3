//! Soft shadows by backprojection: each texel of a light view that is nearer to the light
//! than the receiver is a small patch, projected from the receiver on the light
//! (docs/papers.md, baselines).
//!
//! * [`patches`]: the patches of a receiver, and how gaps between them are filled
//! * [`region`]: which texels have patches on the light, by a pyramid of least depths
//! * [`cover`]: what patches hide: the sum of their areas (Guennebaud et al. 2006), or
//!   bits of a field over the light (Schwarz and Stamminger 2007)
//! * [`turned`]: the same with a field of which no two bits are in line
//!
//! In tangents the light, seen from a receiver at distance d through the plane at
//! distance z, is a rectangle of half width `h (1/z - 1/d)` round the receiver's own
//! place. So a texel's borders, less the receiver's place and over that, are its patch
//! where the light is -1..=1. It is exact for lights parallel to the picture, whatever
//! way the receiver faces.

pub mod cover;
pub mod patches;
pub mod region;
pub mod turned;

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, Lanes, uniforms};

use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, ShadowFilter};
use cover::LightCover;
use patches::Gaps;
use region::Region;

/// Receivers whose patches hid more than all of the light and were taken to hide it all.
pub const MORE_THAN_ALL: &str = "hidden-more-than-once";

/// More than all, but for rounding.
const ALL: f32 = 1.001;

/// Most times that a region is made smaller: uniforms of a file may ask for any number.
pub const MOST_REFINEMENTS: u32 = 8;

/// Projects texels on the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backprojection<C> {
    /// Half width of the light along the picture's axes, world units.
    pub light_half: [f32; 2],
    /// Slot of the pyramid of least depths.
    pub pyramid: usize,
    /// Times that the region of texels is made smaller by what is nearest in it.
    pub refinements: u32,
    /// What becomes of gaps between patches.
    pub gaps: Gaps,
    /// What patches hide.
    pub cover: C,
}
uniforms!(Backprojection<C> {
    light_half,
    pyramid,
    refinements,
    gaps,
    cover
});

impl<C: LightCover> ShadowFilter for Backprojection<C> {
    fn textures(&self) -> usize {
        1
    }

    fn counts(&self) -> &'static [&'static str] {
        &[MORE_THAN_ALL]
    }

    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let one = F32::splat(l, 1.0);
        let region = Region::find(l, f, self, mapping, receiver);
        f.discard(!region.some);
        if !(region.some & f.live()).any() {
            return one;
        }
        let covered = self.covered(l, f, mapping, receiver, &region);
        let hidden = self.cover.hidden(l, &covered);
        f.count(0, region.some & hidden.gt(F32::splat(l, ALL)));
        (one - hidden).clamp(0.0, 1.0)
    }
}
