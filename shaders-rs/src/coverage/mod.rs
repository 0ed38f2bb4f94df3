//! How much of an area light one silhouette edge covers, seen from a fragment's
//! surface: the lanes' side of the f64 twin in the pipeline's `coverage`.
//!
//! The edge is projected onto the light and clipped there in homogeneous
//! coordinates (paper III, §3.2.2; paper IV, §4.2). With the sector S of the light
//! between the rays from its centre through the clipped ends p0 and p1, and its
//! area A,
//!
//! ```text
//! c = (|S| - |p0 x p1| / 2) / A
//! ```
//!
//! in units of half the light's size, which is where projectors put the edge.
//! Nothing is clipped against the light's plane: the edge has to lie in front of
//! it, on the side given.

mod polygon;
mod round;
mod square;

use fearless_simd::Simd as _;
use gnomon_raster::math::dot3;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, Lanes, Mask, uniforms};

use crate::vector::each2;
pub use polygon::{MAX_CORNERS, Outline};

/// Ends of a silhouette edge, in the coordinates of a projector.
pub type Edge = [[f32; 3]; 2];

/// What a light looks like in its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Image {
    /// The square -1..1.
    Square,
    /// The unit disc.
    Disc,
    /// A convex polygon within the unit disc.
    Polygon(Outline),
}
uniforms!(enum Image { 0: Square, 1: Disc, 2: Polygon(outline) });

impl Image {
    /// Its area.
    #[inline(always)]
    #[must_use]
    pub fn area(self) -> f32 {
        match self {
            Self::Square => 4.0,
            Self::Disc => core::f32::consts::PI,
            Self::Polygon(outline) => outline.area,
        }
    }
}

/// An edge in homogeneous light coordinates.
#[derive(Clone, Copy)]
pub struct Projected<L: Lanes> {
    /// x, y, w of both ends.
    pub ends: [[F32<L>; 3]; 2],
    /// The part that is in front of the light: parameters of a first clip.
    pub part: [F32<L>; 2],
    /// Fragments that have a projection.
    pub valid: Mask<L>,
}

/// The clipped image of an edge.
#[derive(Clone, Copy)]
pub struct Segment<L: Lanes> {
    /// Ends on the light; anything where it is empty.
    pub ends: [[F32<L>; 2]; 2],
    /// Fragments to which some of the edge covers the light.
    pub some: Mask<L>,
}

/// What edges are projected on. One type for all lights, so that shaders are
/// compiled once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projector {
    /// A parallelogram, a disc or a polygon.
    Flat(FlatLight),
    /// A sphere.
    Sphere(SphereLight),
}
uniforms!(enum Projector { 0: Flat(light), 1: Sphere(light) });

impl Projector {
    /// What the light looks like.
    #[inline(always)]
    #[must_use]
    pub fn image(&self) -> Image {
        match self {
            Self::Flat(light) => light.image,
            Self::Sphere(_) => Image::Disc,
        }
    }

    /// What a fragment's position is taken relative to: the light's centre or, of a
    /// far light, a place in the scene; relative to the origin of positions.
    #[inline(always)]
    #[must_use]
    pub fn origin(&self) -> [f32; 3] {
        match self {
            Self::Flat(light) => light.origin,
            Self::Sphere(light) => light.origin,
        }
    }

    /// The edge as seen from `from`, a position relative to the light's origin.
    #[inline(always)]
    pub fn project<L: Lanes>(&self, l: L, from: [F32<L>; 3], edge: &Edge) -> Projected<L> {
        outlined(
            l,
            #[inline(always)]
            || match self {
                Self::Flat(light) => light.project(l, from, edge),
                Self::Sphere(light) => light.project(l, from, edge),
            },
        )
    }
}

/// A parallelogram, flat disc or convex polygon, shining to one side. Edges are in light
/// coordinates, from the light's origin: the third is the distance in front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatLight {
    /// See [`Projector::origin`].
    pub origin: [f32; 3],
    /// Of a light so far that positions relative to its centre lose their digits: the
    /// origin in light coordinates from its centre. Else the origin is the centre.
    pub far: Option<[f32; 3]>,
    /// Covectors that give light coordinates; the third is positive where the
    /// light shines.
    pub axes: [[f32; 3]; 3],
    /// Square for parallelograms; of polygons the corners.
    pub image: Image,
}
uniforms!(FlatLight {
    origin,
    far,
    axes,
    image
});

