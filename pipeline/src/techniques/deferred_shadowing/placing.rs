//! Where an occlusion map lies: the plane, the square of the light, and the window
//! (§4.2.2).
//!
//! A light that is a direction projects in parallel along it, as in the paper. A light
//! with a place projects from its centre, and the solid angle is that from the occluders:
//! the same formulas, which go over into the paper's as the light goes away.

use glam::{DVec3, DVec4};
use gnomon_shaders::deferred::obscured::OcclusionMap;
use gnomon_shaders::transform::ClipFromWorld;

use super::bodies::Body;
use super::groups::Group;
use super::settings::Plane;
use super::sources::Source;
use crate::parts::view::View;
use crate::truth::oracle::bvh::{Bvh, Ray};
use crate::world::light::HardLight;

/// A body that takes shadow, with what is asked of it for every map.
pub(super) struct Receiver<'b, 'a> {
    pub(super) body: &'b Body<'a>,
    triangles: Bvh,
}

impl<'b, 'a> Receiver<'b, 'a> {
    pub(super) fn new(body: &'b Body<'a>) -> Self {
        let mesh = &body.object.mesh;
        let corners: Vec<_> = (0..mesh.triangles().len())
            .map(|t| mesh.corners(t))
            .collect();
        Self {
            body,
            triangles: Bvh::new(&corners),
        }
    }

    /// The point through which the plane of a map passes.
    fn plane(&self, how: Plane, occluders: DVec3, towards: DVec3) -> DVec3 {
        let ray = Ray::new(occluders, -towards);
        let struck = match how {
            Plane::Centre => None,
            Plane::Struck => self.triangles.closest(&ray, 0.0..f64::INFINITY),
        };
        struck.map_or(self.body.centre(), |(_, t)| ray.at(t))
    }

    fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        points(self.body)
    }
}

fn points<'b>(body: &'b Body<'_>) -> impl Iterator<Item = DVec3> + 'b {
    let mesh = &body.object.mesh;
    (0..mesh.positions().len() as u32).map(|i| mesh.position(i))
}

/// A map to be drawn and looked up.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlacedMap {
    /// The occluders.
    pub(super) group: Group,
    /// Rows as in [`OcclusionMap::place`], for world space.
    rows: [DVec4; 3],
    below: DVec4,
    /// Width of the light's square as a share of the window, across and down.
    pub(super) square: [f64; 2],
    /// Whether occluders lie on both sides of the receiver's plane.
    pub(super) across_plane: bool,
}

/// From the world to a map's plane.
struct Projection {
    /// Towards the light.
    towards: DVec3,
    axes: [DVec3; 2],
    /// What is projected from: the light, or a point of the plane.
    from: DVec3,
    /// Distance from the light to the plane; `None` for parallel light.
    reach: Option<f64>,
}

/// How near to the light, in its distance from the plane, nothing is projected.
const TOO_NEAR: f64 = 1e-3;

impl Projection {
    fn new(source: &Source, towards: DVec3, plane: DVec3) -> Option<Self> {
        let (from, reach) = match source.at {
            HardLight::Directional(_) => (plane, None),
            HardLight::Point(light) => (light, Some((light - plane).dot(towards))),
        };
        let projection = Self {
            towards,
            axes: axes(towards, source.side),
            from,
            reach,
        };
        reach.is_none_or(|r| r > 0.0).then_some(projection)
    }

    /// How far before the light's plane; 1 in parallel light.
    fn w(&self) -> DVec4 {
        match self.reach {
            None => DVec4::W,
            Some(reach) => {
                let normal = -self.towards / reach;
                normal.extend(self.from.dot(self.towards) / reach)
            }
        }
    }

    /// Rows of u w and v w, in lengths on the plane.
    fn rows(&self) -> [DVec4; 2] {
        self.axes.map(|axis| axis.extend(-axis.dot(self.from)))
    }

    /// Where a point falls; `None` for one too near to the light or behind it.
    fn fall(&self, p: DVec3) -> Option<[f64; 2]> {
        let p = p.extend(1.0);
        let w = self.w().dot(p);
        (w > TOO_NEAR).then(|| self.rows().map(|row| row.dot(p) / w))
    }
}

/// Two unit vectors across `towards`, the first one along `side` where that says
/// something.
fn axes(towards: DVec3, side: DVec3) -> [DVec3; 2] {
    let across = (side - towards * side.dot(towards)).normalize_or_zero();
    let first = if across == DVec3::ZERO {
        let size = towards.abs();
        let least = (1..3).fold(0, |best, k| if size[k] < size[best] { k } else { best });
        towards.cross(DVec3::AXES[least]).normalize()
    } else {
        across
    };
    [first, towards.cross(first)]
}

/// Low and high corner on the plane.
type Window = [[f64; 2]; 2];

/// Round points; `None` where one of them does not fall on the plane, or there is none.
fn window(projection: &Projection, points: impl Iterator<Item = DVec3>) -> Option<Window> {
    let mut window: Option<Window> = None;
    for p in points {
        let at = projection.fall(p)?;
        let [low, high] = window.unwrap_or([at, at]);
        let least = [0, 1].map(|k| low[k].min(at[k]));
        window = Some([least, [0, 1].map(|k| high[k].max(at[k]))]);
    }
    window
}

fn wider([low, high]: Window, by: [f64; 2]) -> Window {
    [
        [0, 1].map(|k| low[k] - by[k]),
        [0, 1].map(|k| high[k] + by[k]),
    ]
}

fn common(a: Window, b: Window) -> Option<Window> {
    let low = [0, 1].map(|k| a[0][k].max(b[0][k]));
    let high = [0, 1].map(|k| a[1][k].min(b[1][k]));
    (low[0] < high[0] && low[1] < high[1]).then_some([low, high])
}

