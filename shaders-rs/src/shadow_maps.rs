//! Shadows looked up in light views: hard, filtered by a fixed kernel, or by one
//! as wide as the light seems through the blockers (docs/papers.md, baselines).
//!
//! All draw one triangle over the screen for each view, with positions in texture
//! 0 and the view's depths in texture 1. Fragments that are no receivers of the
//! view are discarded before anything is looked up, so that fetches are counted
//! where a shadow is looked for and nowhere else. Outside the picture nothing is
//! in the way, and nothing is read there.
//!
//! A texel blocks where it is nearer to the light than the receiver by more than
//! the bias: a distance along the view's axis, in world units.
//!
//! # Receiver planes
//!
//! A receiver that casts is in the picture itself, and at the texels of a kernel it is
//! nearer to the light or farther, the more so the lower the light and the wider the
//! kernel: no constant bias suffices. With [`ReceiverPlanes`] a texel is held against
//! the depth of the receiver's own plane at the texel's centre, where that is nearer
//! than the receiver. Where it is farther, the receiver's depth stays: what stands on
//! the plane behind the receiver is not in its way. (Receiver plane depth bias, Isidoro
//! 2006, there with both signs.)

use std::sync::Arc;

use gnomon_raster::math::dot3;
use gnomon_raster::shader::{
    Fragment, FragmentOutputs, FragmentShader, UniformError, UniformReader, UniformWriter, Uniforms,
};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use crate::bounded;
use crate::light_view::{LightMapping, Projection};
use crate::soft_volumes::texel_of;
use crate::vector::each2;

/// Slot of the view's depths.
const DEPTHS: usize = 1;
/// Slot of the receivers' planes.
const PLANES: usize = 2;

/// Largest slopes of a plane, over a kernel, in its own distance: beyond, it is seen
/// edge on.
const STEEPEST: f32 = 1_048_576.0;

/// Beyond these texels all coordinates are alike: outside.
const FAR_OUTSIDE: f32 = 1_048_576.0;

/// A receiver in a view.
#[derive(Clone, Copy)]
pub struct Receiver<L: Lanes> {
    /// Where it is in the picture, in texels.
    pub at: [F32<L>; 2],
    /// Distance along the view's axis, world units.
    pub distance: F32<L>,
    /// Stored depths below this one block at the receiver's own place.
    pub reference: F32<L>,
    /// Its plane, where that is looked at.
    pub plane: Option<ReceiverPlane<L>>,
}

impl<L: Lanes> Receiver<L> {
    /// Stored depths below this one block at the centre of texel (column, row).
    #[inline(always)]
    fn reference_at(&self, [column, row]: [I32<L>; 2]) -> F32<L> {
        self.reference_over([column.to_f32() + 0.5, row.to_f32() + 0.5])
    }

    /// The same at any place in the picture, in texels.
    #[inline(always)]
    pub(crate) fn reference_over(&self, place: [F32<L>; 2]) -> F32<L> {
        let Some(plane) = &self.plane else {
            return self.reference;
        };
        let [x, y] = [place[0] - self.at[0], place[1] - self.at[1]];
        let zero = F32::splat(x.lanes(), 0.0);
        let slope = x * plane.slope[0] + y * plane.slope[1];
        let slope = slope.max(zero).min(F32::splat(x.lanes(), STEEPEST));
        let nearer = match plane.projection {
            Projection::Perspective => slope / (slope + 1.0) * plane.depth,
            Projection::Orthographic => slope,
        };
        self.reference - nearer
    }
}

/// The plane of a receiver in a view: how much nearer to the light it is at a texel.
#[derive(Clone, Copy)]
pub struct ReceiverPlane<L: Lanes> {
    /// By the next column and row: perspective, the change of the reciprocal of its
    /// distance from the light, over that reciprocal; orthographic, of its stored depth
    /// with the sign changed.
    pub slope: [F32<L>; 2],
    /// The receiver's distance from the light, in the units of stored depths.
    pub depth: F32<L>,
    /// Which of both.
    pub projection: Projection,
}