impl FlatLight {
    #[inline(always)]
    fn project<L: Lanes>(&self, l: L, from: [F32<L>; 3], edge: &Edge) -> Projected<L> {
        let [x, y, z] = each3(
            #[inline(always)]
            |i| {
                let [a, b, c] = self.axes[i];
                (from[0] * a + from[1] * b) + from[2] * c
            },
        );
        let [a, b] = edge;
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let part = [zero, one];
        let Some(offset) = self.far else {
            return Projected {
                ends: [onto(l, [x, y, z], a), onto(l, [x, y, z], b)],
                part,
                valid: z.gt(zero),
            };
        };
        let eye = [x + offset[0], y + offset[1], z + offset[2]];
        let ends = each2(
            #[inline(always)]
            |k| onto_from_afar(eye, minus(l, [a, b][k], [x, y, z])),
        );
        Projected {
            ends,
            part,
            valid: eye[2].gt(zero),
        }
    }
}

/// A point less a fragment's position.
#[inline(always)]
fn minus<L: Lanes>(l: L, point: &[f32; 3], from: [F32<L>; 3]) -> [F32<L>; 3] {
    each3(
        #[inline(always)]
        |i| F32::splat(l, point[i]) - from[i],
    )
}

/// [`onto`], with the end given from the eye: what it is in digits that do not
/// cancel however far the light is.
#[inline(always)]
fn onto_from_afar<L: Lanes>(eye: [F32<L>; 3], to_end: [F32<L>; 3]) -> [F32<L>; 3] {
    let [x, y, z] = to_end;
    [eye[2] * x - eye[0] * z, eye[2] * y - eye[1] * z, -z]
}

/// Image of an end, the eye being in light coordinates.
#[inline(always)]
fn onto<L: Lanes>(l: L, eye: [F32<L>; 3], end: &[f32; 3]) -> [F32<L>; 3] {
    let [x, y, z] = *end;
    [
        eye[2] * x - eye[0] * z,
        eye[2] * y - eye[1] * z,
        eye[2] - F32::splat(l, z),
    ]
}

/// A sphere, seen as the disc through its centre that faces the fragment. Edges
/// are relative to its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight {
    /// See [`Projector::origin`].
    pub origin: [f32; 3],
    /// As for [`FlatLight`], but in the directions of world space.
    pub far: Option<[f32; 3]>,
    /// Radius.
    pub radius: f32,
    /// Whether the disc is as large as a sphere looks, `r / sqrt(1 - r^2 / D^2)`
    /// at distance D; else of radius r, as in paper IV (§4.2.1).
    pub seen: bool,
}
uniforms!(SphereLight {
    origin,
    far,
    radius,
    seen
});

impl SphereLight {
    #[inline(always)]
    fn project<L: Lanes>(&self, l: L, from: [F32<L>; 3], edge: &Edge) -> Projected<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let from_origin = from;
        let offset = self.far.unwrap_or_default();
        let from = if self.far.is_some() {
            each3(
                #[inline(always)]
                |i| from_origin[i] + offset[i],
            )
        } else {
            from
        };
        let squared = dot3(from, from);
        let radius = self.radius;
        let valid = squared.gt(F32::splat(l, radius * radius));
        let distance = valid.select_f32(squared, one).sqrt();
        let towards = each3(
            #[inline(always)]
            |i| from[i] / distance,
        );
        // Up to where the sphere's surface is seen: its horizon, or the disc.
        let (size, horizon) = if self.seen {
            let sine2 = F32::splat(l, radius * radius) / (distance * distance);
            let size = F32::splat(l, radius) / (one - sine2).sqrt();
            (size, sine2 * distance / size)
        } else {
            (F32::splat(l, radius), zero)
        };
        let [u, v] = across(l, towards);
        let eye = distance / size;
        let frame = [u, v, towards];
        // Of a far light, ends as seen from the fragment: only their height over the
        // centre has the distance in it.
        let from_eye = if self.far.is_some() {
            each2(
                #[inline(always)]
                |k| minus(l, &edge[k], from_origin),
            )
        } else {
            each2(
                #[inline(always)]
                |k| minus(l, &edge[k], [zero; 3]),
            )
        };
        let [mut a, mut b] = each2(
            #[inline(always)]
            |k| local(frame, size, from_eye[k]),
        );
        let mut below = [eye - a[2], eye - b[2]];
        if self.far.is_some() {
            below = [-a[2], -b[2]];
            a[2] = a[2] + eye;
            b[2] = b[2] + eye;
        }
        // What is behind that hides nothing of it.
        let [za, zb] = [a[2], b[2]];
        let [ha, hb] = [za - horizon, zb - horizon];
        let cut = ha / (ha - hb);
        let (behind_a, behind_b) = (ha.lt(zero), hb.lt(zero));
        Projected {
            ends: [
                [a[0] * eye, a[1] * eye, below[0]],
                [b[0] * eye, b[1] * eye, below[1]],
            ],
            part: [
                behind_a.select_f32(cut, zero),
                behind_b.select_f32(cut, one),
            ],
            valid: valid & !(behind_a & behind_b),
        }
    }
}