/// The map of a group's shadow on a receiver under a light; `None` where it has none.
pub(super) fn place(
    receiver: &Receiver<'_, '_>,
    group: &Group,
    bodies: &[Body<'_>],
    source: &Source,
    (how, side): (Plane, u32),
) -> Option<PlacedMap> {
    let centre = group.centre();
    let towards = source.at.towards_from(centre).normalize_or_zero();
    if towards == DVec3::ZERO {
        return None;
    }
    let occluders = || group.bodies.iter().flat_map(|&b| points(&bodies[b]));
    let heights = |points: &mut dyn Iterator<Item = DVec3>| {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        points.fold(none, |(low, high), p| {
            let height = p.dot(towards);
            (low.min(height), high.max(height))
        })
    };
    let (low, top) = heights(&mut occluders());
    if top <= heights(&mut receiver.points()).0 {
        return None; // all of it lies behind the receiver
    }
    let plane = receiver.plane(how, centre, towards);
    let distance = (centre - plane).dot(towards).max(0.0);
    let square = distance * source.solid_angle(centre).sqrt();
    let projection = Projection::new(source, towards, plane)?;
    let window = fitted(&projection, occluders(), receiver, square, side)?;
    let size = |k: usize| window[1][k] - window[0][k];
    if !(0..2).all(|k| size(k) > 0.0 && size(k).is_finite()) {
        return None; // seen edge on
    }
    let height = plane.dot(towards);
    Some(PlacedMap {
        group: group.clone(),
        rows: rows(&projection, window),
        below: (-towards).extend(top),
        square: [0, 1].map(|k| square / size(k)),
        across_plane: low < height && height < top,
    })
}

/// What of the plane is drawn: where shadow falls and the receiver is, and as much round
/// it as the light's square reaches.
fn fitted(
    projection: &Projection,
    occluders: impl Iterator<Item = DVec3>,
    receiver: &Receiver<'_, '_>,
    square: f64,
    side: u32,
) -> Option<Window> {
    let own = window(projection, receiver.points());
    let Some(cast) = window(projection, occluders) else {
        return own; // occluders reach behind the light: anywhere
    };
    let size = [0, 1].map(|k| cast[1][k] - cast[0][k] + square);
    // Two texels, so that the outermost ones see nothing.
    let rim = size.map(|s| 0.5 * square + 2.0 * s / f64::from(side.saturating_sub(4).max(1)));
    let cast = wider(cast, rim);
    match own {
        None => Some(cast),
        Some(own) => common(cast, wider(own, rim)).filter(|_| common(cast, own).is_some()),
    }
}

/// u w, v w and w with u and v in 0..1 over the window.
fn rows(projection: &Projection, [low, high]: Window) -> [DVec4; 3] {
    let w = projection.w();
    let lengths = projection.rows();
    let row = |k: usize| (lengths[k] - w * low[k]) / (high[k] - low[k]);
    [row(0), row(1), w]
}

impl PlacedMap {
    /// For positions relative to the view's origin.
    pub(super) fn look_up(&self, view: &View, cell: [u32; 2], side: u32, all: u32) -> OcclusionMap {
        let [column, row] = cell.map(|c| c as f32);
        OcclusionMap {
            place: self.rows.map(|r| relative(view, r)),
            below: relative(view, self.below),
            cell: [column, row, side as f32, all as f32],
        }
    }

    /// To clip space: row 0 of the map is the top, and depth is in the middle.
    pub(super) fn clip_from_world(&self, view: &View) -> ClipFromWorld {
        let [u, v, w] = self.rows;
        let rows = [u * 2.0 - w, w - v * 2.0, w * 0.5, w];
        ClipFromWorld(rows.map(|r| relative(view, r)))
    }
}

fn relative(view: &View, row: DVec4) -> [f32; 4] {
    let origin = view.absolute(DVec3::ZERO);
    let moved = row.truncate().extend(row.dot(origin.extend(1.0)));
    moved.to_array().map(|c| c as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_falls_where_its_ray_meets_the_plane() {
        let light = DVec3::new(0.0, 4.0, 0.0);
        let projection = Projection {
            towards: DVec3::Y,
            axes: axes(DVec3::Y, DVec3::X),
            from: light,
            reach: Some(4.0),
        };
        let fall = |x: f64, y: f64, z: f64| projection.fall(DVec3::new(x, y, z)).unwrap();
        assert_eq!(fall(1.0, 0.0, 0.0)[0], 1.0);
        assert_eq!(fall(1.0, 2.0, 0.0)[0], 2.0);
        assert_eq!(fall(0.0, 2.0, -0.5)[1], 1.0);
        assert!(projection.fall(DVec3::new(0.0, 5.0, 0.0)).is_none());
        let parallel = Projection {
            from: DVec3::new(0.0, 1.0, 3.0),
            reach: None,
            ..projection
        };
        let fall = parallel.fall(DVec3::new(2.0, 9.0, 3.0)).unwrap();
        assert_eq!(fall, [2.0, 0.0]);
    }

    #[test]
    fn windows_are_cut_to_what_both_need() {
        let a = [[0.0, 0.0], [4.0, 4.0]];
        let b = [[1.0, -2.0], [9.0, 3.0]];
        assert_eq!(common(a, b), Some([[1.0, 0.0], [4.0, 3.0]]));
        assert_eq!(common(a, [[5.0, 0.0], [6.0, 1.0]]), None);
        assert_eq!(wider(a, [1.0, 0.5]), [[-1.0, -0.5], [5.0, 4.5]]);
    }
}
