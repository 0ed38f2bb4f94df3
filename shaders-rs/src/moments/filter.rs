//! Means over kernels of a light view, and the bounds that follow.

use std::sync::Arc;

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, Lanes, uniforms};

use super::Moments;
use crate::convolution::look_up::{Images, IntegerTables, Prefiltered, Rectangle, TexelBox};
use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, ShadowFilter, kernel, mean_blocker};
use crate::vector::each2;

/// Summed-area tables of functions of depth, and how they are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentTables {
    /// The functions.
    pub moments: Moments,
    /// The tables' form.
    pub tables: IntegerTables,
    /// Where they are: function i in tile i.
    pub images: Images,
    /// The least variance that is told from none.
    pub least: f32,
}
uniforms!(MomentTables {
    moments,
    tables,
    images,
    least
});

impl MomentTables {
    /// A kernel of these half widths round a receiver, in texels of the view.
    #[inline(always)]
    pub(super) fn window<L: Lanes>(
        &self,
        l: L,
        mapping: &LightMapping,
        centre: [F32<L>; 2],
        half: [F32<L>; 2],
    ) -> TexelBox<L> {
        let texel = 1.0 / mapping.size as f32;
        let rectangle = Rectangle {
            centre: each2(
                #[inline(always)]
                |k| centre[k] * texel,
            ),
            half: each2(
                #[inline(always)]
                |k| half[k] * texel,
            ),
        };
        self.tables.window(l, &rectangle)
    }

    /// The means over a window.
    #[inline(always)]
    pub(super) fn means<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        window: &TexelBox<L>,
    ) -> [F32<L>; 4] {
        let mut means = [F32::splat(l, 0.0); 4];
        let count = self.moments.count();
        for (tile, mean) in means.iter_mut().enumerate().take(count) {
            *mean = self.tables.mean(l, f, &self.images, tile, window);
        }
        means
    }

    /// The bound over a kernel; what of it is outside the picture is empty.
    #[inline(always)]
    pub(super) fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        receiver: &Receiver<L>,
        window: &TexelBox<L>,
    ) -> F32<L> {
        let one = F32::splat(l, 1.0);
        let share = IntegerTables::share(window);
        let inside = share.gt(F32::splat(l, 0.0));
        f.discard(!inside);
        if !(inside & f.live()).any() {
            return one;
        }
        let means = self.means(l, f, window);
        let visible = self
            .moments
            .visible(l, means, receiver.reference, self.least);
        one - (one - visible.clamp(0.0, 1.0)) * share
    }
}

/// A kernel of one width for all receivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedKernel {
    /// Half its width, in texels.
    pub half: f32,
    /// What is filtered.
    pub tables: MomentTables,
}
uniforms!(FixedKernel { half, tables });

impl ShadowFilter for FixedKernel {
    fn textures(&self) -> usize {
        1
    }

    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let half = F32::splat(l, self.half);
        let window = self.tables.window(l, mapping, receiver.at, [half; 2]);
        self.tables.lit(l, f, receiver, &window)
    }
}

/// A kernel as wide as the light seems through the mean blocker, which is looked for at
/// points, as percentage-closer soft shadows do (Lauritzen 2007).
#[derive(Clone, Debug, PartialEq)]
pub struct LightKernel {
    /// Half width of the light along the picture's axes, world units.
    pub light_half: [f32; 2],
    /// Where blockers are looked for, in -1..1 of the search's half widths.
    pub search: Arc<[[f32; 2]]>,
    /// What is filtered.
    pub tables: MomentTables,
}
uniforms!(LightKernel {
    light_half,
    search,
    tables
});

impl ShadowFilter for LightKernel {
    fn textures(&self) -> usize {
        1
    }

    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let light_half = self.light_half;
        let (some, distance) = mean_blocker(l, f, mapping, receiver, light_half, &self.search);
        f.discard(!some);
        if !(some & f.live()).any() {
            return F32::splat(l, 1.0);
        }
        let half = kernel(mapping, light_half, distance, receiver);
        let window = self.tables.window(l, mapping, receiver.at, half);
        self.tables.lit(l, f, receiver, &window)
    }
}
