//! Micro-patches: a light view's texels as rectangles in the world, parallel to the
//! picture, and how large they are seen from somewhere (Bavoil and Silva 2006, §1 and 2).

use core::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2};

use gnomon_raster::math::{atan2, dot3, length};
use gnomon_raster::shader::{Fragment, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, uniforms};

use crate::light_view::{Hit, PlanarDepth};
use crate::vector::each2;

/// Position in red, green and blue, and the radius of the sphere round the texel's
/// rectangle in alpha, of a picture cleared to 0: no patch. Varyings are those of
/// [`crate::transform::Facets`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPicture {
    /// How depth is found. The view is perspective, and slopes push nothing.
    pub depth: PlanarDepth,
    /// The reference point of `depth`, relative to the origin of positions.
    pub reference: [f32; 3],
    /// Half a texel's diagonal, in tangents.
    pub half_diagonal: f32,
}
uniforms!(PatchPicture {
    depth,
    reference,
    half_diagonal
});

impl FragmentShader for PatchPicture {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let Hit {
            start,
            direction,
            distance,
            ..
        } = self.depth.hit(l, f);
        let range = &self.depth.range;
        let distance = distance.clamp(range.near, range.far);
        let [x, y, z] = each3(
            #[inline(always)]
            |i| (direction[i] * distance + start[i]) + self.reference[i],
        );
        let radius = (distance + self.depth.base) * self.half_diagonal;
        f.set_color(0, [x, y, z, radius]);
    }
}

/// What a patch's solid angle is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatchShape {
    /// The sphere round it.
    Sphere,
    /// The rectangle itself, along these unit vectors to the right, downwards and along
    /// the view's axis.
    Rectangle([[f32; 3]; 3]),
}
uniforms!(enum PatchShape { 0: Sphere, 1: Rectangle(axes) });

impl PatchShape {
    /// The solid angle of a patch with its centre at `v` and this radius, over 2π.
    #[inline(always)]
    pub(super) fn seen<L: Lanes>(&self, v: [F32<L>; 3], radius: F32<L>) -> F32<L> {
        match self {
            Self::Sphere => cap(radius * radius / dot3(v, v)),
            Self::Rectangle(axes) => rectangle(axes, v, radius),
        }
    }
}

/// `1 − √(1 − q)`, a cone's solid angle over 2π where q is the square of the sine of
/// its half angle, without cancellation. From 1 on it is a half space.
#[inline(always)]
pub(super) fn cap<L: Lanes>(q: F32<L>) -> F32<L> {
    let one = F32::splat(q.lanes(), 1.0);
    let q = q.min(one);
    q / ((one - q).sqrt() + one)
}

/// Two triangles, each by Van Oosterom and Strackee's formula: their triple product is
/// known, so that nothing cancels for small ones.
#[inline(always)]
fn rectangle<L: Lanes>(axes: &[[f32; 3]; 3], v: [F32<L>; 3], radius: F32<L>) -> F32<L> {
    let [x, y, z] = each3(
        #[inline(always)]
        |k| (v[0] * axes[k][0] + v[1] * axes[k][1]) + v[2] * axes[k][2],
    );
    let half = radius * FRAC_1_SQRT_2;
    let triple = half * half * z.abs() * 4.0;
    let (low, high) = ([x - half, y - half], [x + half, y + half]);
    let a = [low[0], low[1], z];
    let c = [high[0], high[1], z];
    let turns = each2(
        #[inline(always)]
        |side| {
            let b = match side {
                0 => [high[0], low[1], z],
                _ => [low[0], high[1], z],
            };
            triangle(triple, a, b, c)
        },
    );
    (turns[0] + turns[1]) * FRAC_1_PI
}

/// Half the solid angle of a triangle with this triple product.
#[inline(always)]
fn triangle<L: Lanes>(triple: F32<L>, a: [F32<L>; 3], b: [F32<L>; 3], c: [F32<L>; 3]) -> F32<L> {
    let (p, q, r) = (length(a), length(b), length(c));
    let below = ((p * q * r + dot3(a, b) * r) + dot3(a, c) * q) + dot3(b, c) * p;
    atan2(triple, below)
}
