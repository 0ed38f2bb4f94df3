//! The polyhedron of a linked wedge, also where its side planes overlap.

use glam::DVec3;

use super::LinkedWedge;
use crate::geometry::wedge::WedgeMesh;
use crate::geometry::wedge::polyhedron::{End, Ends, Polyhedron};

/// In which of its planes the sides of a wedge meet (paper I, figure 6). Turns at a
/// convex vertex meet in the back plane at the vertex itself: b runs round the
/// light's centre against f.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Overlap {
    /// In the front plane only, at this point; the back face has no end.
    Front(DVec3),
    /// In the back plane only, at this point; the front face has no end.
    Back(DVec3),
    /// In both, front point first: the wedge is a tetrahedron.
    Both([DVec3; 2]),
}

impl LinkedWedge {
    /// Where the side planes meet inside front or back plane, if they do.
    pub fn overlap(&self) -> Option<Overlap> {
        let front = meeting_point(self.edge, self.front_rays, self.front.normal);
        let back = meeting_point(self.edge, self.back_rays, -self.back.normal);
        match (front, back) {
            (Some(f), Some(b)) => Some(Overlap::Both([f, b])),
            (Some(f), None) => Some(Overlap::Front(f)),
            (None, Some(b)) => Some(Overlap::Back(b)),
            (None, None) => None,
        }
    }

    /// The closed boundary, its far cap at infinity; ends where the sides meet.
    pub fn mesh(&self) -> WedgeMesh {
        match self.overlap() {
            None => self.open_mesh(),
            Some(Overlap::Both([front, back])) => self.tetrahedron(front, back),
            Some(Overlap::Front(tip)) => self.tapered(tip, true),
            Some(Overlap::Back(tip)) => self.tapered(tip, false),
        }
    }

    fn open_mesh(&self) -> WedgeMesh {
        let end = |k: usize| End {
            apex: self.edge[k],
            rays: vec![self.front_rays[k], self.back_rays[k]],
        };
        if self.edge[0] != self.edge[1] {
            return Polyhedron::new(Ends::Two([end(0), end(1)])).mesh();
        }
        // A turn at a vertex: a pyramid over front and back rays.
        let rays = vec![
            self.front_rays[0],
            self.back_rays[0],
            self.back_rays[1],
            self.front_rays[1],
        ];
        let apex = self.edge[0];
        Polyhedron::new(Ends::One(End { apex, rays })).mesh()
    }

    fn tetrahedron(&self, front: DVec3, back: DVec3) -> WedgeMesh {
        let mut mesh = WedgeMesh::default();
        let [a, b, f, g] = [self.edge[0], self.edge[1], front, back].map(|p| mesh.point(p));
        for face in [[a, f, b], [a, b, g], [a, g, f], [b, f, g]] {
            mesh.face(&face);
        }
        mesh
    }

    /// One face ends in a tip, from where the sides' common line runs on.
    fn tapered(&self, tip: DVec3, in_front: bool) -> WedgeMesh {
        let line = self.sides[0].normal.cross(self.sides[1].normal);
        let inwards = if in_front { self.front } else { self.back }.normal;
        let line = if line.dot(inwards) < 0.0 { -line } else { line };
        let far = if in_front {
            self.back_rays
        } else {
            self.front_rays
        };
        let mut mesh = WedgeMesh::default();
        let [a, b, t] = [self.edge[0], self.edge[1], tip].map(|p| mesh.point(p));
        let [r, s, m] = [far[0], far[1], line.normalize_or_zero()].map(|d| mesh.direction(d));
        // Oriented for a tip in the front plane.
        let faces: [&[u32]; 5] = [
            &[a, t, b],
            &[a, b, s, r],
            &[a, r, m, t],
            &[b, t, m, s],
            &[r, s, m],
        ];
        for face in faces {
            let mut face = face.to_vec();
            if !in_front {
                face.reverse();
            }
            mesh.face(&face);
        }
        mesh
    }
}

/// Where two rays from the ends of an edge, in one plane with it, meet. `normal` is
/// that of the front plane, or against that of the back plane.
fn meeting_point([a, b]: [DVec3; 2], [r, s]: [DVec3; 2], normal: DVec3) -> Option<DVec3> {
    let across = r.cross(s).dot(normal);
    // Parallel within rounding counts as never meeting.
    if across <= 1e-12 {
        return None;
    }
    let edge = b - a;
    if edge == DVec3::ZERO {
        return Some(a); // a turn at a vertex whose rays are in the wrong order
    }
    let (t, u) = (edge.cross(s).dot(normal), edge.cross(r).dot(normal));
    (t > 0.0 && u > 0.0).then(|| a + r * (t / across))
}