/// How receivers' planes are seen in a view. A texture, of filters the one in slot 2, holds
/// planes: unit normals and distances from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverPlanes {
    /// Unit vectors to the right, downwards and along the view's axis.
    pub axes: [[f32; 3]; 3],
    /// From the light's centre to the mapping's.
    pub base: [f32; 3],
}
uniforms!(ReceiverPlanes { axes, base });

impl ReceiverPlanes {
    /// The plane of a receiver at a distance along the view's axis from the mapping's
    /// base. Of one that is seen from the side that the light does not reach, it is
    /// level: it is not in the picture.
    #[inline(always)]
    pub(crate) fn plane<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        position: [F32<L>; 3],
        distance: F32<L>,
        slot: usize,
    ) -> ReceiverPlane<L> {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, from_eye] = texel_of(l, f, slot, own);
        let normal = [x, y, z];
        let along = each3(
            #[inline(always)]
            |k| {
                let axis = self.axes[k];
                (x * axis[0] + y * axis[1]) + z * axis[2]
            },
        );
        let from = each3(
            #[inline(always)]
            |i| position[i] - mapping.centre[i] + self.base[i],
        );
        let depth = (distance + mapping.base) * (1.0 / (mapping.range.far - mapping.range.near));
        let texel = 1.0 / (mapping.scale * mapping.size as f32);
        let (from_light, per_texel) = match mapping.projection {
            Projection::Perspective => {
                let from_light = dot3(normal, from);
                (from_light, (distance + mapping.base) * texel / from_light)
            }
            Projection::Orthographic => {
                let step = texel / (mapping.range.far - mapping.range.near);
                (along[2], F32::splat(l, step) / along[2])
            }
        };
        let lit_side = (from_light * from_eye).gt(F32::splat(l, 0.0));
        let slope = each2(
            #[inline(always)]
            |k| lit_side.select_f32(along[k] * per_texel, F32::splat(l, 0.0)),
        );
        ReceiverPlane {
            slope,
            depth,
            projection: mapping.projection,
        }
    }
}

/// How the share of the light that is seen follows from depths near a receiver.
pub trait ShadowFilter: Send + Sync {
    /// Textures that it reads, from the slot after those of all filters.
    fn textures(&self) -> usize {
        0
    }

    /// Names of what it counts.
    fn counts(&self) -> &'static [&'static str] {
        &[]
    }

    /// The share that is seen, 0..=1. May discard lanes that are fully lit: what is
    /// drawn to was cleared to that.
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L>;
}

/// What is written to attachment 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadowTo {
    /// The share that is seen.
    Visibility,
    /// Minus this much of what is not seen, to be added: one of several views.
    Share(f32),
    /// The share that is seen by receivers whose positions have this w; others are left alone.
    VisibilityOf(f32),
}
uniforms!(enum ShadowTo { 0: Visibility, 1: Share(share), 2: VisibilityOf(number) });

impl ShadowTo {
    /// Which positions are looked at, by their w.
    #[inline(always)]
    fn wants<L: Lanes>(&self, l: L, w: F32<L>) -> Mask<L> {
        match *self {
            Self::VisibilityOf(number) => w.eq(F32::splat(l, number)),
            Self::Visibility | Self::Share(_) => w.gt(F32::splat(l, 0.0)),
        }
    }
}

/// Looks up shadows of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Shadow<F> {
    /// The view.
    pub mapping: LightMapping,
    /// By how much a blocker must be nearer than the receiver, world units.
    pub bias: f32,
    /// Whether texels are held against the receiver's plane, and how that is seen.
    pub planes: Option<ReceiverPlanes>,
    /// What is made of the depths.
    pub filter: F,
    /// What is written.
    pub to: ShadowTo,
}
uniforms!(Shadow<F> {
    mapping,
    bias,
    planes,
    filter,
    to
});

