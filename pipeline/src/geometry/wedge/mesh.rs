//! Closed triangle meshes with vertices at infinity, to be drawn.

use glam::{DVec3, DVec4};

/// A closed triangle mesh of homogeneous vertices, world space. Triangles are
/// counter-clockwise seen from outside; every edge is walked once each way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WedgeMesh {
    /// `(p, 1)` or `(direction, 0)`.
    pub vertices: Vec<DVec4>,
    /// Indices into the vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl WedgeMesh {
    /// Vertices rounded once for the GPU.
    pub fn positions_f32(&self) -> Vec<[f32; 4]> {
        let narrow = |v: &DVec4| v.to_array().map(|c| c as f32);
        self.vertices.iter().map(narrow).collect()
    }

    /// The number of directed edges that are not met by exactly one the other
    /// way round; 0 for a closed mesh.
    pub fn open_edges(&self) -> usize {
        let mut balance = std::collections::BTreeMap::<[u32; 2], [usize; 2]>::new();
        for t in &self.triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                balance.entry([a.min(b), a.max(b)]).or_default()[usize::from(a < b)] += 1;
            }
        }
        balance.values().filter(|walks| **walks != [1, 1]).count()
    }

    pub(super) fn point(&mut self, p: DVec3) -> u32 {
        self.vertex(p.extend(1.0))
    }

    pub(super) fn direction(&mut self, d: DVec3) -> u32 {
        self.vertex(d.extend(0.0))
    }

    /// Equal vertices become one, so that faces that shrink to nothing vanish.
    fn vertex(&mut self, v: DVec4) -> u32 {
        let known = self.vertices.iter().position(|u| *u == v);
        known.unwrap_or_else(|| {
            self.vertices.push(v);
            self.vertices.len() - 1
        }) as u32
    }

    /// A convex face, as a fan; corners that repeat their neighbour are skipped.
    pub(super) fn face(&mut self, corners: &[u32]) {
        let mut distinct: Vec<u32> = Vec::with_capacity(corners.len());
        for &c in corners {
            if distinct.last() != Some(&c) {
                distinct.push(c);
            }
        }
        while distinct.len() > 1 && distinct.first() == distinct.last() {
            distinct.pop();
        }
        for k in 2..distinct.len() {
            self.triangles
                .push([distinct[0], distinct[k - 1], distinct[k]]);
        }
    }
}
