//! The five stages of a pixel (§4.1): initial kernel, average blocker depth, final
//! kernel, visibility, sharpening.

use gnomon_raster::math::{exp, pow, sin_cos};
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, Lanes, uniforms};

use super::look_up::{Images, Prefiltered, Rectangle};
use super::{Expansion, MAX_TERMS};
use crate::light_view::{LightMapping, Projection};
use crate::shadow_maps::ReceiverPlanes;
use crate::soft_volumes::own_texels;
use crate::vector::each2;

/// `s^p, p = 1 + strength · exp(−falloff · (d − z_avg))` (Eq. 9), depths 0..=1 over
/// the light view's range. Strength 0 leaves visibility as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharpening {
    /// A.
    pub strength: f32,
    /// B.
    pub falloff: f32,
}
uniforms!(Sharpening { strength, falloff });

/// A steep receiver is nearer to the light over half of its kernel, and shadows itself
/// there. So its depth is lessened by a share of the depth that its plane gains over
/// half a kernel's width: `share · ∑ |slope| · half width`, and no more than `most`, since
/// the series has a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneOffset {
    /// How planes are seen in the view; they are in texture 4.
    pub planes: ReceiverPlanes,
    /// Share for kernels that look for the average depth.
    pub first: f32,
    /// Share for the last kernel.
    pub last: f32,
    /// Largest offset, depths being 0..=1 over the light view.
    pub most: f32,
}
uniforms!(PlaneOffset {
    planes,
    first,
    last,
    most
});

/// Slot of the receivers' planes.
const PLANES: usize = 4;

/// Name of the count of fragments whose 1 − s is below the threshold, and which are
/// lit for that.
pub const BELOW_THRESHOLD: &str = "lit-below-threshold";

/// Visibility of a rectangular light, to red of attachment 0.
///
/// Texture 0 holds positions (w is 0 where no shadow falls); slots of the images are
/// theirs, and planes, where they are looked at, are in slot 4. A fragment is discarded before any other look-up where nothing can be in
/// the light's way: no shadow falls there, it is not beyond the view's near distance,
/// or all of its first kernel is outside the view. It is discarded before the last
/// look-ups, and counted as [`BELOW_THRESHOLD`], where 1 − s is below the threshold.
/// The attachment must hold 1 before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvolutionShadow<P> {
    /// From world to light view.
    pub mapping: LightMapping,
    /// Half the light's width along the view's u and v, world units.
    pub light_half: [f32; 2],
    /// The expansion.
    pub expansion: Expansion,
    /// How means are found.
    pub prefiltered: P,
    /// CSM: cosines and sines.
    pub csm: Images,
    /// CSM-Z: the same times depth.
    pub csm_z: Images,
    /// Series depth.
    pub depth: Images,
    /// Least 1 − s that is no light.
    pub threshold: f32,
    /// Kernels after the first that the average depth is looked up again with.
    pub iterations: u32,
    /// Sharpening.
    pub sharpening: Sharpening,
    /// What a receiver's plane takes off its depth; nothing in the paper.
    pub plane_offset: Option<PlaneOffset>,
}
uniforms!(ConvolutionShadow<P> {
    mapping,
    light_half,
    expansion,
    prefiltered,
    csm,
    csm_z,
    depth,
    threshold,
    iterations,
    sharpening,
    plane_offset,
});

/// No kernel gets better after as many: uniforms of a file may ask for any number.
const MOST_ITERATIONS: u32 = 64;

/// The receiver's halves of the terms: 2/c_k · sin(c_k d) and 2/c_k · cos(c_k d).
type Terms<L> = [[F32<L>; 2]; MAX_TERMS];

impl<P: Prefiltered> ConvolutionShadow<P> {
    #[inline(always)]
    fn terms<L: Lanes>(&self, l: L, depth: F32<L>) -> Terms<L> {
        let mut terms = [[F32::splat(l, 0.0); 2]; MAX_TERMS];
        for (k, term) in terms.iter_mut().enumerate().take(self.expansion.terms) {
            let frequency = self.expansion.frequencies[k];
            let [sin, cos] = sin_cos(depth * frequency);
            let weight = 2.0 / frequency;
            *term = [sin * weight, cos * weight];
        }
        terms
    }