impl<F: ShadowFilter> FragmentShader for Shadow<F> {
    fn outputs(&self) -> FragmentOutputs {
        let own = if self.planes.is_some() { 3 } else { 2 };
        FragmentOutputs {
            discards: true,
            textures: own + self.filter.textures(),
            counts: self.filter.counts(),
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, shadowable] = texel_of(l, f, 0, own);
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let mapping = &self.mapping;
        let place = mapping.locate(l, [x, y, z]);
        let receives = self.to.wants(l, shadowable) & place.belongs;
        f.discard(!receives);
        if !(receives & f.live()).any() {
            return;
        }
        let size = mapping.size as f32;
        let at = each2(
            #[inline(always)]
            |k| {
                let texels = (place.uv[k] * size).clamp(-FAR_OUTSIDE, FAR_OUTSIDE);
                receives.select_f32(texels, zero)
            },
        );
        let distance = receives.select_f32(place.distance, one);
        let plane = match &self.planes {
            Some(planes) => Some(planes.plane(l, f, mapping, [x, y, z], distance, PLANES)),
            None => None,
        };
        let receiver = Receiver {
            at,
            distance,
            plane,
            // What is cleared to never blocks.
            reference: mapping.range.scaled(place.distance - self.bias).min(one),
        };
        let lit = self.filter.lit(l, f, mapping, &receiver);
        let red = match self.to {
            ShadowTo::Visibility | ShadowTo::VisibilityOf(_) => lit,
            ShadowTo::Share(share) => (lit - one) * share,
        };
        f.set_color(0, [red, zero, zero, zero]);
    }
}

/// Whether the texel at (column, row) blocks, and its stored depth.
#[inline(always)]
pub(crate) fn blocker<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    receiver: &Receiver<L>,
    [column, row]: [I32<L>; 2],
) -> (Mask<L>, F32<L>) {
    let depth = texel_of(l, f, DEPTHS, [column, row, I32::splat(l, 0)]);
    // Alpha is 1 inside the picture and 0 outside.
    let inside = depth[3].gt(F32::splat(l, 0.0));
    let reference = receiver.reference_at([column, row]);
    (inside & depth[0].lt(reference), depth[0])
}

/// 1 where the texel at (column, row) blocks, else 0.
#[inline(always)]
fn blocks<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    receiver: &Receiver<L>,
    at: [I32<L>; 2],
) -> F32<L> {
    let (blocked, _) = blocker(l, f, receiver, at);
    blocked.select_f32(F32::splat(l, 1.0), F32::splat(l, 0.0))
}

/// The mean over `taps` x `taps` texels, those nearest to the receiver; one is the
/// hard shadow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxTaps(pub u32);

impl Uniforms for BoxTaps {
    fn put(&self, to: &mut UniformWriter) {
        self.0.put(to);
    }

    fn take(from: &mut UniformReader<'_>) -> Result<Self, UniformError> {
        let side = u32::take(from)?;
        bounded::check([("texels along a side", side.into(), 256)], from)?;
        Ok(Self(side))
    }
}

impl ShadowFilter for BoxTaps {
    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        _: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let half = self.0 as f32 * 0.5;
        let [x, y] = each2(
            #[inline(always)]
            |k| (receiver.at[k] + (0.5 - half)).floor().to_i32(),
        );
        let mut blocked = F32::splat(l, 0.0);
        for row in 0..self.0 as i32 {
            for column in 0..self.0 as i32 {
                let at = [x + I32::splat(l, column), y + I32::splat(l, row)];
                blocked = blocked + blocks(l, f, receiver, at);
            }
        }
        F32::splat(l, 1.0) - blocked / (self.0 * self.0) as f32
    }
}

/// The cubic B-spline over 4 x 4 texels: smooth, and never negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CubicTaps;
uniforms!(CubicTaps);

