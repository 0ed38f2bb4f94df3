//! Meshes whose edges are cut, each in the same places for both of its triangles.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::world::error::MeshError;
use crate::world::mesh::{Mesh, Shading, narrow};

/// Each edge is cut once, at `share` of it from its end with the lower index; each triangle
/// becomes four.
pub(super) fn cut(mesh: &Mesh, share: f64) -> Result<Mesh, MeshError> {
    let mut cutter = Cutter::new(mesh, share);
    let mut triangles = Vec::with_capacity(4 * mesh.triangles().len());
    for &[a, b, c] in mesh.triangles() {
        let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|e| cutter.point(e));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Mesh::new(cutter.positions, triangles, Shading::Flat)
}

/// Edges in halves, so often; `None` where that is more than `most` triangles.
pub(super) fn halved(mesh: &Mesh, times: u32, most: usize) -> Option<Result<Mesh, MeshError>> {
    let triangles = mesh.triangles().len().checked_shl(2 * times)?;
    (triangles <= most).then(|| {
        let mut halved = mesh.clone();
        for _ in 0..times {
            halved = cut(&halved, 0.5)?;
        }
        Ok(halved)
    })
}

struct Cutter<'a> {
    mesh: &'a Mesh,
    share: f64,
    positions: Vec<[f32; 3]>,
    /// Points by edge, its lower index first.
    points: BTreeMap<[u32; 2], u32>,
}

impl<'a> Cutter<'a> {
    fn new(mesh: &'a Mesh, share: f64) -> Self {
        Self {
            mesh,
            share,
            positions: mesh.positions().to_vec(),
            points: BTreeMap::new(),
        }
    }

    /// The point on an edge, whichever way round it is given.
    fn point(&mut self, [a, b]: [u32; 2]) -> u32 {
        let edge = [a.min(b), a.max(b)];
        let next = self.positions.len() as u32;
        let point = *self.points.entry(edge).or_insert(next);
        if point == next {
            let [from, to]: [DVec3; 2] = edge.map(|i| self.mesh.position(i));
            self.positions.push(narrow(from + (to - from) * self.share));
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::scene::builtin;

    #[test]
    fn bodies_stay_closed_and_keep_their_volume() {
        let mesh = &builtin::build("cylinder").unwrap().objects[1].mesh;
        for share in [0.5, 0.1, 1e-4, 1e-9] {
            let cut = cut(mesh, share).unwrap();
            assert_eq!(cut.triangles().len(), 4 * mesh.triangles().len());
            assert!(
                EdgeAdjacency::new(cut.triangles())
                    .closedness(&cut)
                    .is_closed(),
                "{share}"
            );
            let ratio = cut.signed_volume() / mesh.signed_volume();
            assert!((ratio - 1.0).abs() < 1e-6, "{share}: {ratio}");
        }
    }

    #[test]
    fn pieces_double_and_end_where_there_are_too_many() {
        let mesh = &builtin::build("parallel-plates").unwrap().objects[1].mesh;
        let count = mesh.triangles().len();
        let halved_twice = halved(mesh, 2, usize::MAX).unwrap().unwrap();
        assert_eq!(halved_twice.triangles().len(), 16 * count);
        assert!(halved(mesh, 2, 16 * count - 1).is_none());
        assert_eq!(halved(mesh, 0, count).unwrap().as_ref(), Ok(&**mesh));
    }
}
