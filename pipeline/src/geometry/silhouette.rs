//! Facing and silhouette edges, also for meshes that are not closed.
//!
//! Facing is decided **once per triangle** and everything else is combinatorial:
//! an edge is on the silhouette because of the facing of the triangles that use
//! it, never because of an expression of its own. Whatever the rounding, every
//! vertex then has as many silhouette edges arriving as leaving, so the shadow
//! volume is closed (docs/papers.md, paper V).
//!
//! # The generalised silhouette
//!
//! Give each triangle an orientation `o` in {-1, 0, +1} and look at the
//! 2-chain `sum o(t) t`. Its boundary assigns to every undirected edge an
//! integer multiplicity: how often the oriented triangles walk it upwards minus
//! how often downwards. Extruding that boundary, `|k|` quads per edge, closes
//! the volume, because the boundary of a boundary is zero; and the volume is
//! the sum of the volumes of the single triangles (Bergeron 1986; Kim, Kim and
//! Turk, "A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold
//! Casters", JGT 2008).
//!
//! * Closed casters take `o = 1` for light-facing triangles and 0 for others
//!   ([`Orientation::closed`]): each surface layer pair counts once.
//! * Other casters take `o = 1` for light-facing and -1 for all others
//!   ([`Orientation::generalised`]): every triangle casts, each surface layer
//!   counts once, so a closed mesh would count twice.

use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

/// Whether each triangle faces the light: `n . (l - v0) > 0` in f64 from the
/// f32 positions, v0 the first corner, `n = (v1 - v0) x (v2 - v0)`.
///
/// Exactly zero (edge-on, or zero area) counts as *not* facing, as the peers
/// have it; any fixed choice gives a closed volume.
pub fn light_facing(mesh: &Mesh, light: HardLight) -> Vec<bool> {
    (0..mesh.triangles().len())
        .map(|t| {
            let [a, b, c] = mesh.corners(t);
            (b - a).cross(c - a).dot(light.towards_from(a)) > 0.0
        })
        .collect()
}

/// How often, and which way round, each triangle enters the chain whose
/// boundary is the silhouette: -1, 0 or +1 per triangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Orientation(Vec<i8>);

impl Orientation {
    /// For closed meshes: light-facing triangles only.
    pub fn closed(facing: &[bool]) -> Self {
        Self(facing.iter().map(|&f| i8::from(f)).collect())
    }

    /// For any mesh: every triangle, turned to face the light.
    pub fn generalised(facing: &[bool]) -> Self {
        Self(facing.iter().map(|&f| if f { 1 } else { -1 }).collect())
    }

    /// Orientation of each triangle.
    pub fn of_triangles(&self) -> &[i8] {
        &self.0
    }
}

/// Directed silhouette edges, an edge of multiplicity k listed `|k|` times,
/// directed as in the (re)oriented triangles that face the light.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Silhouette {
    /// `[from, to]` position indices. Order: all first edges of triangles in
    /// triangle order, then all second, then all third (the peers' order).
    pub edges: Vec<[u32; 2]>,
    /// Largest `|k|` of any edge; 1 for closed manifolds, 0 without edges.
    pub max_multiplicity: u32,
}

impl Silhouette {
    /// The boundary of the oriented triangles. `adjacency` and `orientation`
    /// must belong to `mesh`.
    pub fn new(mesh: &Mesh, adjacency: &EdgeAdjacency, orientation: &Orientation) -> Self {
        let mut left: Vec<i32> = adjacency
            .edges()
            .map(|edge| multiplicity(edge.uses, orientation))
            .collect();
        let max_multiplicity = left.iter().map(|k| k.unsigned_abs()).max().unwrap_or(0);
        let mut edges = Vec::new();
        for corner in 0..3 {
            for (t, triangle) in mesh.triangles().iter().enumerate() {
                let ends = [triangle[corner], triangle[(corner + 1) % 3]];
                let k = &mut left[adjacency.edge_of(t, corner)];
                edges.extend(take_one(ends, orientation.0[t], k));
            }
        }
        Self {
            edges,
            max_multiplicity,
        }
    }
}

/// Upward minus downward walks along an edge by the oriented triangles.
fn multiplicity(uses: &[crate::world::adjacency::EdgeUse], orientation: &Orientation) -> i32 {
    uses.iter()
        .map(|u| {
            let walk = if u.ascending { 1 } else { -1 };
            walk * i32::from(orientation.0[u.triangle as usize])
        })
        .sum()
}

