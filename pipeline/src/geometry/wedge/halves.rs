//! Wedges split by their hard shadow quad (paper IV, §4.2 and figure 2).
//!
//! The outer half (lit without the penumbra) takes coverage away from the light,
//! the inner half gives it back. What splits them is the hard shadow quad with
//! its very vertices, so that drawing it classifies a receiver as the hard shadow
//! count did, closed by triangles in its plane on either side, and by one more
//! above it where the wedge's edge is relocated.

use glam::{DVec3, DVec4};

use super::mesh::WedgeMesh;
use super::polyhedron::{Cut, End, Ends, half_mesh};
use super::{Plane, Wedge};

/// The two halves of a wedge as closed meshes, and what separates them.
#[derive(Clone, Debug, PartialEq)]
pub struct WedgeHalves {
    /// The half outside the umbra of a hard shadow, closed by the centre.
    pub outer: WedgeMesh,
    /// The half inside it, closed by the centre.
    pub inner: WedgeMesh,
    /// Centre triangles, facing the outer side: first the two of the hard
    /// shadow quad as [`crate::geometry::volume::ShadowVolume`] has them, then the others.
    pub centre: Vec<[DVec4; 3]>,
    /// The splitting plane, positive in the outer half.
    pub plane: Plane,
}

impl Wedge {
    /// Splits the wedge. `None` where there is nothing to split by, because the
    /// edge points at the light's centre and covers nothing, or where the wedge
    /// is a half-space.
    pub fn halves(&self) -> Option<WedgeHalves> {
        let plane = self.hard_plane()?;
        let (outer_ends, inner_ends) = match self.volume.ends() {
            Ends::Two(ends) => split_two(ends, plane.normal)?,
            Ends::One(end) => split_one(end, plane.normal)?,
            Ends::HalfSpace(_) => return None,
        };
        let [a, b] = &outer_ends;
        let sides = [*a.rays.last()?, *b.rays.last()?];
        let centre = self.centre_triangles([a.apex, b.apex], sides);
        let quad = self.hard_quad();
        let between = [quad[2].truncate(), quad[3].truncate()];
        let half = |ends: &[End; 2], replaces_back| {
            let cut = Cut {
                replaces_back,
                triangles: &centre,
                between,
            };
            half_mesh(ends, &cut)
        };
        Some(WedgeHalves {
            outer: half(&outer_ends, true),
            inner: half(&inner_ends, false),
            plane,
            centre,
        })
    }

    /// `apexes` of the wedge, and the `sides`: its rays in the splitting plane.
    fn centre_triangles(&self, apexes: [DVec3; 2], sides: [DVec3; 2]) -> Vec<[DVec4; 3]> {
        let [e0, e1, d0, d1] = self.hard_quad();
        let [a0, a1] = apexes.map(|a| a.extend(1.0));
        let [x0, x1] = sides.map(|x| x.extend(0.0));
        let all = [
            [e1, e0, d0],
            [e1, d0, d1],
            [e0, x0, d0],
            [e1, d1, x1],
            // Above the quad, where an end was moved; else without extent.
            [a0, x0, e0],
            [a1, e1, x1],
            [a0, e0, e1],
            [a0, e1, a1],
        ];
        let extended = |t: &[DVec4; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        all.into_iter().filter(extended).collect()
    }
}

/// Ends of the outer and the inner half.
type Halved = ([End; 2], [End; 2]);

fn split_two(ends: &[End; 2], outer: DVec3) -> Option<Halved> {
    let [a, b] = [cross(&ends[0], outer)?, cross(&ends[1], outer)?];
    Some(([a.0, b.0], [a.1, b.1]))
}

/// The rays in front of the plane with the one in the plane, and the rest with it.
fn cross(end: &End, outer: DVec3) -> Option<(End, End)> {
    let sides: Vec<f64> = end.rays.iter().map(|r| outer.dot(*r)).collect();
    // The first ray is in front of the plane and the last behind, but for rounding.
    let last = sides.len().checked_sub(1)?;
    let front = sides[..last]
        .iter()
        .take_while(|s| **s > 0.0)
        .count()
        .max(1);
    let crossing = if last == 0 {
        end.rays[0]
    } else {
        between(
            end.rays[front - 1],
            end.rays[front],
            sides[front - 1],
            sides[front],
        )
    };
    let end_of = |rays| End {
        apex: end.apex,
        rays,
    };
    let outer_rays = end.rays[..front].iter().copied().chain([crossing]);
    let inner_rays = [crossing]
        .into_iter()
        .chain(end.rays[front..].iter().copied());
    Some((end_of(outer_rays.collect()), end_of(inner_rays.collect())))
}

/// Where the plane meets the face between two rays.
fn between(front: DVec3, behind: DVec3, front_side: f64, behind_side: f64) -> DVec3 {
    let (f, b) = (front_side.max(0.0), (-behind_side).max(0.0));
    (front * b + behind * f).normalize_or(front)
}

fn split_one(end: &End, outer: DVec3) -> Option<Halved> {
    let n = end.rays.len();
    let side = |k: usize| outer.dot(end.rays[k % n]);
    let is_front = |k: usize| side(k) > 0.0;
    let leaves = (0..n).find(|&k| is_front(k) && !is_front(k + 1))?;
    let enters = (leaves + 1..leaves + n).find(|&k| !is_front(k) && is_front(k + 1))?;
    let ray = |k: usize| end.rays[k % n];
    let x0 = between(ray(leaves), ray(leaves + 1), side(leaves), side(leaves + 1));
    let x1 = between(ray(enters + 1), ray(enters), side(enters + 1), side(enters));
    // A pyramid is two ends at one apex that share the ray where they part.
    let chain = |rays: Vec<DVec3>| End {
        apex: end.apex,
        rays,
    };
    let middle = (enters + 1 + leaves + n) / 2; // among the rays in front
    let first: Vec<DVec3> = (middle..=leaves + n).map(ray).chain([x0]).collect();
    let second: Vec<DVec3> = (enters + 1..=middle).rev().map(ray).chain([x1]).collect();
    let inner_middle = (leaves + 1 + enters) / 2;
    let inner_first = [x0].into_iter().chain((leaves + 1..=inner_middle).map(ray));
    let inner_second = [x1]
        .into_iter()
        .chain((inner_middle..=enters).rev().map(ray));
    let (inner_first, inner_second) = (inner_first.collect(), inner_second.collect());
    Some((
        [chain(first), chain(second)],
        [chain(inner_first), chain(inner_second)],
    ))
}
