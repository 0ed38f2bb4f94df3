//! Triangles without area, and what they face.
//!
//! Exporters close T-vertices with triangles whose corners lie on one line, and
//! bevels of no width leave quads of no area. Such a triangle has no side that could
//! face a light. It takes after its neighbour across its longest edge, which spans the
//! other two: then no more silhouette runs along it than without it. Where that
//! neighbour has no area either, its own longest edge leads on.
//!
//! Any choice gives a closed shadow volume ([`crate::geometry::silhouette`]), and a triangle
//! without area hides nothing. The choice matters to whatever takes each silhouette
//! edge by itself: a loop round nothing has penumbra wedges all the same.

use glam::DVec3;

use crate::geometry::silhouette::light_facing;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

/// Which triangles take after a neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slivers {
    /// Those of exactly no area.
    WithoutArea,
    /// Also those whose height is a ten-thousandth of their longest edge, as
    /// rounded T-vertices leave them.
    Needles,
}

/// Height over longest edge of a needle.
const NEEDLE: f64 = 1e-4;
/// Slivers from one to the next, before one is taken as it is: those that make up a
/// thin solid are its surface.
const STEPS: usize = 8;

/// [`light_facing`], but for slivers, which face as their neighbours do. `adjacency`
/// must belong to `mesh`.
pub(crate) fn facing(
    mesh: &Mesh,
    adjacency: &EdgeAdjacency,
    light: HardLight,
    slivers: Slivers,
) -> Vec<bool> {
    let own = light_facing(mesh, light);
    let is_sliver = |t: usize| slivers.has(mesh.corners(t));
    let all: Vec<usize> = (0..own.len()).filter(|t| is_sliver(*t)).collect();
    let mut facing = own.clone();
    for t in all {
        if let Some(neighbour) = solid_neighbour(mesh, adjacency, t, &is_sliver) {
            facing[t] = own[neighbour];
        }
    }
    facing
}

impl Slivers {
    fn has(self, [a, b, c]: [DVec3; 3]) -> bool {
        let normal = (b - a).cross(c - a);
        match self {
            Self::WithoutArea => normal == DVec3::ZERO,
            Self::Needles => {
                let longest = [b - a, c - b, a - c].map(|e| e.length_squared());
                let longest = longest.into_iter().fold(0.0, f64::max);
                normal.length() <= NEEDLE * longest
            }
        }
    }
}

/// The first triangle with area on the way across longest edges.
fn solid_neighbour(
    mesh: &Mesh,
    adjacency: &EdgeAdjacency,
    sliver: usize,
    is_sliver: &dyn Fn(usize) -> bool,
) -> Option<usize> {
    let mut way = vec![sliver];
    while way.len() <= STEPS {
        let next = across_longest(mesh, adjacency, is_sliver, &way)?;
        if !is_sliver(next) {
            return Some(next);
        }
        way.push(next);
    }
    None
}

