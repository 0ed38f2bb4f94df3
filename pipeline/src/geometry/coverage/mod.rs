//! How much of an area light one silhouette edge covers, seen from a receiver:
//! the f64 twin of what wedge shaders compute.
//!
//! Project the edge onto the light from the receiver and clip it there. The
//! *coverage* of the edge is the part of the light between the clipped edge and
//! the light's border, within the two rays from the light's centre through its
//! ends: the image of the hard shadow quad (paper III, §3.2.2; paper IV, §4.2).
//! With the sector S between the rays and the triangle of centre and clipped edge,
//!
//! ```text
//! c = (|S| - |p0 x p1| / 2) / A,      V = 1 - w + sum s c
//! ```
//!
//! where A is the light's area, V its visible fraction, w the hard shadow count
//! (how often the loop winds round the light's centre), and s is +1 for receivers
//! on the umbra side of the edge's hard shadow quad and -1 on the other. For one
//! simple loop nearer to the light than the receiver this is not an approximation.
//!
//! One predicate, [`umbra_side`], serves both w and s; were they to differ for a
//! receiver on the quad, V would be wrong by 1.

mod image;
mod polygon;
mod round;
mod square;

pub use image::{ImageSums, Spoke};
pub use polygon::PolygonImage;

use glam::{DVec2, DVec3};

use crate::geometry::area_light::AreaLight;
use crate::geometry::wedge::Plane;
use crate::world::light::LightShape;

/// An edge as seen on a light: ends in units of half the light's size, the
/// light's centre at the origin.
pub type LightSegment = [DVec2; 2];

/// A light that edges are projected on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlane {
    /// A parallelogram; its image is the square -1..1.
    Rectangle {
        /// Centre.
        centre: DVec3,
        /// Half of each edge.
        half_edges: [DVec3; 2],
    },
    /// A flat disc; its image is the unit disc.
    Disc {
        /// Centre.
        centre: DVec3,
        /// Unit normal.
        normal: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A sphere, seen as a disc through its centre that faces the receiver.
    Sphere {
        /// Centre.
        centre: DVec3,
        /// Radius.
        radius: f64,
        /// What disc.
        outline: SphereOutline,
    },
}

/// The disc that stands for a sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereOutline {
    /// Of the sphere's radius r, as paper IV has it (§4.2.1).
    Equator,
    /// Of radius `r / sqrt(1 - r^2 / D^2)` at distance D: what a sphere looks like.
    #[default]
    Seen,
}

impl LightPlane {
    /// The light plane of a scene's light; `None` for lights without area
    /// and for polygons.
    pub fn new(shape: &LightShape, outline: SphereOutline) -> Option<Self> {
        match *shape {
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => Some(Self::Rectangle {
                centre,
                half_edges: [0.5 * edge_u, 0.5 * edge_v],
            }),
            LightShape::Disc {
                centre,
                normal,
                radius,
            } => Some(Self::Disc {
                centre,
                normal: normal.normalize_or(DVec3::Z),
                radius,
            }),
            LightShape::Sphere { centre, radius } => Some(Self::Sphere {
                centre,
                radius,
                outline,
            }),
            LightShape::Polygon(_) | LightShape::Point { .. } | LightShape::Directional { .. } => {
                None
            }
        }
    }

    /// The same light for wedges; `None` where it has no area after all.
    pub fn area_light(&self) -> Option<AreaLight> {
        let shape = match *self {
            Self::Rectangle { centre, half_edges } => LightShape::Rectangle {
                centre,
                edge_u: 2.0 * half_edges[0],
                edge_v: 2.0 * half_edges[1],
            },
            Self::Disc {
                centre,
                normal,
                radius,
            } => LightShape::Disc {
                centre,
                normal,
                radius,
            },
            Self::Sphere { centre, radius, .. } => LightShape::Sphere { centre, radius },
        };
        AreaLight::new(&shape).ok()
    }

    /// The light's centre.
    pub fn centre(&self) -> DVec3 {
        match *self {
            Self::Rectangle { centre, .. }
            | Self::Disc { centre, .. }
            | Self::Sphere { centre, .. } => centre,
        }
    }

    /// The projection from `receiver`; `None` where it has none: in the light's
    /// plane, or inside a sphere.
    pub fn seen_from(&self, receiver: DVec3) -> Option<Projection> {
        let eye = receiver - self.centre();
        let (axes, image) = match *self {
            Self::Rectangle {
                half_edges: [u, v], ..
            } => (dual(u, v)?, Image::Square),
            Self::Disc { normal, radius, .. } => {
                let (u, v) = normal.any_orthonormal_pair();
                ([u / radius, v / radius, normal / radius], Image::Disc)
            }
            Self::Sphere {
                radius, outline, ..
            } => {
                let distance = eye.length();
                if distance <= radius {
                    return None;
                }
                let normal = eye / distance;
                let (u, v) = normal.any_orthonormal_pair();
                let sine = radius / distance;
                let seen = match outline {
                    SphereOutline::Equator => radius,
                    SphereOutline::Seen => radius / (1.0 - sine * sine).sqrt(),
                };
                ([u / seen, v / seen, normal / seen], Image::Disc)
            }
        };
        let [x, y, z] = axes.map(|axis| axis.dot(eye));
        let side = if z < 0.0 { -1.0 } else { 1.0 };
        let centre = self.centre();
        (z != 0.0).then_some(Projection {
            centre,
            axes: [axes[0], axes[1], axes[2] * side],
            eye: DVec3::new(x, y, z * side),
            image,
        })
    }
}

