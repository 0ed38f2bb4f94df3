//! Silhouettes walked into simple closed loops.
//!
//! A silhouette has as many edges arriving at a vertex as leaving it, so its
//! degree is even (Akenine-Möller and Assarsson, "On Shadow Volume
//! Silhouettes", paper V) and its edges fall apart into closed loops that share
//! no edge. An edge of multiplicity k is k edges, and so takes part in k loops
//! or k times in turn.
//!
//! # The rule of pairing
//!
//! Vertices of degree 4 and more leave a choice. The walk starts at the first
//! unused edge of the silhouette's order and leaves each vertex by the first
//! unused edge in that order. As soon as it meets a vertex that is already on
//! the walk, the part since then is cut off as a loop. So loops are *simple* (no
//! vertex twice), and depend on the order of the edges alone: not on positions,
//! rounding or threads.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::geometry::silhouette::Silhouette;

/// Edges that do not make closed loops.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "vertex {vertex} has {arriving} silhouette edges arriving and {leaving} leaving; \
     closed loops need as many of one as of the other"
)]
pub struct UnbalancedVertex {
    /// Index of the position, the lowest that is unbalanced.
    pub vertex: u32,
    /// Edges that end there.
    pub arriving: usize,
    /// Edges that start there.
    pub leaving: usize,
}

/// A silhouette split into simple closed loops.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SilhouetteLoops {
    /// Per loop, indices into [`Silhouette::edges`], head to tail: each edge ends
    /// where the next starts, the last where the first starts. Every edge of the
    /// silhouette is in exactly one loop, once.
    pub loops: Vec<Vec<u32>>,
    /// Number of vertices by degree (edges arriving plus leaving); all degrees
    /// are even, those above 2 are where the rule of pairing decides.
    pub vertices_of_degree: BTreeMap<usize, usize>,
}

impl SilhouetteLoops {
    /// Splits the silhouette by the rule of pairing. O(n log n).
    ///
    /// # Errors
    /// A vertex where the edges do not balance; the silhouettes that
    /// [`Silhouette::new`] makes always do.
    pub fn new(silhouette: &Silhouette) -> Result<Self, UnbalancedVertex> {
        let mut leaving = Leaving::new(&silhouette.edges);
        let vertices_of_degree = degrees(&silhouette.edges)?;
        let mut loops = Vec::new();
        for first in 0..silhouette.edges.len() as u32 {
            if !leaving.used[first as usize] {
                walk(&silhouette.edges, first, &mut leaving, &mut loops);
            }
        }
        Ok(Self {
            loops,
            vertices_of_degree,
        })
    }

    /// The positions' indices along each loop: the start of each of its edges.
    pub fn vertices<'a>(&'a self, silhouette: &'a Silhouette) -> impl Iterator<Item = Vec<u32>> {
        let start = |edge: &u32| silhouette.edges[*edge as usize][0];
        self.loops
            .iter()
            .map(move |edges| edges.iter().map(start).collect())
    }
}

fn degrees(edges: &[[u32; 2]]) -> Result<BTreeMap<usize, usize>, UnbalancedVertex> {
    let mut counts: BTreeMap<u32, [usize; 2]> = BTreeMap::new();
    for &[from, to] in edges {
        counts.entry(to).or_default()[0] += 1;
        counts.entry(from).or_default()[1] += 1;
    }
    let mut of_degree = BTreeMap::new();
    for (vertex, [arriving, leaving]) in counts {
        if arriving != leaving {
            return Err(UnbalancedVertex {
                vertex,
                arriving,
                leaving,
            });
        }
        *of_degree.entry(arriving + leaving).or_default() += 1;
    }
    Ok(of_degree)
}

/// Unused edges by the vertex that they leave, in the silhouette's order.
struct Leaving {
    /// Edge indices sorted by start vertex, then index.
    sorted: Vec<u32>,
    /// Next candidate in `sorted` and its end, per start vertex.
    range_of: BTreeMap<u32, (usize, usize)>,
    used: Vec<bool>,
}

impl Leaving {
    fn new(edges: &[[u32; 2]]) -> Self {
        let mut sorted: Vec<u32> = (0..edges.len() as u32).collect();
        sorted.sort_by_key(|&e| (edges[e as usize][0], e));
        let mut range_of: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
        for (at, &edge) in sorted.iter().enumerate() {
            let range = range_of
                .entry(edges[edge as usize][0])
                .or_insert((at, at + 1));
            range.1 = at + 1;
        }
        Self {
            sorted,
            range_of,
            used: vec![false; edges.len()],
        }
    }

    /// Uses up the first unused edge that leaves `vertex`.
    fn take(&mut self, vertex: u32) -> Option<u32> {
        let (next, end) = self.range_of.get_mut(&vertex)?;
        while *next < *end {
            let edge = self.sorted[*next];
            *next += 1;
            if !std::mem::replace(&mut self.used[edge as usize], true) {
                return Some(edge);
            }
        }
        None
    }
}