impl ShadowFilter for CubicTaps {
    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        _: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let [(x, along), (y, down)] = each2(
            #[inline(always)]
            |k| spline(l, receiver.at[k] - 0.5),
        );
        let mut blocked = F32::splat(l, 0.0);
        for (row, down) in down.into_iter().enumerate() {
            let mut sum = F32::splat(l, 0.0);
            for (column, along) in along.into_iter().enumerate() {
                let at = [
                    x + I32::splat(l, column as i32 - 1),
                    y + I32::splat(l, row as i32 - 1),
                ];
                sum = sum + blocks(l, f, receiver, at) * along;
            }
            blocked = blocked + sum * down;
        }
        (F32::splat(l, 1.0) - blocked).clamp(0.0, 1.0)
    }
}

/// The texel before `t` and the weights of it, its predecessor and two successors.
#[inline(always)]
fn spline<L: Lanes>(l: L, t: F32<L>) -> (I32<L>, [F32<L>; 4]) {
    let whole = t.floor();
    let t = t - whole;
    let s = F32::splat(l, 1.0) - t;
    let (t2, s2) = (t * t, s * s);
    let sixth = 1.0 / 6.0;
    let weights = [s2 * s * sixth, inner(t, t2), inner(s, s2), t2 * t * sixth];
    (whole.to_i32(), weights)
}

/// Weight of the two texels in the middle, from the distance and its square.
#[inline(always)]
fn inner<L: Lanes>(t: F32<L>, squared: F32<L>) -> F32<L> {
    (squared * (t * 3.0 - 6.0) + 4.0) * (1.0 / 6.0)
}

/// Percentage-closer soft shadows: the mean depth of the blockers round a receiver
/// says how wide a kernel is needed. Half widths are of the light, world units.
///
/// Places are in -1..1 of the kernel's half widths; texels are taken as they are,
/// the nearest ones.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledKernel {
    /// Half width of the light along the picture's axes.
    pub light_half: [f32; 2],
    /// Where blockers are looked for.
    pub search: Arc<[[f32; 2]]>,
    /// Where depths are compared.
    pub filter: Arc<[[f32; 2]]>,
}
uniforms!(SampledKernel {
    light_half,
    search,
    filter
});

impl ShadowFilter for SampledKernel {
    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let (some, distance) = mean_blocker(l, f, mapping, receiver, self.light_half, &self.search);
        f.discard(!some);
        if !some.any() {
            return one;
        }
        let half = kernel(mapping, self.light_half, distance, receiver);
        let mut blocked = zero;
        for place in self.filter.iter() {
            blocked = blocked + blocks(l, f, receiver, sample_at(receiver, half, *place));
        }
        one - blocked / self.filter.len() as f32
    }
}

/// Whether some of the points within W(near) block, and their mean distance.
#[inline(always)]
pub(crate) fn mean_blocker<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    mapping: &LightMapping,
    receiver: &Receiver<L>,
    light_half: [f32; 2],
    search: &[[f32; 2]],
) -> (Mask<L>, F32<L>) {
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    let near = F32::splat(l, mapping.range.near);
    let half = kernel(mapping, light_half, near, receiver);
    let (mut count, mut sum) = (zero, zero);
    for place in search {
        let at = sample_at(receiver, half, *place);
        let (blocked, depth) = blocker(l, f, receiver, at);
        count = count + blocked.select_f32(one, zero);
        sum = sum + blocked.select_f32(depth, zero);
    }
    let distance = mapping.range.distance(sum / count.max(one));
    (count.gt(zero), distance)
}

/// Half widths of the kernel for blockers at a distance, in texels; half a texel
/// at least.
#[inline(always)]
pub(crate) fn kernel<L: Lanes>(
    mapping: &LightMapping,
    light_half: [f32; 2],
    blocker: F32<L>,
    receiver: &Receiver<L>,
) -> [F32<L>; 2] {
    let size = mapping.size as f32;
    each2(
        #[inline(always)]
        |k| {
            let half = mapping.half_width(light_half[k], blocker, receiver.distance) * size;
            half.clamp(0.5, FAR_OUTSIDE)
        },
    )
}

