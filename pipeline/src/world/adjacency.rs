//! Which triangles share which edges, and whether a mesh is closed.
//!
//! Built by sorting, never by hashing, so that every listing has one order.

use std::fmt;

use crate::world::mesh::Mesh;

/// One use of an undirected edge by a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse {
    /// The triangle.
    pub triangle: u32,
    /// Which of its edges: `k` runs from corner `k` to corner `k + 1 mod 3`.
    pub corner: u8,
    /// Whether the triangle walks it from the lower to the higher vertex index.
    pub ascending: bool,
}

/// An undirected edge with all its uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge<'a> {
    /// Lower vertex index.
    pub low: u32,
    /// Higher vertex index (equal to `low` in a degenerate triangle).
    pub high: u32,
    /// Uses, sorted by triangle, then corner.
    pub uses: &'a [EdgeUse],
}

impl Edge<'_> {
    /// How often triangles walk it upwards and downwards.
    pub fn walks(&self) -> (usize, usize) {
        let up = self.uses.iter().filter(|u| u.ascending).count();
        (up, self.uses.len() - up)
    }

    /// Whether as many triangles walk it upwards as downwards, so that none of them
    /// ends there: two in the inside of a surface, four and more where solids touch.
    pub fn is_balanced(&self) -> bool {
        let (up, down) = self.walks();
        up == down
    }
}

/// All edges of a triangle list, sorted by vertex indices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeAdjacency {
    ends: Vec<[u32; 2]>,
    /// `uses[first_use[e]..first_use[e + 1]]` are the uses of edge `e`.
    first_use: Vec<u32>,
    uses: Vec<EdgeUse>,
    edge_of_corner: Vec<[u32; 3]>,
}

impl EdgeAdjacency {
    /// Sorts the `3 n` edge uses of `n` triangles: O(n log n).
    pub fn new(triangles: &[[u32; 3]]) -> Self {
        let mut keyed = keyed_uses(triangles);
        keyed.sort_unstable();
        let mut out = Self {
            edge_of_corner: vec![[0; 3]; triangles.len()],
            ..Self::default()
        };
        for (ends, edge_use) in keyed {
            if out.ends.last() != Some(&ends) {
                out.ends.push(ends);
                out.first_use.push(out.uses.len() as u32);
            }
            let edge = (out.ends.len() - 1) as u32;
            out.edge_of_corner[edge_use.triangle as usize][usize::from(edge_use.corner)] = edge;
            out.uses.push(edge_use);
        }
        out.first_use.push(out.uses.len() as u32);
        out
    }

    /// Number of undirected edges.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no edge at all.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Edge `index`, in the order of vertex indices.
    pub fn edge(&self, index: usize) -> Edge<'_> {
        let [low, high] = self.ends[index];
        let uses = self.first_use[index] as usize..self.first_use[index + 1] as usize;
        Edge {
            low,
            high,
            uses: &self.uses[uses],
        }
    }

    /// All edges, in the order of vertex indices.
    pub fn edges(&self) -> impl Iterator<Item = Edge<'_>> {
        (0..self.len()).map(|e| self.edge(e))
    }

    /// Index of the edge from corner `corner` of `triangle` to the next corner.
    pub fn edge_of(&self, triangle: usize, corner: usize) -> usize {
        self.edge_of_corner[triangle][corner] as usize
    }

    /// Counts and names what keeps the mesh from being a closed manifold.
    /// `mesh` must be the one this adjacency was built from.
    pub fn closedness(&self, mesh: &Mesh) -> ClosednessReport {
        let mut report = ClosednessReport::default();
        self.edges().for_each(|e| report.count_edge(&e));
        count_triangles(mesh, &mut report);
        report
    }
}

