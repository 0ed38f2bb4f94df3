//! Light views: planar pictures of the casters from a point of a light, and where
//! in such a picture a world-space position lies (docs/papers.md, Annen et al. 2008 and baselines).
//!
//! Depth is *linear* and *planar*: the distance from the light's centre along the
//! view's axis, not along the ray, scaled to 0..1 between two distances. Similar
//! triangles between light, blocker and receiver are exact in it where light and
//! receiver are parallel to the picture.
//!
//! Image coordinates are (u, v), 0..1 over the picture, v downwards: texel (i, j)
//! of n x n covers (i..i+1, j..j+1)/n.

use gnomon_raster::math::{dot3, length};
use gnomon_raster::shader::{Fragment, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use crate::bounded::bounded_uniforms;
use crate::surface::PixelRays;
use crate::vector::each2;
use gnomon_raster::MAX_TEXTURE_SIZE;

/// Cosine between ray and facet, below which depth is interpolated.
const EDGE_ON: f32 = 1e-3;

/// Distances along the view's axis that are stored as 0 and 1, world units. They are
/// relative to the view's base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Stored as 0.
    pub near: f32,
    /// Stored as 1, and what is cleared to: nothing in the way.
    pub far: f32,
}
uniforms!(DepthRange { near, far });

impl DepthRange {
    /// The stored value of a distance; not limited.
    #[inline(always)]
    #[must_use]
    pub fn scaled<L: Lanes>(&self, distance: F32<L>) -> F32<L> {
        (distance - self.near) * (1.0 / (self.far - self.near))
    }

    /// The distance that is stored as `scaled`, world units.
    #[inline(always)]
    #[must_use]
    pub fn distance<L: Lanes>(&self, scaled: F32<L>) -> F32<L> {
        scaled * (self.far - self.near) + self.near
    }
}

/// How a view looks at the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// From a point; places in the picture are tangents (x/z, y/z).
    Perspective,
    /// Along one direction, for directional lights; places are lengths (x, y).
    Orthographic,
}
uniforms!(enum Projection { 0: Perspective, 1: Orthographic });

/// Scaled depth in red of attachment 0, limited to 0..=1. Varyings are those of
/// [`crate::transform::Facets`], distances from the plane being those of a
/// reference point.
///
/// Vertices are snapped to 1/256 texel, and interpolated depth with them, which on
/// steep facets is many times the depth's precision. So depth is where the texel's
/// ray meets the facet's plane, and the interpolated one only where the facet is
/// seen edge on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarDepth {
    /// Rays through texels, each one long along the view's axis. They start at
    /// `eye`, the light's centre relative to the reference point, if the base is 0,
    /// else at `eye + (x right + y down) base`; orthographic ones all go along `first`
    /// and start at `eye + x right + y down`.
    pub rays: PixelRays,
    /// Which of both.
    pub projection: Projection,
    /// What distances are relative to: how far from a perspective view's centre its
    /// rays start.
    pub base: f32,
    /// How depth is stored.
    pub range: DepthRange,
    /// Texels by which a facet's slope pushes it away from the light; 0: not at all.
    pub slope: f32,
    /// The most that it does, world units.
    pub slope_limit: f32,
}
uniforms!(PlanarDepth {
    rays,
    projection,
    base,
    range,
    slope,
    slope_limit
});

/// Where a texel's ray meets a facet.
pub(crate) struct Hit<L: Lanes> {
    /// Where the ray starts, and its direction, one long along the view's axis.
    pub(crate) start: [F32<L>; 3],
    pub(crate) direction: [F32<L>; 3],
    /// Distance along the axis beyond the base, world units.
    pub(crate) distance: F32<L>,
    normal: [F32<L>; 3],
    /// Cosine between both times the direction's length.
    slope: F32<L>,
}

impl FragmentShader for PlanarDepth {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let Hit {
            distance,
            normal,
            slope,
            ..
        } = self.hit(l, f);
        let distance = match self.slope > 0.0 {
            true => {
                let widening = match self.projection {
                    Projection::Perspective => distance + self.base,
                    Projection::Orthographic => F32::splat(l, 1.0),
                };
                distance + self.pushed(l, normal, widening / slope.abs())
            }
            false => distance,
        };
        let depth = self.range.scaled(distance).clamp(0.0, 1.0);
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [depth, zero, zero, F32::splat(l, 1.0)]);
    }
}

