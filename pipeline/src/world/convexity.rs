//! Whether a mesh can be in its own light, and the pieces that it is of.

use std::collections::BTreeMap;

use glam::DVec3;

use super::adjacency::{Edge, EdgeAdjacency};
use super::mesh::{Mesh, Shading};

/// How far vertices may be off a plane by rounding, as a share of the mesh's size.
const FLAT: f64 = 1e-6;

/// Whether no segment between two of its points leaves it: flat, or closed, of one piece and
/// without an edge that is bent inwards. Such a mesh hides no light from itself but where it is
/// turned away.
#[must_use]
pub fn is_convex(mesh: &Mesh) -> bool {
    let Some((low, high)) = mesh.bounds() else {
        return true;
    };
    let slack = (high - low).length() * FLAT;
    if is_flat(mesh, slack) {
        return true;
    }
    let edges = EdgeAdjacency::new(mesh.triangles());
    let outwards = mesh.signed_volume().signum();
    edges.closedness(mesh).is_closed()
        && pieces_by(mesh.triangles().len(), &edges)
            .iter()
            .all(|p| *p == 0)
        && edges.edges().all(|e| is_ridge(mesh, &e, outwards, slack))
}

fn normal_of(mesh: &Mesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(triangle);
    (b - a).cross(c - a).normalize_or_zero()
}

fn is_flat(mesh: &Mesh, slack: f64) -> bool {
    let mut normals = (0..mesh.triangles().len()).map(|t| normal_of(mesh, t));
    let Some(normal) = normals.find(|n| *n != DVec3::ZERO) else {
        return true;
    };
    let first = mesh.position(0);
    let mut others = (0..mesh.positions().len() as u32).map(|i| mesh.position(i) - first);
    others.all(|p| normal.dot(p).abs() <= slack)
}

/// The number of each triangle's piece: those that edges join are one.
#[must_use]
pub fn pieces(mesh: &Mesh) -> Vec<u32> {
    let triangles = mesh.triangles();
    pieces_by(triangles.len(), &EdgeAdjacency::new(triangles))
}

/// Each triangle is kept once and each edge walked once, however many share it.
fn pieces_by(triangles: usize, edges: &EdgeAdjacency) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut own = vec![NONE; triangles];
    let mut met = vec![false; edges.len()];
    let mut open = Vec::new();
    let mut count = 0;
    for first in 0..own.len() {
        if own[first] != NONE {
            continue;
        }
        own[first] = count;
        open.push(first);
        while let Some(t) = open.pop() {
            for edge in (0..3).map(|corner| edges.edge_of(t, corner)) {
                if std::mem::replace(&mut met[edge], true) {
                    continue;
                }
                for other in edges.edge(edge).uses.iter().map(|u| u.triangle as usize) {
                    if own[other] == NONE {
                        own[other] = count;
                        open.push(other);
                    }
                }
            }
        }
        count += 1;
    }
    own
}

/// The triangles of one piece, with the vertices that they use.
#[must_use]
pub fn piece(mesh: &Mesh, pieces: &[u32], number: u32) -> Option<Mesh> {
    let own = mesh.triangles().iter().zip(pieces);
    let own = own.filter(|(_, p)| **p == number).map(|(t, _)| *t);
    let mut places = BTreeMap::new();
    let mut positions = Vec::new();
    let mut place = |vertex: u32| {
        *places.entry(vertex).or_insert_with(|| {
            positions.push(mesh.positions()[vertex as usize]);
            positions.len() as u32 - 1
        })
    };
    let triangles = own.map(|t| t.map(&mut place)).collect();
    Mesh::new(positions, triangles, Shading::Flat).ok()
}

/// Whether each of an edge's two triangles lies behind the other's plane.
fn is_ridge(mesh: &Mesh, edge: &Edge<'_>, outwards: f64, slack: f64) -> bool {
    let [one, other] = edge.uses else {
        return false;
    };
    let normal = normal_of(mesh, one.triangle as usize) * outwards;
    let on = mesh.position(edge.low);
    let corners = mesh.corners(other.triangle as usize);
    corners.iter().all(|c| normal.dot(*c - on) <= slack)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::shape;

    fn mesh(shape: shape::Shape) -> Mesh {
        shape.into_mesh(Shading::Flat).unwrap()
    }

    /// Two boxes as one mesh.
    fn two(apart: f64) -> Mesh {
        let part = |x: f64| mesh(shape::cuboid(DVec3::X * x, DVec3::ONE));
        let (a, b) = (part(0.0), part(apart));
        let count = a.positions().len() as u32;
        let positions = [a.positions(), b.positions()].concat();
        let moved = b.triangles().iter().map(|t| t.map(|i| i + count));
        let triangles = a.triangles().iter().copied().chain(moved).collect();
        Mesh::new(positions, triangles, Shading::Flat).unwrap()
    }

    #[test]
    fn balls_boxes_and_plates_are_convex_and_pairs_are_not() {
        assert!(is_convex(&mesh(shape::icosphere(2, 1.0, DVec3::ONE))));
        assert!(is_convex(&mesh(shape::cuboid(DVec3::ZERO, DVec3::ONE))));
        assert!(is_convex(&mesh(shape::plane(4.0, 0.0))));
        let pair = two(3.0);
        assert!(!is_convex(&pair));
        let own = pieces(&pair);
        assert_eq!(own, [[0; 12], [1; 12]].concat());
        for number in [0, 1] {
            let one = piece(&pair, &own, number).unwrap();
            assert!(is_convex(&one) && one.positions().len() == 8);
            let (low, _) = one.bounds().unwrap();
            assert!(
                (low.x - (3.0 * f64::from(number) - 0.5)).abs() < 0.51,
                "{low}"
            );
        }
    }

    /// As many triangles as a file likes may be on one edge: the square of their number is
    /// neither kept nor walked.
    #[test]
    fn an_edge_of_many_triangles_joins_them_quickly() {
        let fan = (0..20_000).map(|k| [0, 1, 2 + k]);
        let alone = [[20_002, 20_003, 20_004]];
        let triangles: Vec<[u32; 3]> = fan.chain(alone).collect();
        let own = pieces_by(triangles.len(), &EdgeAdjacency::new(&triangles));
        assert!(own[..20_000].iter().all(|p| *p == 0));
        assert_eq!(own[20_000..], [1]);
    }

    /// A vertex of a ball that is pushed in, whichever way round its triangles are.
    #[test]
    fn dents_are_found() {
        let ball = mesh(shape::icosphere(2, 1.0, DVec3::ZERO));
        let mut positions = ball.positions().to_vec();
        positions[0] = positions[0].map(|c| c * 0.8);
        for turned in [false, true] {
            let turn = |[a, b, c]: &[u32; 3]| if turned { [*a, *c, *b] } else { [*a, *b, *c] };
            let triangles: Vec<_> = ball.triangles().iter().map(turn).collect();
            let of =
                |p: &[[f32; 3]]| Mesh::new(p.to_vec(), triangles.clone(), Shading::Flat).unwrap();
            assert!(is_convex(&of(ball.positions())));
            assert!(!is_convex(&of(&positions)));
        }
    }
}