    /// Σ 2/c_k sin(c_k(d − z)), averaged over the window; for CSM-Z times z.
    #[inline(always)]
    fn series<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        images: &Images,
        terms: &Terms<L>,
        window: &P::Window<L>,
    ) -> F32<L> {
        let mut sum = F32::splat(l, 0.0);
        for tile in 0..self.expansion.tiles() {
            let [c0, s0, c1, s1] = self.prefiltered.four(l, f, images, tile, window);
            let [a, b] = [terms[2 * tile], terms[2 * tile + 1]];
            sum = sum + (a[0] * c0 - a[1] * s0);
            sum = sum + (b[0] * c1 - b[1] * s1);
        }
        sum
    }

    /// 1 − s: how much of the window is nearer than the receiver, neither limited
    /// nor reduced by what of it is outside the view.
    #[inline(always)]
    fn blocked<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        terms: &Terms<L>,
        window: &P::Window<L>,
    ) -> F32<L> {
        let sum = self.series(l, f, &self.csm, terms, window);
        sum * self.expansion.gain + self.expansion.bias
    }

    /// The numerator of Eq. 8, from the same expansion.
    #[inline(always)]
    fn blocked_depth<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        terms: &Terms<L>,
        window: &P::Window<L>,
    ) -> F32<L> {
        let mean = self.prefiltered.one(l, f, &self.depth, window);
        let sum = self.series(l, f, &self.csm_z, terms, window);
        sum * self.expansion.gain + mean * self.expansion.bias
    }

    /// What lies between the receiver and the light at the distance of a blocker.
    #[inline(always)]
    fn window<L: Lanes>(
        &self,
        l: L,
        uv: [F32<L>; 2],
        blocker: F32<L>,
        receiver: F32<L>,
    ) -> P::Window<L> {
        let [w, h] = self.light_half;
        let rectangle = Rectangle {
            centre: uv,
            half: [
                self.mapping.half_width(w, blocker, receiver),
                self.mapping.half_width(h, blocker, receiver),
            ],
        };
        self.prefiltered.window(l, &rectangle)
    }

    /// The change of the receiver's depth across the picture's width and height, depths
    /// being 0..=1 over the light view.
    #[inline(always)]
    fn slopes<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        position: [F32<L>; 3],
        distance: F32<L>,
    ) -> [F32<L>; 2] {
        let Some(offset) = &self.plane_offset else {
            return [F32::splat(l, 0.0); 2];
        };
        let plane = offset
            .planes
            .plane(l, f, &self.mapping, position, distance, PLANES);
        let size = self.mapping.size as f32;
        each2(
            #[inline(always)]
            |k| match plane.projection {
                Projection::Perspective => (plane.slope[k] * plane.depth).abs() * size,
                Projection::Orthographic => plane.slope[k].abs() * size,
            },
        )
    }

    /// A receiver's depth, 0..=1, as a kernel whose blockers are at `blocker` is to take
    /// it.
    #[inline(always)]
    fn lessened<L: Lanes>(
        &self,
        l: L,
        scaled: F32<L>,
        slopes: [F32<L>; 2],
        [blocker, receiver]: [F32<L>; 2],
        share: f32,
    ) -> F32<L> {
        let Some(offset) = &self.plane_offset else {
            return scaled;
        };
        let [w, h] = self.light_half;
        let [u, v] = [
            self.mapping.half_width(w, blocker, receiver),
            self.mapping.half_width(h, blocker, receiver),
        ];
        let gained = (slopes[0] * u + slopes[1] * v) * share;
        scaled
            - gained
                .max(F32::splat(l, 0.0))
                .min(F32::splat(l, offset.most))
    }

    #[inline(always)]
    fn sharpened<L: Lanes>(&self, l: L, visible: F32<L>, behind: F32<L>) -> F32<L> {
        if self.sharpening.strength == 0.0 {
            return visible;
        }
        let falloff = exp(behind * -self.sharpening.falloff);
        let power = falloff * self.sharpening.strength + F32::splat(l, 1.0);
        pow(visible, power).clamp(0.0, 1.0)
    }
}

impl<P: Prefiltered> FragmentShader for ConvolutionShadow<P> {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: if self.plane_offset.is_some() { 5 } else { 4 },
            counts: &[BELOW_THRESHOLD],
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let [position] = own_texels(l, f, 1);
        let [x, y, z, receives] = position;
        let at = self.mapping.locate(l, [x, y, z]);
        let range = &self.mapping.range;
        let scaled = range.scaled(at.distance);
        let finite = at.distance.lt(F32::splat(l, f32::INFINITY));
        let reached = receives.gt(zero) & at.belongs & scaled.gt(zero) & finite;
        f.discard(!reached);
        if !(reached & f.live()).any() {
            return;
        }
        let scaled = scaled.clamp(0.0, 1.0);
        let reach = self.expansion.reach;
        let receiver = reached.select_f32(at.distance, F32::splat(l, range.far));
        let slopes = self.slopes(l, f, [x, y, z], receiver);
        let shares = match &self.plane_offset {
            Some(offset) => [offset.first, offset.last],
            None => [0.0; 2],
        };
        let mut terms = self.terms(l, scaled * reach - self.expansion.offset);
        // Stages 1 and 2.
        let mut distance = F32::splat(l, range.near);
        let mut average = zero;
        let mut lit = !reached;
        for _ in 0..=self.iterations.min(MOST_ITERATIONS) {
            let window = self.window(l, at.uv, distance, at.distance);
            if self.plane_offset.is_some() {
                let less = self.lessened(l, scaled, slopes, [distance, receiver], shares[0]);
                terms = self.terms(l, less * reach - self.expansion.offset);
            }
            lit = lit | !P::share(&window).gt(zero);
            f.discard(lit);
            if !(!lit & f.live()).any() {
                return;
            }
            let weighted = self.blocked_depth(l, f, &terms, &window);
            let blocked = self.blocked(l, f, &terms, &window);
            let below = !lit & !(blocked * P::share(&window)).ge(F32::splat(l, self.threshold));
            f.count(0, below);
            lit = lit | below;
            f.discard(lit);
            let depth = (weighted / blocked) * (1.0 / reach);
            average = depth.max(zero).min(scaled);
            distance = range.distance(average);
        }
        if !(!lit & f.live()).any() {
            return;
        }
        // Stages 3 to 5.
        let window = self.window(l, at.uv, distance, at.distance);
        if self.plane_offset.is_some() {
            let less = self.lessened(l, scaled, slopes, [distance, receiver], shares[1]);
            terms = self.terms(l, less * reach - self.expansion.offset);
        }
        let blocked = self.blocked(l, f, &terms, &window).clamp(0.0, 1.0);
        let visible = one - blocked * P::share(&window);
        let visible = self.sharpened(l, visible.clamp(0.0, 1.0), scaled - average);
        f.set_color(0, [visible, zero, zero, one]);
    }
}