#[inline(always)]
fn sample_at<L: Lanes>(receiver: &Receiver<L>, half: [F32<L>; 2], place: [f32; 2]) -> [I32<L>; 2] {
    each2(
        #[inline(always)]
        |k| (receiver.at[k] + half[k] * place[k]).floor().to_i32(),
    )
}

/// [`SampledKernel`] with every texel of the kernels, weighted by the area that
/// they share with the texel: what sampling approaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeKernel {
    /// Half width of the light along the picture's axes, world units.
    pub light_half: [f32; 2],
}
uniforms!(WholeKernel { light_half });

impl ShadowFilter for WholeKernel {
    #[inline(always)]
    fn lit<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        mapping: &LightMapping,
        receiver: &Receiver<L>,
    ) -> F32<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let near = F32::splat(l, mapping.range.near);
        let half = kernel(mapping, self.light_half, near, receiver);
        let every = Mask::splat(l, true);
        let [count, sum] = blockers(l, f, mapping, receiver, half, every);
        let some = count.gt(zero);
        f.discard(!some);
        if !(some & f.live()).any() {
            return one;
        }
        let mean = some.select_f32(sum / count, zero);
        let blocker = mapping.range.distance(mean);
        let half = kernel(mapping, self.light_half, blocker, receiver);
        let [blocked, _] = blockers(l, f, mapping, receiver, half, some);
        (one - blocked / (half[0] * half[1] * 4.0)).clamp(0.0, 1.0)
    }
}

/// Area of the blocking texels in the kernel, and the integral of their stored
/// depths, both in texels; 0 in lanes that are not `wanted`.
#[inline(always)]
fn blockers<L: Lanes>(
    l: L,
    f: &mut Fragment<'_, L>,
    mapping: &LightMapping,
    receiver: &Receiver<L>,
    half: [F32<L>; 2],
    wanted: Mask<L>,
) -> [F32<L>; 2] {
    let zero = F32::splat(l, 0.0);
    let size = mapping.size as f32;
    let wanted = wanted & f.live();
    let columns = Span::new(receiver.at[0], half[0], size, wanted);
    let rows = Span::new(receiver.at[1], half[1], size, wanted);
    let (mut area, mut sum) = (zero, zero);
    for row in 0..rows.count {
        let y = rows.first + row as f32;
        let height = rows.shared(y);
        for column in 0..columns.count {
            let x = columns.first + column as f32;
            let weight = columns.shared(x) * height;
            let read = weight.gt(zero) & wanted;
            // Lanes that are done read nothing.
            let outside = F32::splat(l, -1.0);
            let at = [read.select_f32(x, outside).to_i32(), y.to_i32()];
            let (blocked, depth) = blocker(l, f, receiver, at);
            let weight = (read & blocked).select_f32(weight, zero);
            area = area + weight;
            sum = sum + weight * depth;
        }
    }
    [area, sum]
}

/// Texels of a kernel along one axis, without those outside the picture, where
/// nothing is in the way.
pub(crate) struct Span<L: Lanes> {
    low: F32<L>,
    /// Texels below this one are some of its.
    pub(crate) high: F32<L>,
    pub(crate) first: F32<L>,
    /// The most that any lane has.
    pub(crate) count: i32,
}

impl<L: Lanes> Span<L> {
    #[inline(always)]
    pub(crate) fn new(middle: F32<L>, half: F32<L>, size: f32, wanted: Mask<L>) -> Self {
        let low = (middle - half).clamp(0.0, size);
        let high = (middle + half).clamp(0.0, size);
        let first = low.floor();
        let zero = F32::splat(middle.lanes(), 0.0);
        let texels = wanted.select_f32(high.ceil() - first, zero);
        Self {
            low,
            high,
            first,
            count: texels.to_i32().reduce_max(),
        }
    }

    /// Length of the texel at `x` that is inside.
    #[inline(always)]
    fn shared(&self, x: F32<L>) -> F32<L> {
        let zero = F32::splat(x.lanes(), 0.0);
        ((x + 1.0).min(self.high) - x.max(self.low)).max(zero)
    }
}
