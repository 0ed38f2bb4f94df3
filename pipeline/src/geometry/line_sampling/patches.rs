//! Facets of one plane as one.
//!
//! The two triangles of a square lie in one plane but for rounding, and a receiver on one
//! of them would find itself before or behind the other by rounding alone. So neighbours
//! in one plane share its equation, and with it the one answer to which side a receiver
//! is on; edges between them are never contours.

use glam::DVec3;

use crate::world::adjacency::EdgeAdjacency;
use crate::world::mesh::Mesh;

/// How far corners may be off a plane, as a share of the mesh's largest coordinate: what
/// f32 rounds them by, and a little more.
const FLAT: f64 = 2e-7;

/// A plane: points where `normal . p + offset` is positive are before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Of length 1; 0 of facets without area, which nothing is before.
    pub normal: DVec3,
    /// See above.
    pub offset: f64,
}

impl Plane {
    /// How far before the plane.
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) + self.offset
    }

    fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Self {
            normal,
            offset: -normal.dot(a),
        }
    }
}

/// The planes of a mesh, and which is whose.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Planes.
    pub planes: Vec<Plane>,
    /// Place among them of each triangle's.
    pub of_triangle: Vec<u32>,
}

impl Patches {
    /// Of a mesh: each triangle not yet in a patch begins one, over all neighbours that lie
    /// in its plane.
    pub fn new(mesh: &Mesh, adjacency: &EdgeAdjacency) -> Self {
        let slack = FLAT * largest(mesh);
        let count = mesh.triangles().len();
        let mut patches = Self {
            planes: Vec::new(),
            of_triangle: vec![u32::MAX; count],
        };
        let mut open = Vec::new();
        for first in 0..count {
            if patches.of_triangle[first] != u32::MAX {
                continue;
            }
            let plane = Plane::of(mesh.corners(first));
            let number = patches.planes.len() as u32;
            patches.planes.push(plane);
            patches.of_triangle[first] = number;
            open.push(first);
            while let Some(t) = open.pop() {
                for other in neighbours(adjacency, t) {
                    let known = patches.of_triangle[other] != u32::MAX;
                    if !known && lies_in(&plane, mesh.corners(other), slack) {
                        patches.of_triangle[other] = number;
                        open.push(other);
                    }
                }
            }
        }
        patches
    }
}

fn largest(mesh: &Mesh) -> f64 {
    let all = mesh.positions().iter().flatten();
    all.fold(0.0, |most, c| most.max(f64::from(c.abs())))
}

/// Triangles on the other side of edges that two share.
fn neighbours(adjacency: &EdgeAdjacency, t: usize) -> impl Iterator<Item = usize> + '_ {
    (0..3).flat_map(move |k| {
        let uses = adjacency.edge(adjacency.edge_of(t, k)).uses;
        let both = uses.iter().filter(|_| uses.len() == 2);
        both.map(|u| u.triangle as usize).filter(move |u| *u != t)
    })
}

fn lies_in(plane: &Plane, corners: [DVec3; 3], slack: f64) -> bool {
    let turned = Plane::of(corners).normal.dot(plane.normal);
    turned > 0.5 && corners.iter().all(|c| plane.height(*c).abs() <= slack)
}