/// Two unit vectors at right angles to a unit vector (Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 2017).
#[inline(always)]
fn across<L: Lanes>(l: L, [x, y, z]: [F32<L>; 3]) -> [[F32<L>; 3]; 2] {
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    let sign = z.lt(zero).select_f32(-one, one);
    let a = -(one / (sign + z));
    let b = x * y * a;
    [
        [one + sign * x * x * a, sign * b, -(sign * x)],
        [b, sign + y * y * a, -y],
    ]
}

/// Runs `f` in a function of its own, compiled for the level: shaders share it, and
/// none becomes too large to compile quickly. Annotate the closure with
/// `#[inline(always)]`.
#[inline(always)]
pub(crate) fn outlined<L: Lanes, T>(l: L, f: impl FnOnce() -> T) -> T {
    l.isa().vectorize(f)
}

/// A point in coordinates of the frame, in units of `size`.
#[inline(always)]
fn local<L: Lanes>(frame: [[F32<L>; 3]; 3], size: F32<L>, p: [F32<L>; 3]) -> [F32<L>; 3] {
    each3(
        #[inline(always)]
        |i| dot3(frame[i], p) / size,
    )
}

/// The image of the edge's point at `t`, and whether it is in front.
#[inline(always)]
fn at<L: Lanes>(l: L, a: [F32<L>; 3], b: [F32<L>; 3], t: F32<L>) -> ([F32<L>; 2], Mask<L>) {
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    // The ends themselves where nothing was cut off: as the next edge has them.
    let h = each3(
        #[inline(always)]
        |i| {
            let inner = a[i] + (b[i] - a[i]) * t;
            let end = t.eq(one).select_f32(b[i], inner);
            t.eq(zero).select_f32(a[i], end)
        },
    );
    let front = h[2].gt(zero);
    let w = front.select_f32(h[2], one);
    ([h[0] / w, h[1] / w], front)
}

/// The part of a projected edge on the light.
#[inline(always)]
pub fn clip<L: Lanes>(l: L, image: Image, projected: &Projected<L>) -> Segment<L> {
    let [a, b] = projected.ends;
    let part = projected.part;
    let [from, to] = outlined(
        l,
        #[inline(always)]
        || match image {
            Image::Square => square::clip(l, a, b, part),
            Image::Disc => round::clip(l, a, b, part),
            Image::Polygon(outline) => polygon::clip(l, &outline, a, b, part),
        },
    );
    let (p, p_front) = at(l, a, b, from);
    let (q, q_front) = at(l, a, b, to);
    Segment {
        ends: [p, q],
        some: projected.valid & from.lt(to) & p_front & q_front,
    }
}

/// The covered share of the light, without sign: 0 to 1/2.
#[inline(always)]
pub fn covered<L: Lanes>(l: L, image: Image, segment: &Segment<L>) -> F32<L> {
    let [p, q] = segment.ends;
    let cross = (p[0] * q[1] - p[1] * q[0]).abs();
    let sector = outlined(
        l,
        #[inline(always)]
        || match image {
            Image::Square => square::sector(l, p, q),
            Image::Disc => round::sector(p, q),
            Image::Polygon(outline) => polygon::sector(l, &outline, p, q),
        },
    );
    let zero = F32::splat(l, 0.0);
    let share = ((sector - cross * 0.5) / image.area()).max(zero);
    segment.some.select_f32(share, zero)
}