/// Walks from `first` until nothing is left to leave by, cutting off a loop
/// whenever a vertex is met again. Balance makes the walk end where it began.
fn walk(edges: &[[u32; 2]], first: u32, leaving: &mut Leaving, loops: &mut Vec<Vec<u32>>) {
    let mut path: Vec<u32> = Vec::new();
    // Place in `path` of the edge that leaves a vertex on the walk.
    let mut place_of: BTreeMap<u32, usize> = BTreeMap::new();
    let mut at = edges[first as usize][0];
    while let Some(edge) = leaving.take(at) {
        place_of.insert(at, path.len());
        path.push(edge);
        at = edges[edge as usize][1];
        if let Some(&start) = place_of.get(&at) {
            let cut = path.split_off(start);
            for e in &cut {
                place_of.remove(&edges[*e as usize][0]);
            }
            loops.push(cut);
        }
    }
    debug_assert!(path.is_empty(), "balanced walks end where they began");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::silhouette::{Orientation, light_facing};
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::light::HardLight;
    use crate::world::mesh::{Mesh, Shading};
    use crate::world::shape;
    use glam::DVec3;
    use proptest::prelude::*;

    fn of(edges: Vec<[u32; 2]>) -> Silhouette {
        Silhouette {
            edges,
            max_multiplicity: 1,
        }
    }

    /// Loops are closed, simple, and use every edge once.
    fn check(silhouette: &Silhouette) -> SilhouetteLoops {
        let split = SilhouetteLoops::new(silhouette).unwrap();
        let mut seen: Vec<u32> = split.loops.concat();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..silhouette.edges.len() as u32));
        for edges in &split.loops {
            for (k, &e) in edges.iter().enumerate() {
                let next = edges[(k + 1) % edges.len()];
                assert_eq!(
                    silhouette.edges[e as usize][1],
                    silhouette.edges[next as usize][0]
                );
            }
        }
        for mut vertices in split.vertices(silhouette) {
            let count = vertices.len();
            vertices.sort_unstable();
            vertices.dedup();
            assert_eq!(vertices.len(), count, "a vertex twice in one loop");
        }
        split
    }

    proptest! {
        /// Any facing of any triangles, non-manifold and degenerate ones too.
        #[test]
        fn any_silhouette_falls_apart_into_simple_loops(
            triangles in prop::collection::vec(prop::array::uniform3(0u32..8), 0..40),
            facing in prop::collection::vec(any::<bool>(), 40),
        ) {
            let mesh = Mesh::new(vec![[0.0; 3]; 8], triangles, Shading::Flat).unwrap();
            let facing = &facing[..mesh.triangles().len()];
            let adjacency = EdgeAdjacency::new(mesh.triangles());
            for orientation in [Orientation::closed(facing), Orientation::generalised(facing)] {
                check(&Silhouette::new(&mesh, &adjacency, &orientation));
            }
        }
    }

    #[test]
    fn a_vertex_of_degree_2n_joins_n_loops() {
        for n in 1..=4u32 {
            // n triangles that share vertex 0.
            let edges = (0..n).flat_map(|k| {
                let (a, b) = (2 * k + 1, 2 * k + 2);
                [[0, a], [a, b], [b, 0]]
            });
            let split = check(&of(edges.collect()));
            assert_eq!(split.loops.len(), n as usize);
            assert_eq!(
                split.vertices_of_degree[&(2 * n as usize)],
                if n == 1 { 3 } else { 1 }
            );
        }
    }

    #[test]
    fn two_loops_through_two_shared_vertices_stay_simple() {
        // 0-1-2-3 and 0-4-2-5 cross at 0 and 2; the first edge leaving wins.
        let s = of(vec![
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [0, 4],
            [4, 2],
            [2, 5],
            [5, 0],
        ]);
        let split = check(&s);
        assert_eq!(split.loops, [vec![0, 1, 2, 3], vec![4, 5, 6, 7]]);
        assert_eq!(split.vertices_of_degree, BTreeMap::from([(2, 4), (4, 2)]));
        // The same edges in another order pair differently, and are still loops.
        let mut other = s.clone();
        other.edges.rotate_left(3);
        check(&other);
    }

    #[test]
    fn repeated_edges_are_edges_of_their_own() {
        let s = of([[0, 1], [1, 2], [2, 0]].repeat(3));
        assert_eq!(check(&s).loops.len(), 3);
        assert_eq!(check(&s).vertices_of_degree, BTreeMap::from([(6, 3)]));
        let back_and_forth = of(vec![[0, 1], [1, 0]]);
        assert_eq!(check(&back_and_forth).loops, [vec![0, 1]]);
    }

    #[test]
    fn fins_on_one_edge_use_it_three_times() {
        let positions = vec![
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.2, 0.0],
            [1.0, 0.4, 0.0],
        ];
        let mesh = Mesh::new(
            positions,
            vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]],
            Shading::Flat,
        );
        let mesh = mesh.unwrap();
        let facing = light_facing(&mesh, HardLight::Directional(DVec3::Y));
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let s = Silhouette::new(&mesh, &adjacency, &Orientation::generalised(&facing));
        assert_eq!(check(&s).loops.len(), 3);
    }

    /// A real model: a knot seen across has vertices of degree 4.
    #[test]
    fn a_torus_knot_has_vertices_of_degree_four() {
        let mesh = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 64, 12, DVec3::ZERO);
        let mesh = mesh.into_mesh(Shading::Flat).unwrap();
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let mut most = 0;
        for k in 0..40 {
            let light = DVec3::new(0.1 * f64::from(k) - 2.0, 3.0, 0.37);
            let facing = light_facing(&mesh, HardLight::Point(light));
            let s = Silhouette::new(&mesh, &adjacency, &Orientation::closed(&facing));
            let split = check(&s);
            most = most.max(*split.vertices_of_degree.keys().last().unwrap());
        }
        assert!(most >= 4, "no vertex of degree 4 in 40 views");
    }

    #[test]
    fn edges_that_do_not_balance_are_named() {
        let error = SilhouetteLoops::new(&of(vec![[0, 1], [1, 2]])).unwrap_err();
        assert_eq!((error.vertex, error.arriving, error.leaving), (0, 0, 1));
        assert!(error.to_string().contains("vertex 0"));
        assert_eq!(SilhouetteLoops::new(&of(vec![])).unwrap().loops.len(), 0);
    }
}