fn keyed_uses(triangles: &[[u32; 3]]) -> Vec<([u32; 2], EdgeUse)> {
    let mut keyed = Vec::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let edge_use = EdgeUse {
                triangle: t as u32,
                corner: k as u8,
                ascending: from <= to,
            };
            keyed.push(([from.min(to), from.max(to)], edge_use));
        }
    }
    keyed
}

/// An edge that breaks closedness, named by its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OffendingEdge {
    /// Vertex indices, lower first.
    pub vertices: [u32; 2],
    /// How many triangles use it.
    pub uses: usize,
}

impl fmt::Display for OffendingEdge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.vertices;
        write!(f, "{a}-{b} (used {}x)", self.uses)
    }
}

/// What keeps a mesh from being a closed manifold. Counts are of undirected
/// edges or of triangles; the first offender of each kind of edge is named.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ClosednessReport {
    /// Edges used by one triangle only.
    pub boundary: usize,
    /// Edges used by more than two triangles, more of them one way than the other.
    pub over_shared: usize,
    /// Edges used by four and more triangles, as many one way as the other: where
    /// solids touch. Harmless for closedness.
    pub shared_evenly: usize,
    /// Edges whose two triangles walk them in the same direction.
    pub flipped: usize,
    /// Triangles that name a vertex twice.
    pub degenerate_triangles: usize,
    /// Triangles with the same three vertices as an earlier one (any order).
    pub duplicate_triangles: usize,
    /// Triangles with three different vertices and an area of exactly zero.
    /// Harmless for closedness; reported because they have no normal.
    pub zero_area_triangles: usize,
    /// First boundary edge.
    pub first_boundary: Option<OffendingEdge>,
    /// First over-shared edge.
    pub first_over_shared: Option<OffendingEdge>,
    /// First flipped edge.
    pub first_flipped: Option<OffendingEdge>,
}

impl ClosednessReport {
    /// Whether every edge is walked as often one way as the other and no triangle is
    /// degenerate: what a shadow volume needs. The triangles then have no boundary,
    /// and a ray from outside to outside meets as many front faces as back faces.
    pub fn is_closed(&self) -> bool {
        self.boundary + self.over_shared + self.flipped + self.degenerate_triangles == 0
    }

    /// The first offending edge: boundary before over-shared before flipped.
    pub fn first_offender(&self) -> Option<OffendingEdge> {
        self.first_boundary
            .or(self.first_over_shared)
            .or(self.first_flipped)
    }

    fn count_edge(&mut self, edge: &Edge<'_>) {
        let (count, first) = match edge.uses.len() {
            1 => (&mut self.boundary, &mut self.first_boundary),
            2 if edge.is_balanced() => return,
            2 => (&mut self.flipped, &mut self.first_flipped),
            _ if edge.is_balanced() => {
                self.shared_evenly += 1;
                return;
            }
            _ => (&mut self.over_shared, &mut self.first_over_shared),
        };
        *count += 1;
        first.get_or_insert(OffendingEdge {
            vertices: [edge.low, edge.high],
            uses: edge.uses.len(),
        });
    }
}

impl fmt::Display for ClosednessReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} boundary, {} over-shared, {} flipped edges, {} degenerate triangles",
            self.boundary, self.over_shared, self.flipped, self.degenerate_triangles
        )?;
        match self.first_offender() {
            Some(edge) => write!(f, "; first offending edge {edge}"),
            None => Ok(()),
        }
    }
}

fn count_triangles(mesh: &Mesh, report: &mut ClosednessReport) {
    let mut sorted: Vec<[u32; 3]> = mesh
        .triangles()
        .iter()
        .map(|t| sorted_corners(*t))
        .collect();
    for (t, corners) in sorted.iter().enumerate() {
        if corners[0] == corners[1] || corners[1] == corners[2] {
            report.degenerate_triangles += 1;
        } else if has_zero_area(mesh, t) {
            report.zero_area_triangles += 1;
        }
    }
    sorted.sort_unstable();
    report.duplicate_triangles = sorted.windows(2).filter(|w| w[0] == w[1]).count();
}