/// What the light looks like in its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Image {
    Square,
    Disc,
}

/// The central projection from one receiver onto a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    centre: DVec3,
    /// Covectors that give light coordinates; the third grows towards the receiver.
    axes: [DVec3; 3],
    /// The receiver in light coordinates; z is positive.
    eye: DVec3,
    image: Image,
}

impl Projection {
    /// The homogeneous image of a world-space point: x and y over w are light
    /// coordinates, w is positive in front of the receiver.
    pub fn homogeneous(&self, point: DVec3) -> DVec3 {
        let [x, y, z] = self.axes.map(|axis| axis.dot(point - self.centre));
        DVec3::new(
            x * self.eye.z - self.eye.x * z,
            y * self.eye.z - self.eye.y * z,
            self.eye.z - z,
        )
    }

    /// The receiver's distance from the light's plane, in the units of homogeneous
    /// images: that of a point in the plane has this w.
    pub fn distance(&self) -> f64 {
        self.eye.z
    }

    /// The part of the edge's image on the light; `None` where there is none.
    ///
    /// Clips in homogeneous coordinates to `|x| <= w, |y| <= w`, or to
    /// `x^2 + y^2 <= w^2, w >= 0`, which leaves out what is behind the receiver.
    /// Never against the light's plane: see [`AreaLight::clip`] for edges that
    /// cross it.
    pub fn clip(&self, edge: [DVec3; 2]) -> Option<LightSegment> {
        let [a, b] = edge.map(|e| self.homogeneous(e));
        let [from, to] = match self.image {
            Image::Square => square::clip(a, b)?,
            Image::Disc => round::clip(a, b)?,
        };
        let at = |t: f64| {
            let h = a + (b - a) * t;
            (h.z > 0.0).then(|| h.truncate() / h.z)
        };
        Some([at(from)?, at(to)?])
    }

    /// The covered fraction `c` of the light, without sign, for a clipped edge:
    /// 0 to 1/2.
    pub fn covered([p, q]: LightSegment, is_square: bool) -> f64 {
        let cross = p.perp_dot(q).abs();
        let (sector, area) = if is_square {
            (square::sector(p, q), 4.0)
        } else {
            (round::sector(p, q), std::f64::consts::PI)
        };
        ((sector - 0.5 * cross) / area).max(0.0)
    }

    /// The coverage of an edge, without sign; 0 where its image misses the light,
    /// and for a receiver on the edge.
    pub fn coverage(&self, edge: [DVec3; 2]) -> f64 {
        let segment = self.clip(edge);
        segment.map_or(0.0, |s| Self::covered(s, self.image == Image::Square))
    }
}

/// Share of a square between the rays from its centre through two points, on the
/// side where they are less than half a turn apart; for look-up tables.
pub(crate) fn square_share(p: DVec2, q: DVec2) -> f64 {
    square::sector(p, q) / 4.0
}

/// Area of the square swept counter-clockwise from the direction (1, -1) to that of
/// p, 0 to 4: corners are at whole numbers.
pub(crate) fn square_swept(p: DVec2) -> f64 {
    square::swept(p)
}

/// Whether a receiver is on the umbra side of the edge's hard shadow quad: the
/// one predicate for shadow count, sign of the coverage, and wedge halves.
/// Receivers on the plane, and edges that point at the centre, count as outside.
pub fn umbra_side(light_centre: DVec3, edge: [DVec3; 2], receiver: DVec3) -> bool {
    crate::geometry::wedge::hard_plane(light_centre, edge)
        .is_some_and(|plane: Plane| plane.distance(receiver) < 0.0)
}

/// The visible fraction of a light behind one closed loop of silhouette edges,
/// given as its points, directed as silhouettes are; `None` where the projection
/// does not exist or a point is not in front of the receiver.
///
/// Exact for simple loops on the near side of the light. Nothing is clamped.
pub fn loop_visibility(light: &LightPlane, points: &[DVec3], receiver: DVec3) -> Option<f64> {
    let projection = light.seen_from(receiver)?;
    let images: Vec<DVec3> = points.iter().map(|p| projection.homogeneous(*p)).collect();
    if images.iter().any(|h| h.z <= 0.0) {
        return None;
    }
    let centre = light.centre();
    let n = points.len();
    let (mut turned, mut sum) = (0.0, 0.0);
    for k in 0..n {
        let edge = [points[k], points[(k + 1) % n]];
        let umbra = umbra_side(centre, edge, receiver);
        let sign = if umbra { 1.0 } else { -1.0 };
        turned += sign * angle(images[k], images[(k + 1) % n]);
        sum += sign * projection.coverage(edge);
    }
    let count = (turned / std::f64::consts::TAU).round();
    Some(1.0 - count + sum)
}

/// Angle without sign that an edge's image takes up round the light's centre. The
/// sign comes from the one predicate, so that the count agrees with it also where
/// the image passes through the centre and rounding would decide.
fn angle(a: DVec3, b: DVec3) -> f64 {
    let (a, b) = (a.truncate(), b.truncate());
    libm::atan2(a.perp_dot(b).abs(), a.dot(b))
}

/// Covectors dual to u, v and a unit normal.
fn dual(u: DVec3, v: DVec3) -> Option<[DVec3; 3]> {
    let normal = u.cross(v);
    let squared = normal.length_squared();
    (squared > 0.0).then(|| {
        [
            v.cross(normal) / squared,
            normal.cross(u) / squared,
            normal / squared.sqrt(),
        ]
    })
}
