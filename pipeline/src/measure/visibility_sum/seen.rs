//! A light as one receiver sees it.

use glam::{DVec2, DVec3};

use crate::geometry::area_light::AreaLight;
use crate::geometry::coverage::{LightSegment, Projection};

/// A silhouette edge before a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenEdge {
    /// Its place among all edges.
    pub number: usize,
    /// Index into [`crate::world::scene::Scene::objects`].
    pub object: usize,
    /// Its part on the light, in the light's own coordinates: the square -1..1, or the
    /// unit disc.
    pub on_light: LightSegment,
    /// What it covers, as a share of the light, without sign: 0 to 1/2.
    pub coverage: f64,
    /// Whether the receiver is on the umbra side of its hard shadow quad.
    pub inside: bool,
}

impl SeenEdge {
    /// What the edge adds to the visible share: its coverage where the receiver is inside
    /// the hard shadow, and minus that outside.
    pub fn contribution(&self) -> f64 {
        match self.inside {
            true => self.coverage,
            false => -self.coverage,
        }
    }
}

/// The summands of one receiver's visibility.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenLight {
    /// Whether the light is the square -1..1; else it is the unit disc.
    pub is_square: bool,
    /// How many layers of casters hide the light's centre.
    pub centre_hidden: u32,
    /// Edges that cut the light.
    pub edges: Vec<SeenEdge>,
}

impl SeenLight {
    /// The papers' sum, not clamped: beyond 0..=1 where silhouettes overlap or are not
    /// those that the receiver would see.
    pub fn sum(&self) -> f64 {
        let covered: f64 = self.edges.iter().map(SeenEdge::contribution).sum();
        1.0 - f64::from(self.centre_hidden) + covered
    }

    /// By how much the sum leaves 0..=1: negative below, positive above.
    pub fn saturation(&self) -> f64 {
        let sum = self.sum();
        sum - sum.clamp(0.0, 1.0)
    }
}

/// A triangle of a caster as it looks on a light.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenTriangle {
    /// Index into [`crate::world::scene::Scene::objects`].
    pub object: usize,
    /// Corners in the light's coordinates; more than three where it was cut.
    pub corners: Vec<DVec2>,
}

/// Nearer to the receiver, in terms of its distance to the light's plane, nothing is seen.
const NEAREST: f64 = 1e-9;
/// Triangles that are all beyond this, in halves of the light's size, are left out.
const FAR_OFF: f64 = 4.0;

impl SeenTriangle {
    /// `None` where it is not before the light.
    pub(super) fn of(
        projection: &Projection,
        side: &AreaLight,
        object: usize,
        corners: &[DVec3; 3],
    ) -> Option<Self> {
        let before = |p: DVec3| side.normal().map_or(1.0, |n| n.dot(p - side.centre()));
        let front = cut(corners, before);
        let images: Vec<DVec3> = front.iter().map(|p| projection.homogeneous(*p)).collect();
        let nearest = NEAREST * projection.distance();
        let images = cut(&images, |h| h.z - nearest);
        let corners: Vec<DVec2> = images.iter().map(|h| h.truncate() / h.z).collect();
        let beyond = |outside: fn(&DVec2) -> bool| corners.iter().all(outside);
        let is_off = corners.len() < 3
            || beyond(|p| p.x > FAR_OFF)
            || beyond(|p| p.x < -FAR_OFF)
            || beyond(|p| p.y > FAR_OFF)
            || beyond(|p| p.y < -FAR_OFF);
        (!is_off).then_some(Self { object, corners })
    }
}

/// The part of a convex polygon where `height` is positive.
fn cut(polygon: &[DVec3], height: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (height(a), height(b));
        if at_a > 0.0 {
            part.push(a);
        }
        if (at_a > 0.0) != (at_b > 0.0) {
            part.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    part
}
