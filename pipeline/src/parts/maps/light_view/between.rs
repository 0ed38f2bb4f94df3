//! Which casters can come between a light and the receivers of a view, exactly.
//!
//! Bounds of triangles say enough where casters keep clear of the light. Walls,
//! floors and lampshades do not: a wall beside a lamp passes it at distance 0, and
//! with that for a near distance a view is of no use. So here a triangle counts
//!
//! * for the part of it that is in the hull of light and receivers, and
//! * if it has a receiver on the other side of its plane than the light. The walls of
//!   a convex room have none, nor has a level floor: they shadow nothing.

use glam::DVec3;
use gnomon_shaders::light_view::{Projection, ViewRegion};

use super::convex::TangentBox;
use super::fit::{Facet, clipped};
use super::frame::{LightExtent, LightFrame};
use super::surroundings::Surroundings;
use crate::world::scene::clip;

/// Heights over planes that count as 0, as a share of the receivers' extent: some
/// times what f32 may move a corner by.
const FLAT: f64 = 1e-6;

/// The light and the receivers of a view, in its coordinates.
pub(super) struct Between {
    frame: LightFrame,
    /// The light's corners; its centre, if it is a ball or a point.
    light: Vec<DVec3>,
    /// How far it reaches beyond them.
    radius: f64,
    /// Half widths of the light along the picture's axes.
    halves: [f64; 2],
    /// Seen receivers' corners beyond the near distance.
    receivers: Vec<DVec3>,
    /// Bounds of their places.
    places: TangentBox,
    /// Bounds of themselves.
    low: DVec3,
    high: DVec3,
    near: f64,
    farthest: f64,
}

impl Between {
    pub(super) fn new(
        around: &Surroundings<'_>,
        frame: LightFrame,
        region: ViewRegion,
        extent: LightExtent,
        places: TangentBox,
        [near, farthest]: [f64; 2],
    ) -> Self {
        let mut receivers = Vec::new();
        let seen = around.seen_receivers();
        clipped(seen, &frame, region, near, |polygon| {
            receivers.extend_from_slice(polygon);
        });
        let low = receivers.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
        let high = receivers.iter().fold(DVec3::NEG_INFINITY, |a, p| a.max(*p));
        let (light, radius) = outline(&frame, extent);
        Self {
            frame,
            light,
            radius,
            halves: [0, 1].map(|k| extent.half_along(frame.axes[k])),
            receivers,
            places,
            low,
            high,
            near,
            farthest,
        }
    }

    /// The triangles that may be in the way, each as large as what of it may be.
    pub(super) fn facets(&self, around: &Surroundings<'_>) -> Vec<Facet> {
        let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
        let mut all = Vec::new();
        for &(object, mesh) in &around.casters {
            for triangle in 0..mesh.triangles().len() {
                let corners = mesh.corners(triangle).map(|p| self.frame.local(p));
                polygon.clear();
                polygon.extend(corners);
                self.keep_hull(&mut polygon, &mut scratch);
                let cut = polygon.iter().any(|p| p.z < self.near);
                if cut {
                    clip(&mut polygon, &mut scratch, |p| p.z - self.near);
                }
                if !polygon.is_empty() && self.parted_by(corners) {
                    all.push(Facet {
                        bounds: TangentBox::of(&polygon, self.frame.projection),
                        object,
                        triangle: triangle as u32,
                        cut,
                    });
                }
            }
        }
        all
    }

    /// Keeps what is in the hull of the light, at distance 0, and the receivers'
    /// places, at the farthest distance.
    fn keep_hull(&self, polygon: &mut Vec<DVec3>, scratch: &mut Vec<DVec3>) {
        let perspective = self.frame.projection == Projection::Perspective;
        clip(polygon, scratch, |p| p.z);
        clip(polygon, scratch, |p| self.farthest - p.z);
        for k in 0..2 {
            let (low, high, half) = (self.places.low[k], self.places.high[k], self.halves[k]);
            // Of the places at z, and of the light that is left there.
            let share = |p: DVec3| match perspective {
                true => (p.z, half * (1.0 - p.z / self.farthest)),
                false => (1.0, 0.0),
            };
            clip(polygon, scratch, |p| {
                let (places, light) = share(p);
                p.to_array()[k] - (low * places - light)
            });
            clip(polygon, scratch, |p| {
                let (places, light) = share(p);
                high * places + light - p.to_array()[k]
            });
        }
    }

    /// Whether the plane of a triangle parts some receiver from some of the light.
    fn parted_by(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let normal = (b - a).cross(c - a);
        let Some(normal) = normal.try_normalize() else {
            return false;
        };
        let extent = (self.high - self.low).length();
        let flat = FLAT * extent;
        let height = |p: DVec3| normal.dot(p - a);
        let (least, most) = match self.frame.projection {
            // Before all that is seen, by as much as its extent.
            Projection::Orthographic => (-normal.z * extent, -normal.z * extent),
            Projection::Perspective => {
                let heights = self.light.iter().map(|p| height(*p));
                let bounds = (f64::INFINITY, f64::NEG_INFINITY);
                heights.fold(bounds, |(a, b), h| {
                    (a.min(h - self.radius), b.max(h + self.radius))
                })
            }
        };
        let side = match (least >= -flat, most <= flat) {
            (true, true) => return false, // seen edge on
            (true, false) => 1.0,
            (false, true) => -1.0,
            (false, false) => return true, // the light is on both sides
        };
        let beyond = |p: DVec3| side * height(p) < -flat;
        self.bounds().any(beyond) && self.receivers.iter().any(|p| beyond(*p))
    }

    /// Corners of the receivers' bounds.
    fn bounds(&self) -> impl Iterator<Item = DVec3> {
        let ends = [self.low, self.high];
        (0..8usize).map(move |k| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z))
    }
}

/// The light's corners in a frame, and how far it reaches beyond them.
fn outline(frame: &LightFrame, extent: LightExtent) -> (Vec<DVec3>, f64) {
    let centre = frame.local(frame.centre);
    match extent {
        LightExtent::None => (vec![centre], 0.0),
        // The square stands for a ball of its area.
        LightExtent::Ball(half) => (vec![centre], half / super::frame::SQUARE_OF_DISC),
        LightExtent::Flat([u, v]) => {
            let corner = |s: f64, t: f64| frame.local(frame.centre + u * s + v * t);
            let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            (signs.map(|(s, t)| corner(s, t)).to_vec(), 0.0)
        }
    }
}