impl PlanarDepth {
    /// Where the rays through the texels meet the facet's plane.
    #[inline(always)]
    pub(crate) fn hit<L: Lanes>(&self, l: L, f: &Fragment<'_, L>) -> Hit<L> {
        let (x, y) = (f.x(), f.y());
        let rays = &self.rays;
        // From the corner of the picture to the texel.
        let across = each3(
            #[inline(always)]
            |i| x * rays.right[i] + y * rays.down[i],
        );
        let perspective = self.projection == Projection::Perspective;
        let direction = each3(
            #[inline(always)]
            |i| match perspective {
                true => across[i] + rays.first[i],
                false => F32::splat(l, rays.first[i]),
            },
        );
        let start = each3(
            #[inline(always)]
            |i| match perspective {
                true if self.base == 0.0 => F32::splat(l, rays.eye[i]),
                true => across[i] * self.base + rays.eye[i],
                false => across[i] + rays.eye[i],
            },
        );
        let normal = each3(
            #[inline(always)]
            |i| f.varying(3 + i),
        );
        let moved = dot3(normal, start);
        let slope = dot3(normal, direction);
        let steep = slope.abs().gt(length(direction) * EDGE_ON);
        let interpolated = match perspective {
            true => f.w() - self.base,
            false => self.range.distance(f.depth()),
        };
        let distance = steep.select_f32((f.varying(6) - moved) / slope, interpolated);
        Hit {
            start,
            direction,
            distance,
            normal,
            slope,
        }
    }
}

impl PlanarDepth {
    /// What depth changes over `slope` texels along each axis. Where the facet is
    /// seen edge on it is the limit.
    #[inline(always)]
    fn pushed<L: Lanes>(&self, l: L, normal: [F32<L>; 3], per_step: F32<L>) -> F32<L> {
        let steps = along(l, normal, self.rays.right) + along(l, normal, self.rays.down);
        let limit = F32::splat(l, self.slope_limit);
        (steps * per_step * self.slope).min(limit)
    }
}

/// |normal · step|.
#[inline(always)]
fn along<L: Lanes>(l: L, normal: [F32<L>; 3], step: [f32; 3]) -> F32<L> {
    let step = each3(
        #[inline(always)]
        |i| F32::splat(l, step[i]),
    );
    dot3(normal, step).abs()
}

/// What of the world belongs to a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewRegion {
    /// All that is in front of the light.
    Front,
    /// The pyramid of a cube's face: |x| and |y| at most z.
    Face,
}
uniforms!(enum ViewRegion { 0: Front, 1: Face });

/// From world space to a light view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightMapping {
    /// Where the picture is taken from, relative to the origin of positions; with a
    /// base a point as far along the view.
    pub centre: [f32; 3],
    /// Vectors to the right, downwards and along the view's axis: unit vectors, or
    /// with a base the first two sheared so that the picture's middle is at 0.
    pub axes: [[f32; 3]; 3],
    /// What places in the picture are.
    pub projection: Projection,
    /// Factor from places, tangents or lengths, to (u, v).
    pub scale: f32,
    /// Added to the product.
    pub offset: [f32; 2],
    /// What distances are relative to: 0, or for lights so far away that f32 would not
    /// tell their receivers apart, how far these are at least.
    pub base: f32,
    /// How depth is stored.
    pub range: DepthRange,
    /// Texels along a side.
    pub size: u32,
    /// Which positions belong to the view.
    pub region: ViewRegion,
}
bounded_uniforms!(LightMapping {
    centre,
    axes,
    projection,
    scale,
    offset,
    base,
    range,
    size,
    region
}: |m| [("texels along a side", m.size.into(), MAX_TEXTURE_SIZE.into())]);

/// A position in a light view.
#[derive(Clone, Copy)]
pub struct InLightView<L: Lanes> {
    /// Image coordinates (u, v); inside the picture in 0..1, and anything where
    /// `belongs` is not set.
    pub uv: [F32<L>; 2],
    /// Distance along the view's axis beyond the base, world units.
    pub distance: F32<L>,
    /// Whether the position is in the view's region.
    pub belongs: Mask<L>,
}

impl LightMapping {
    /// Where `position` is in the picture.
    #[inline(always)]
    pub fn locate<L: Lanes>(&self, l: L, position: [F32<L>; 3]) -> InLightView<L> {
        let from = each3(
            #[inline(always)]
            |i| position[i] - self.centre[i],
        );
        let [x, y, z] = each3(
            #[inline(always)]
            |k| {
                let axis = self.axes[k];
                (from[0] * axis[0] + from[1] * axis[1]) + from[2] * axis[2]
            },
        );
        let beyond = z;
        let z = beyond + self.base;
        let in_front = z.gt(F32::splat(l, 0.0));
        let belongs = match self.region {
            ViewRegion::Front => in_front,
            ViewRegion::Face => in_front & x.abs().le(z) & y.abs().le(z),
        };
        let place = [x, y];
        let uv = each2(
            #[inline(always)]
            |k| match self.projection {
                Projection::Perspective => place[k] / z * self.scale + self.offset[k],
                Projection::Orthographic => place[k] * self.scale + self.offset[k],
            },
        );
        InLightView {
            uv,
            distance: beyond,
            belongs,
        }
    }

    /// Half the width in u (and in v) of what lies between a receiver at distance
    /// `receiver` and a light of the given half width, at distance `blocker`
    /// (world units beyond the base): `W(z)/2` of docs/papers.md, Annen et al. 2008.
    #[inline(always)]
    #[must_use]
    pub fn half_width<L: Lanes>(
        &self,
        light_half: f32,
        blocker: F32<L>,
        receiver: F32<L>,
    ) -> F32<L> {
        let product = (receiver + self.base) * (blocker + self.base);
        (receiver - blocker) * (light_half * self.scale) / product
    }
}
