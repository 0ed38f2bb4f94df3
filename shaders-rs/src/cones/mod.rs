//! Soft shadows of spheres by cone culling (Bavoil and Silva 2006; docs/papers.md).
//!
//! A light view's texels are micro-patches in the world. Those whose centres are in the
//! cone of all shadow rays from a receiver to the light hide it; each hides as much as
//! its solid angle is of the light's. Sums are limited to 1, which is counted: patches
//! that hide the same part of the light are summed all the same.
//!
//! How the patches of a cone are found is a [`PatchSearch`]: at points of a disc
//! ([`DiscSamples`]), by a tree of boxes ([`PatchTree`]), or among all ([`AllPatches`]).
//!
//! Texture 0 holds positions, texture 1 patches ([`patches::PatchPicture`]), and with a
//! tree textures 2 to 5 its boxes ([`bounds::PatchBounds`]).

pub mod bounds;
mod disc;
pub mod patches;
mod tree;

use gnomon_raster::math::{cross, dot3};
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use self::patches::{PatchShape, cap};
use crate::light_view::LightMapping;
use crate::soft_volumes::texel_of;

pub use self::disc::DiscSamples;
pub use self::tree::{AllPatches, PatchTree};

/// Slot of the patches.
const PATCHES: usize = 1;

/// What is counted, by number.
const COUNTS: &[&str] = &[
    "occlusion-clamped",
    "inside-light",
    "wide-cones",
    "patches-in-cones",
];
const CLAMPED: usize = 0;
const INSIDE: usize = 1;
const WIDE: usize = 2;
const IN_CONES: usize = 3;

/// Cones that spread on planes across the view beyond so many times what similar
/// triangles say are counted: views need not hold all of their patches.
pub const WIDEST_CONE: f32 = 8.0;

/// A sphere that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSphere {
    /// Its centre, relative to the origin of positions.
    pub centre: [f32; 3],
    /// Its radius, world units.
    pub radius: f32,
}
uniforms!(LightSphere { centre, radius });

/// The cone of all shadow rays of a receiver.
pub struct ShadowCone<L: Lanes> {
    apex: [F32<L>; 3],
    /// Unit vector to the light's centre.
    axis: [F32<L>; 3],
    /// To the light's centre.
    distance: F32<L>,
    sine: F32<L>,
    cosine: F32<L>,
    /// The light's solid angle over 2π.
    light: F32<L>,
    /// Lanes that look for shadow.
    wanted: Mask<L>,
}

impl<L: Lanes> ShadowCone<L> {
    /// Of receivers outside the light; `wanted` loses the others, which are counted.
    #[inline(always)]
    fn new(
        l: L,
        f: &mut Fragment<'_, L>,
        light: &LightSphere,
        apex: [F32<L>; 3],
        wanted: Mask<L>,
    ) -> Self {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let to = each3(
            #[inline(always)]
            |i| F32::splat(l, light.centre[i]) - apex[i],
        );
        let distance = dot3(to, to).sqrt();
        let outside = distance.gt(F32::splat(l, light.radius));
        f.count(INSIDE, wanted & !outside);
        let wanted = wanted & outside;
        let sine = wanted.select_f32(F32::splat(l, light.radius) / distance, zero);
        Self {
            apex,
            axis: each3(
                #[inline(always)]
                |i| to[i] / distance,
            ),
            distance,
            sine,
            cosine: ((one - sine) * (one + sine)).sqrt(),
            light: cap(sine * sine),
            wanted,
        }
    }

    /// From the receiver to a point.
    #[inline(always)]
    fn to(&self, point: [F32<L>; 3]) -> [F32<L>; 3] {
        each3(
            #[inline(always)]
            |i| point[i] - self.apex[i],
        )
    }

    /// Whether `v` from the receiver is in the cone, before it and not beyond the light.
    #[inline(always)]
    fn holds(&self, v: [F32<L>; 3]) -> Mask<L> {
        let along = dot3(v, self.axis);
        let off = cross(v, self.axis);
        let [across, along_sine] = [dot3(off, off).sqrt() * self.cosine, along * self.sine];
        let before = along.gt(F32::splat(along.lanes(), 0.0));
        before & along.le(self.distance) & across.le(along_sine)
    }

    /// The share of the light that a patch hides, times `weight`, where it hides any.
    #[inline(always)]
    fn hidden(
        &self,
        f: &mut Fragment<'_, L>,
        shape: &PatchShape,
        patch: [F32<L>; 4],
        weight: f32,
    ) -> F32<L> {
        let zero = F32::splat(self.distance.lanes(), 0.0);
        let [x, y, z, radius] = patch;
        let v = self.to([x, y, z]);
        let held = self.wanted & radius.gt(zero) & self.holds(v);
        if !held.any() {
            return zero;
        }
        f.count(IN_CONES, held);
        held.select_f32(shape.seen(v, radius) / self.light * weight, zero)
    }
}

/// How the patches of a cone are found.
pub trait PatchSearch: Send + Sync {
    /// Textures that it reads beyond the first two.
    const MORE_TEXTURES: usize;

    /// The share of the light that patches hide; not limited.
    fn hidden<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        shape: &PatchShape,
        cone: &ShadowCone<L>,
        at: &PictureCone<'_, L>,
    ) -> F32<L>;
}

/// Where a cone is in the picture.
pub struct PictureCone<'a, L: Lanes> {
    mapping: &'a LightMapping,
    /// Its apex, in texels.
    at: [F32<L>; 2],
    /// Distance of the apex along the view's axis beyond the base, world units.
    distance: F32<L>,
    /// Cosine of the angle between the cone's farthest ray and the view's axis.
    cosine: F32<L>,
}

/// Shadow of the patches in the cones of receivers.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeShadow<S> {
    /// The view; it is perspective.
    pub mapping: LightMapping,
    /// The light.
    pub light: LightSphere,
    /// What patches are taken for.
    pub shape: PatchShape,
    /// How they are found.
    pub search: S,
}
uniforms!(ConeShadow<S> {
    mapping,
    light,
    shape,
    search
});

impl<S: PatchSearch> FragmentShader for ConeShadow<S> {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 2 + S::MORE_TEXTURES,
            counts: COUNTS,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, shadowable] = texel_of(l, f, 0, own);
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let place = self.mapping.locate(l, [x, y, z]);
        let receives = shadowable.gt(zero) & place.belongs;
        f.discard(!receives);
        if !(receives & f.live()).any() {
            return;
        }
        let cone = ShadowCone::new(l, f, &self.light, [x, y, z], receives);
        f.discard(!cone.wanted);
        let at = PictureCone::new(&self.mapping, &place, &cone);
        let wide = at.cosine.lt(F32::splat(l, 1.0 / WIDEST_CONE));
        f.count(WIDE, cone.wanted & wide);
        let hidden = self.search.hidden(l, f, &self.shape, &cone, &at);
        f.count(CLAMPED, cone.wanted & hidden.gt(one));
        f.set_color(0, [one - hidden.min(one), zero, zero, zero]);
    }
}
