//! A caster in pieces, one for each outline that it has against the light.
//!
//! Paper IV (§5.1) combines silhouette loops one by one. A loop round a hole of
//! the lit surface hides less than nothing on its own, so what is combined here is
//! an outline with its holes: the silhouette of one connected piece of the
//! surface that casts. Every silhouette edge belongs to one piece, with its
//! multiplicity, and each piece casts a closed volume whose cap is its own
//! surface, so that the pieces' hard counts add up to the caster's.

use crate::geometry::silhouette::Orientation;
use crate::world::adjacency::{Edge, EdgeAdjacency};
use crate::world::mesh::{Mesh, Shading};

/// The connected pieces of the triangles that `orientation` counts, as meshes of
/// their own.
pub(crate) fn pieces(
    mesh: &Mesh,
    adjacency: &EdgeAdjacency,
    orientation: &Orientation,
) -> Vec<Mesh> {
    let pieces = piece_triangles(mesh, adjacency, orientation).into_iter();
    pieces
        .filter_map(|triangles| compact(mesh, triangles))
        .collect()
}

/// The triangles of each connected piece of those that `orientation` counts, ordered
/// by their first triangle; triangles are connected across edges.
pub(crate) fn piece_triangles(
    mesh: &Mesh,
    adjacency: &EdgeAdjacency,
    orientation: &Orientation,
) -> Vec<Vec<[u32; 3]>> {
    let counted = |t: usize| orientation.of_triangles()[t] != 0;
    let mut roots = Roots::new(mesh.triangles().len());
    for edge in adjacency.edges() {
        if edge.uses.len() > 2 {
            across(&edge, orientation).for_each(|[a, b]| roots.unite(a, b));
        } else if let [a, b] = edge.uses
            && let [a, b] = [a.triangle as usize, b.triangle as usize]
            && counted(a)
            && counted(b)
        {
            roots.unite(a, b);
        }
    }
    let mut triangles_of = vec![Vec::new(); mesh.triangles().len()];
    for t in (0..mesh.triangles().len()).filter(|t| counted(*t)) {
        triangles_of[roots.of(t)].push(mesh.triangles()[t]);
    }
    triangles_of.retain(|t| !t.is_empty());
    triangles_of
}

/// Pairs of triangles that continue each other across an edge of many: one that
/// walks it up and one that walks it down, as they are counted. What has no partner
/// ends there; what walks the same way lies in front of or behind the other, and
/// hides as a piece of its own.
fn across(edge: &Edge<'_>, orientation: &Orientation) -> impl Iterator<Item = [usize; 2]> {
    let walking = |way: i8| {
        let uses = edge.uses.iter();
        uses.filter_map(move |u| {
            let walk = if u.ascending { 1 } else { -1 };
            let t = u.triangle as usize;
            (walk * orientation.of_triangles()[t] == way).then_some(t)
        })
    };
    walking(1).zip(walking(-1)).map(|(up, down)| [up, down])
}

/// The triangles with only the positions that they use.
pub(crate) fn compact(mesh: &Mesh, triangles: Vec<[u32; 3]>) -> Option<Mesh> {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let place = |i: u32| used.partition_point(|u| *u < i) as u32;
    let triangles = triangles.into_iter().map(|t| t.map(place)).collect();
    let positions = used.iter().map(|i| mesh.positions()[*i as usize]).collect();
    Mesh::new(positions, triangles, Shading::Flat).ok()
}

/// Sets of triangles, each named after its lowest.
struct Roots(Vec<u32>);

impl Roots {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn of(&mut self, t: usize) -> usize {
        let mut at = t;
        while self.0[at] as usize != at {
            let above = self.0[self.0[at] as usize];
            self.0[at] = above; // halves the way for the next
            at = above as usize;
        }
        at
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low as u32;
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::silhouette::{Silhouette, light_facing};
    use crate::geometry::silhouette_loops::SilhouetteLoops;
    use crate::world::light::HardLight;
    use crate::world::shape;

    /// Silhouette edges by their ends' positions, sorted.
    fn edges(mesh: &Mesh, silhouette: &Silhouette) -> Vec<[[u32; 3]; 2]> {
        let bits = |i: u32| mesh.positions()[i as usize].map(f32::to_bits);
        let mut edges: Vec<_> = silhouette.edges.iter().map(|e| e.map(bits)).collect();
        edges.sort_unstable();
        edges
    }

    /// The pieces' silhouettes are the mesh's, and each of its loops is in one.
    fn check(mesh: &Mesh, light: DVec3, closed: bool) -> usize {
        let light = HardLight::Point(light);
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let facing = light_facing(mesh, light);
        let orientation = if closed {
            Orientation::closed(&facing)
        } else {
            Orientation::generalised(&facing)
        };
        let whole = Silhouette::new(mesh, &adjacency, &orientation);
        let pieces = pieces(mesh, &adjacency, &orientation);
        let of_piece = |piece: &Mesh| {
            let adjacency = EdgeAdjacency::new(piece.triangles());
            let orientation = Orientation::generalised(&light_facing(piece, light));
            let silhouette = Silhouette::new(piece, &adjacency, &orientation);
            assert!(!SilhouetteLoops::new(&silhouette).unwrap().loops.is_empty());
            edges(piece, &silhouette)
        };
        let mut all: Vec<_> = pieces.iter().flat_map(of_piece).collect();
        all.sort_unstable();
        assert_eq!(all, edges(mesh, &whole));
        pieces.len()
    }

    #[test]
    fn pieces_share_out_the_silhouette() {
        let ball = |y: f64| shape::icosphere(1, 0.4, DVec3::Y * y);
        let (mut two, other) = (ball(0.0), ball(1.0));
        let first = two.positions.len() as u32;
        two.positions.extend(other.positions);
        let moved = other.triangles.iter().map(|t| t.map(|i| first + i));
        two.triangles.extend(moved);
        let two = two.into_mesh(Shading::Flat).unwrap();
        assert_eq!(check(&two, DVec3::new(0.1, 4.0, 0.2), true), 2);
        // Of a ring seen along its axis, one piece with a hole: two loops.
        let ring = shape::torus_knot(1, 0, 1.0, 0.0, 0.3, 48, 12, DVec3::ZERO);
        let ring = ring.into_mesh(Shading::Flat).unwrap();
        assert_eq!(check(&ring, DVec3::new(0.01, 5.0, 0.02), true), 1);
        let mut most = 0;
        let knot = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 64, 12, DVec3::ZERO);
        let knot = knot.into_mesh(Shading::Flat).unwrap();
        for k in 0..10 {
            let light = DVec3::new(0.1 * f64::from(k) - 2.0, 3.0, 0.37);
            most = most.max(check(&knot, light, true));
            assert_eq!(check(&knot, light, false), 1);
        }
        assert!(most > 1, "no view of the knot has several outlines");
    }
}
