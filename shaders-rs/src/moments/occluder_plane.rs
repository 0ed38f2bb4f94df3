//! Shadows of a plane that stands for all occluders: their mask, seen from the light's
//! centre, convolved with the image of the light as each receiver has it there
//! (Soler and Sillion 1998; docs/papers.md, baselines).

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, Lanes, uniforms};

use super::filter::MomentTables;
use crate::light_view::LightMapping;
use crate::shadow_maps::{Receiver, ShadowFilter, blocker, kernel};
use crate::vector::each2;

/// The share of the kernel that is free of occluders.
///
/// A receiver that the picture shows, or that is not behind the plane, is taken for one
/// of the occluders, and is lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OccluderPlane {
    /// Half width of the light along the picture's axes, world units.
    pub light_half: [f32; 2],
    /// The plane's distance along the view's axis, as the mapping has distances.
    pub distance: f32,
    /// By how much a texel may be nearer than the receiver that it shows, world units.
    pub own: f32,
    /// Tables of [`super::Moments::Mask`].
    pub tables: MomentTables,
}
uniforms!(OccluderPlane {
    light_half,
    distance,
    own,
    tables
});

impl OccluderPlane {
    /// Receivers that occluders can hide.
    #[inline(always)]
    fn behind<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> gnomon_raster::Mask<L> {
        let at = each2(
            #[inline(always)]
            |k| receiver.at[k].floor().to_i32(),
        );
        let nearer = Receiver {
            reference: mapping.range.scaled(receiver.distance - self.own),
            ..*receiver
        };
        let behind = receiver.distance.gt(F32::splat(l, self.distance));
        let (hidden, depth) = blocker(l, f, &nearer, at);
        // Nothing there, or something nearer.
        behind & (hidden | depth.ge(F32::splat(l, 1.0)) | outside(l, receiver, mapping))
    }
}

/// Receivers beside the picture.
#[inline(always)]
fn outside<L: Lanes>(
    l: L,
    receiver: &Receiver<L>,
    mapping: &LightMapping,
) -> gnomon_raster::Mask<L> {
    let (zero, size) = (F32::splat(l, 0.0), F32::splat(l, mapping.size as f32));
    let [x, y] = receiver.at;
    x.lt(zero) | x.ge(size) | y.lt(zero) | y.ge(size)
}

impl ShadowFilter for OccluderPlane {
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
        let behind = self.behind(l, f, mapping, receiver);
        f.discard(!behind);
        if !(behind & f.live()).any() {
            return F32::splat(l, 1.0);
        }
        let plane = F32::splat(l, self.distance);
        let half = kernel(mapping, self.light_half, plane, receiver);
        let window = self.tables.window(l, mapping, receiver.at, half);
        self.tables.lit(l, f, receiver, &window)
    }
}