/// The edge as the oriented triangle walks it, if the edge's remaining
/// multiplicity `left` still asks for one in that direction. Enough triangles
/// walk in the majority direction, so `left` reaches zero.
fn take_one([from, to]: [u32; 2], orientation: i8, left: &mut i32) -> Option<[u32; 2]> {
    let upwards = (from < to) == (orientation > 0);
    let wanted = if upwards { *left > 0 } else { *left < 0 };
    if orientation == 0 || from == to || !wanted {
        return None;
    }
    *left -= if upwards { 1 } else { -1 };
    Some(if orientation > 0 {
        [from, to]
    } else {
        [to, from]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::shape;
    use glam::DVec3;
    use proptest::prelude::*;

    /// Outgoing minus incoming silhouette edges, and degree, per vertex.
    fn degrees(silhouette: &Silhouette, vertices: usize) -> Vec<(i32, u32)> {
        let mut out = vec![(0, 0); vertices];
        for &[from, to] in &silhouette.edges {
            out[from as usize].0 += 1;
            out[to as usize].0 -= 1;
            out[from as usize].1 += 1;
            out[to as usize].1 += 1;
        }
        out
    }

    fn silhouette(mesh: &Mesh, orientation: &Orientation) -> Silhouette {
        Silhouette::new(mesh, &EdgeAdjacency::new(mesh.triangles()), orientation)
    }

    fn soup(triangles: Vec<[u32; 3]>, positions: Vec<[f32; 3]>) -> Mesh {
        Mesh::new(positions, triangles, Shading::Flat).unwrap()
    }

    proptest! {
        /// Whatever the facing (even random, as bad rounding would make it), as
        /// many silhouette edges arrive at each vertex as leave it.
        #[test]
        fn any_facing_gives_balanced_vertices(
            triangles in prop::collection::vec(prop::array::uniform3(0u32..8), 0..24),
            facing in prop::collection::vec(any::<bool>(), 24),
        ) {
            let mesh = soup(triangles, vec![[0.0; 3]; 8]);
            let facing = &facing[..mesh.triangles().len()];
            for orientation in [Orientation::closed(facing), Orientation::generalised(facing)] {
                let s = silhouette(&mesh, &orientation);
                prop_assert!(degrees(&s, 8).iter().all(|&(balance, _)| balance == 0));
            }
        }

        /// On a closed mesh the silhouette is the naive one: an edge of a facing
        /// triangle whose other triangle does not face; degrees are even.
        #[test]
        fn closed_silhouette_equals_the_naive_one(
            light in prop::array::uniform3(-4.0f64..4.0),
        ) {
            let mesh = shape::icosphere(1, 1.0, DVec3::ZERO).into_mesh(Shading::Flat).unwrap();
            let facing = light_facing(&mesh, HardLight::Point(DVec3::from(light)));
            let mut ours = silhouette(&mesh, &Orientation::closed(&facing)).edges;
            let mut naive = Vec::new();
            for (t, a) in mesh.triangles().iter().enumerate() {
                for (u, b) in mesh.triangles().iter().enumerate() {
                    for k in 0..3 {
                        let e = [a[k], a[(k + 1) % 3]];
                        let meets = (0..3).any(|j| [b[(j + 1) % 3], b[j]] == e);
                        if meets && facing[t] && !facing[u] {
                            naive.push(e);
                        }
                    }
                }
            }
            ours.sort_unstable();
            naive.sort_unstable();
            prop_assert_eq!(ours, naive);
        }
    }

    /// What per-edge facing does: each edge asks its triangles again, starting
    /// from its own end and in f32, and takes the first answer that suits it.
    fn per_edge_silhouette(mesh: &Mesh, light: [f32; 3]) -> Silhouette {
        let faces = |t: usize, corner: usize| {
            let triangle = mesh.triangles()[t];
            let at = |k: usize| mesh.positions()[triangle[(corner + k) % 3] as usize];
            let minus = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let (u, v, l) = (
                minus(at(1), at(0)),
                minus(at(2), at(0)),
                minus(light, at(0)),
            );
            let n = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            n[0] * l[0] + n[1] * l[1] + n[2] * l[2] > 0.0
        };
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let differing = adjacency.edges().filter(|e| {
            let [a, b] =
                [e.uses[0], e.uses[1]].map(|u| (u.triangle as usize, usize::from(u.corner)));
            faces(a.0, a.1) != faces(b.0, b.1)
        });
        Silhouette {
            edges: differing.map(|e| [e.low, e.high]).collect(),
            max_multiplicity: 1,
        }
    }

    /// A light in the planes of many triangles at once makes the answers of one
    /// triangle differ from edge to edge: odd vertices, a torn volume.
    #[test]
    fn negative_control_per_edge_facing_tears() {
        let mesh = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 64, 12, DVec3::ZERO);
        let mesh = mesh.into_mesh(Shading::Flat).unwrap();
        let odd_vertices = |s: &Silhouette| {
            let degrees = degrees(s, mesh.positions().len());
            degrees.iter().filter(|(_, degree)| degree % 2 == 1).count()
        };
        let mut torn = 0;
        for t in 0..mesh.triangles().len() {
            let [a, b, c] = mesh.corners(t);
            let light = crate::world::mesh::narrow(a * 7.0 - b * 2.5 - c * 3.5); // in its plane
            torn += odd_vertices(&per_edge_silhouette(&mesh, light));
            let facing = light_facing(&mesh, HardLight::Point(crate::world::mesh::widen(light)));
            assert_eq!(
                odd_vertices(&silhouette(&mesh, &Orientation::closed(&facing))),
                0
            );
        }
        assert!(
            torn > 0,
            "per-edge facing never tore; the control is useless"
        );
    }

    /// A closed body: a cone of triangles round an apex whose rim goes up and down
    /// `folds` times, and a point far below.
    fn folded_cone(folds: u32) -> Mesh {
        let rim = 2 * folds;
        let mut positions = vec![[0.0; 3], [0.0, -20.0, 0.0]];
        for k in 0..rim {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(rim);
            let y = if k % 2 == 0 { 4.0 } else { -4.0 };
            positions.push([libm::cos(angle) as f32, y, libm::sin(angle) as f32]);
        }
        let triangles = (0..rim).flat_map(|k| {
            let (a, b) = (2 + k, 2 + (k + 1) % rim);
            [[0, b, a], [1, a, b]]
        });
        soup(triangles.collect(), positions)
    }

    /// A light aside sees each fold's two faces from different sides: a vertex of
    /// each even degree, on closed bodies, with facing from the light.
    #[test]
    fn vertices_of_degree_two_to_eight_exist() {
        let mut seen = std::collections::BTreeSet::new();
        for folds in 2..=5 {
            let mesh = folded_cone(folds);
            let adjacency = EdgeAdjacency::new(mesh.triangles());
            assert!(adjacency.closedness(&mesh).is_closed());
            for light in [DVec3::new(60.0, 1.0, 0.3), DVec3::new(40.0, 30.0, 9.0)] {
                let facing = light_facing(&mesh, HardLight::Point(light));
                let s = silhouette(&mesh, &Orientation::closed(&facing));
                let degrees = degrees(&s, mesh.positions().len());
                assert!(
                    degrees
                        .iter()
                        .all(|(balance, d)| *balance == 0 && d % 2 == 0)
                );
                seen.insert(degrees[0].1);
            }
        }
        for degree in [2, 4, 6, 8] {
            assert!(seen.contains(&degree), "{degree} is not among {seen:?}");
        }
    }

    #[test]
    fn edge_on_triangles_do_not_face() {
        let flat = soup(
            vec![[0, 1, 2]],
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        );
        let facing = |light| light_facing(&flat, light)[0];
        assert!(facing(HardLight::Directional(DVec3::Z)));
        assert!(!facing(HardLight::Directional(DVec3::X)));
        assert!(!facing(HardLight::Point(DVec3::new(5.0, 5.0, 0.0))));
    }

    #[test]
    fn three_fins_on_one_edge_give_multiplicity_three() {
        let positions = vec![
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.2, 0.0],
            [1.0, 0.4, 0.0],
        ];
        let mesh = soup(vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]], positions);
        let facing = light_facing(&mesh, HardLight::Directional(DVec3::Y));
        let s = silhouette(&mesh, &Orientation::generalised(&facing));
        assert_eq!(s.max_multiplicity, 3);
        assert_eq!(s.edges.iter().filter(|e| **e == [0, 1]).count(), 3);
    }
}
