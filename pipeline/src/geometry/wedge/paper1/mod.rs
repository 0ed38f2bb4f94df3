//! The linked wedges of papers I and II for a spherical light.
//!
//! Source: Akenine-Möller and Assarsson, "Approximate Soft Shadows on Arbitrary
//! Surfaces using Penumbra Wedges", 2002 (paper I), §4.1, §4.2 and §5. Front and
//! back plane of an edge go through it and through `f = c - r n` and `b = c + r n`
//! beside the light's centre; side planes are shared by neighbours in a
//! silhouette loop. What the paper leaves open is settled so:
//!
//! * n is the unit normal of the hard shadow quad that points *out of* the umbra;
//!   then the front plane bounds full light and the back plane full shadow.
//! * Where two neighbours' planes coincide (collinear edges), their common line is
//!   taken from the vertex away from f, or b.
//! * At a convex vertex where the quads turn by more than a quarter turn, up to
//!   [`MOST_EXTRA`] wedges without edge fill the turn in equal steps, in proportion
//!   to how far it exceeds the quarter.
//! * An edge within [`LinkedSettings::parallel_sine`] of the light's direction is
//!   collapsed to its middle, which shortens and connects its neighbours.
//! * Where the side planes meet inside front or back plane (figure 6), the wedge
//!   ends there: that face is a triangle. The umbra's boundary keeps the untruncated
//!   quad ([`LinkedWedge::front_quad`]), since neighbours' quads meet along the
//!   whole shared ray.

mod end;
mod intensity;
mod link;
mod parts;
mod shape;
mod touch;

pub use end::End;
pub use intensity::{SideDirections, smoothed};
pub use link::{LinkedSettings, LinkedStatistics, MOST_EXTRA, link, link_under};
pub use parts::{Cut, WedgeParts};
pub use shape::Overlap;
pub use touch::TouchedLight;

pub(crate) use parts::between_rays;

use glam::DVec3;

use super::Plane;

/// A wedge that shares its side planes with its neighbours in a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkedWedge {
    /// The edge, after collapsing; equal ends for an extra wedge at a vertex.
    pub edge: [DVec3; 2],
    /// Unit direction of the edge; of an extra wedge, that of its front plane.
    pub along: DVec3,
    /// Unit normal of the hard shadow quad, out of the umbra.
    pub outer: DVec3,
    /// Bounds full light; positive inside.
    pub front: Plane,
    /// Bounds full shadow; positive inside.
    pub back: Plane,
    /// Side planes at the first and the second end; positive inside.
    pub sides: [Plane; 2],
    /// Unit rays where the side planes meet the front plane.
    pub front_rays: [DVec3; 2],
    /// Unit rays where the side planes meet the back plane.
    pub back_rays: [DVec3; 2],
    /// Unit directions in the side planes, shared with the neighbours (§4.1).
    pub side_directions: SideDirections,
}

impl LinkedWedge {
    /// Front, back, and the two side planes; positive inside.
    pub fn planes(&self) -> [Plane; 4] {
        [self.front, self.back, self.sides[0], self.sides[1]]
    }

    /// The least distance to a plane; negative outside.
    pub fn depth(&self, p: DVec3) -> f64 {
        let depths = self.planes().map(|plane| plane.distance(p));
        depths.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Whether `p`, receiver or eye, is inside or on the boundary.
    pub fn contains(&self, p: DVec3) -> bool {
        self.depth(p) >= 0.0
    }

    /// The part of the umbra's boundary in the front plane: two triangles of
    /// homogeneous vertices, facing out of the shadow. Over a loop, and with caps,
    /// they close the shadow volume, also where side planes overlap.
    pub fn front_quad(&self) -> [[glam::DVec4; 3]; 2] {
        let [a, b] = self.edge.map(|e| e.extend(1.0));
        let [r, s] = self.front_rays.map(|ray| ray.extend(0.0));
        [[b, a, r], [b, r, s]]
    }
}