fn sorted_corners(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

fn has_zero_area(mesh: &Mesh, triangle: usize) -> bool {
    let [a, b, c] = mesh.corners(triangle);
    (b - a).cross(c - a) == glam::DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::shape;
    use proptest::prelude::*;

    fn report(triangles: &[[u32; 3]]) -> ClosednessReport {
        let vertices = triangles.iter().flatten().max().map_or(0, |m| m + 1);
        let positions = (0..vertices)
            .map(|i| [i as f32, (i * i % 7) as f32, (i * i * i % 11) as f32])
            .collect();
        let mesh = Mesh::new(positions, triangles.to_vec(), Shading::Smooth).unwrap();
        EdgeAdjacency::new(triangles).closedness(&mesh)
    }

    /// The obvious twin: for each pair of vertices, look at every triangle.
    fn naive(triangles: &[[u32; 3]]) -> [usize; 3] {
        let mut counts = [0; 3];
        for low in 0..8 {
            for high in low..8 {
                let walks = |from: u32, to: u32| {
                    let edges = triangles
                        .iter()
                        .flat_map(|t| (0..3).map(move |k| (t[k], t[(k + 1) % 3])));
                    edges.filter(|&e| e == (from, to)).count()
                };
                let (up, down) = (
                    walks(low, high),
                    if low == high { 0 } else { walks(high, low) },
                );
                match (up, down) {
                    (up, down) if up == down => {}
                    (1, 0) | (0, 1) => counts[0] += 1,
                    (2, 0) | (0, 2) => counts[2] += 1,
                    _ => counts[1] += 1,
                }
            }
        }
        counts
    }

    proptest! {
        #[test]
        fn report_agrees_with_the_naive_twin(
            triangles in prop::collection::vec(prop::array::uniform3(0u32..8), 0..24)
        ) {
            let r = report(&triangles);
            prop_assert_eq!([r.boundary, r.over_shared, r.flipped], naive(&triangles));
        }
    }

    #[test]
    fn builtin_solids_are_closed_and_an_open_cylinder_is_not() {
        let cylinder = shape::cylinder(32, 0.5, 0.0, 1.5);
        assert!(report(&cylinder.triangles).is_closed());

        // Drop the 32 triangles of the bottom disc.
        let mut open = cylinder.triangles.clone();
        open.drain(64..96);
        let r = report(&open);
        assert_eq!((r.boundary, r.over_shared, r.flipped), (32, 0, 0));
        assert!(!r.is_closed());
        assert_eq!(r.first_boundary.unwrap().vertices, [0, 1]);
    }

    #[test]
    fn each_defect_is_counted_as_its_kind() {
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert!(report(&tetrahedron).is_closed());

        let mut flipped = tetrahedron;
        flipped[0] = [0, 1, 2];
        assert_eq!(report(&flipped).flipped, 3);

        let mut fin = tetrahedron.to_vec();
        fin.push([0, 1, 4]);
        assert_eq!(report(&fin).over_shared, 1);

        let mut doubled = tetrahedron.to_vec();
        doubled.push([1, 0, 2]);
        assert_eq!(report(&doubled).duplicate_triangles, 1);

        // Two solids that share an edge, and one that is there twice.
        let mut touching = tetrahedron.to_vec();
        touching.extend(tetrahedron.map(|t| t.map(|i| [0, 1, 4, 5][i as usize])));
        let r = report(&touching);
        assert!(r.is_closed() && r.shared_evenly == 1, "{r}");
        let twice = [tetrahedron, tetrahedron].concat();
        let r = report(&twice);
        assert!(r.is_closed() && r.shared_evenly == 6, "{r}");

        let mut degenerate = tetrahedron.to_vec();
        degenerate.push([3, 3, 3]);
        assert_eq!(report(&degenerate).degenerate_triangles, 1);
        assert!(!report(&degenerate).is_closed());
    }
}