/// The neighbour of the last in `way`, and not in it, across its longest edge; of
/// edges about as long, as two of a sliver may be, that with area.
fn across_longest(
    mesh: &Mesh,
    adjacency: &EdgeAdjacency,
    is_sliver: &dyn Fn(usize) -> bool,
    way: &[usize],
) -> Option<usize> {
    const AS_LONG: f64 = 0.999;
    let triangle = *way.last()?;
    let corners = mesh.corners(triangle);
    let length = |k: usize| (corners[(k + 1) % 3] - corners[k]).length_squared();
    let mut edges = [0, 1, 2];
    edges.sort_by(|&i, &j| length(j).total_cmp(&length(i)));
    let across = |k: usize| {
        let uses = adjacency.edge(adjacency.edge_of(triangle, k)).uses;
        let mut others = uses.iter().map(|u| u.triangle as usize);
        others.find(|t| !way.contains(t))
    };
    let longest = length(edges[0]);
    let as_long = edges.iter().filter(|k| length(**k) >= AS_LONG * longest);
    let mut solid = as_long
        .filter_map(|k| across(*k))
        .filter(|t| !is_sliver(*t));
    let other = || edges.into_iter().find_map(across);
    solid.next().or_else(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::silhouette::{Orientation, Silhouette};
    use crate::world::mesh::Shading;
    use crate::world::scene::builtin;
    use crate::world::shape;
    use proptest::prelude::*;

    /// A box of which edge `edge` of its triangles is cut in two at `t` by a vertex
    /// that only one side has, `off` beside it, closed by a triangle.
    fn cut_box(edge: usize, t: f64, off: DVec3) -> Mesh {
        let mut solid = shape::cuboid(DVec3::new(0.1, 1.0, 0.2), DVec3::new(1.4, 0.5, 1.0));
        let (triangle, corner) = (edge / 3, edge % 3);
        let of = solid.triangles[triangle];
        let [a, b, c] = [0, 1, 2].map(|k| of[(corner + k) % 3]);
        let [p, q] = [a, b].map(|i| solid.positions[i as usize]);
        let m = solid.positions.len() as u32;
        solid.positions.push(p + (q - p) * t + off);
        solid.triangles[triangle] = [a, m, c];
        solid.triangles.extend([[m, b, c], [a, b, m]]);
        solid.into_mesh(Shading::Flat).unwrap()
    }

    /// Silhouette edges as vectors, summed by line: what is walked both ways is none.
    fn silhouette(mesh: &Mesh, slivers: Slivers, light: HardLight) -> Vec<[u32; 2]> {
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        assert!(adjacency.closedness(mesh).is_closed());
        let facing = facing(mesh, &adjacency, light, slivers);
        Silhouette::new(mesh, &adjacency, &Orientation::closed(&facing)).edges
    }

    fn length(mesh: &Mesh, edges: &[[u32; 2]]) -> f64 {
        let of = |e: &[u32; 2]| (mesh.position(e[0]) - mesh.position(e[1])).length();
        edges.iter().map(of).sum()
    }

    proptest! {
        /// Wherever a box has a T-vertex, its silhouette is as long as without it.
        #[test]
        fn t_vertices_lengthen_no_silhouette(
            edge in 0usize..36, t in 0.05f64..0.95,
            light in prop::array::uniform3(-6.0f64..6.0),
            off in prop::array::uniform3(-1e-6f64..1e-6),
        ) {
            let light = HardLight::Point(DVec3::from(light) + DVec3::new(0.1, 1.0, 0.2));
            let plain = shape::cuboid(DVec3::new(0.1, 1.0, 0.2), DVec3::new(1.4, 0.5, 1.0))
                .into_mesh(Shading::Flat).unwrap();
            let wanted = length(&plain, &silhouette(&plain, Slivers::WithoutArea, light));
            let cut = cut_box(edge, t, DVec3::from(off));
            let found = length(&cut, &silhouette(&cut, Slivers::Needles, light));
            // A needle may turn the two triangles next to it by a hair.
            prop_assume!((0..14).all(|k| {
                let [a, b, c] = cut.corners(k);
                let n = (b - a).cross(c - a).normalize_or_zero();
                n == DVec3::ZERO || n.dot(light.towards_from(a)).abs() > 1e-4
            }));
            prop_assert!((found - wanted).abs() < 1e-4, "{} instead of {}", found, wanted);
        }
    }

    #[test]
    fn exactly_flat_triangles_need_no_tolerance() {
        let light = HardLight::Point(DVec3::new(1.6, 4.2, 1.1));
        for edge in 0..36 {
            let cut = cut_box(edge, 0.5, DVec3::ZERO);
            let flat = (0..14).filter(|t| Slivers::WithoutArea.has(cut.corners(*t)));
            // Halves of edges along the axes are exact, those of diagonals not all.
            if flat.count() == 1 {
                let found = silhouette(&cut, Slivers::WithoutArea, light);
                let plain = cut_box(edge, 0.5, DVec3::Y * 0.2);
                assert!(found.len() <= silhouette(&plain, Slivers::WithoutArea, light).len() + 1);
                let loose = silhouette(&cut, Slivers::Needles, light);
                assert_eq!(length(&cut, &found), length(&cut, &loose));
            }
        }
    }

    /// Without the rule the silhouette runs round the sliver.
    #[test]
    fn negative_control_own_facing_walks_round_slivers() {
        let light = HardLight::Point(DVec3::new(1.6, 4.2, 1.1));
        let longer = (0..36).filter(|&edge| {
            let cut = cut_box(edge, 0.3, DVec3::ZERO);
            let adjacency = EdgeAdjacency::new(cut.triangles());
            let own = Orientation::closed(&light_facing(&cut, light));
            let own = Silhouette::new(&cut, &adjacency, &own).edges;
            length(&cut, &own) > length(&cut, &silhouette(&cut, Slivers::Needles, light)) + 0.1
        });
        assert!(longer.count() > 6);
    }

    /// Side by side, thin triangles are a surface of their own.
    #[test]
    fn thin_solids_keep_their_sides() {
        let rod = shape::cylinder(48, 0.0005, 0.0, 4.0).into_mesh(Shading::Flat);
        let rod = rod.unwrap();
        let adjacency = EdgeAdjacency::new(rod.triangles());
        let light = HardLight::Point(DVec3::new(5.0, 2.0, 1.0));
        let own = light_facing(&rod, light);
        assert_eq!(facing(&rod, &adjacency, light, Slivers::Needles), own);
        assert!(own.iter().any(|f| *f) && own.iter().any(|f| !*f));
    }

    #[test]
    fn built_in_scenes_have_no_slivers_that_turn() {
        for entry in builtin::SCENES {
            let scene = entry.build();
            for object in scene.casters() {
                let mesh = &object.mesh;
                let adjacency = EdgeAdjacency::new(mesh.triangles());
                for light in scene.lights.iter().map(|l| l.hard()) {
                    let own = light_facing(mesh, light);
                    let settled = facing(mesh, &adjacency, light, Slivers::Needles);
                    assert!(own == settled, "{}: {}", scene.name, object.name);
                }
            }
        }
    }
}
