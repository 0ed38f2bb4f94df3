//! Infinite shadow volumes with both caps.
//!
//! Vertex `i` is `(p, 1)`, vertex `n + i` is `(p - light, 0)`: the same point
//! pushed to infinity, the difference formed in f64 and rounded once. Vertex and
//! triangle order are those of `../shared/peers/`, so that a peer draws the same
//! volume. Front faces of the volume point out of the shadow.

use std::ops::Range;

use crate::geometry::silhouette::{Orientation, Silhouette};
use crate::geometry::slivers::{Slivers, facing};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::{Mesh, narrow};

/// The shadow volume of one caster for one point or directional light.
///
/// z-fail draws everything; z-pass draws [`ShadowVolume::sides`] only.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowVolume {
    positions: Vec<[f32; 4]>,
    triangles: Vec<[u32; 3]>,
    light_cap: Range<usize>,
    dark_cap: Range<usize>,
    sides: Range<usize>,
    /// Whether each silhouette edge has two side triangles; else it has one.
    quads: bool,
    max_multiplicity: u32,
}

impl ShadowVolume {
    /// Volume of a closed mesh that does not enclose the light: light-facing
    /// triangles, the others pushed to infinity, and one quad per silhouette
    /// edge. A point's winding number in it is the number of light-facing
    /// triangles between it and the light.
    ///
    /// For a light *inside* the mesh the caps no longer match (see
    /// [`crate::geometry::winding::mesh_winding`] to find out); use
    /// [`ShadowVolume::generalised`] then.
    pub fn of_closed(mesh: &Mesh, adjacency: &EdgeAdjacency, light: HardLight) -> Self {
        let facing = facing(mesh, adjacency, light, Slivers::WithoutArea);
        let orientation = Orientation::closed(&facing);
        let light_cap = select(mesh, &facing, true);
        // The far end may be closed by the non-facing triangles as well as by
        // the facing ones reversed: both have the silhouette as boundary.
        let dark_cap = select(mesh, &facing, false);
        Self::assemble(mesh, adjacency, light, &orientation, light_cap, dark_cap)
    }

    /// Volume of any mesh, open and non-manifold ones included: the sum of the
    /// closed volumes of its triangles, each turned to face the light. A
    /// point's winding number is the number of triangles between it and the
    /// light, whichever way they face.
    pub fn generalised(mesh: &Mesh, adjacency: &EdgeAdjacency, light: HardLight) -> Self {
        let facing = facing(mesh, adjacency, light, Slivers::WithoutArea);
        let orientation = Orientation::generalised(&facing);
        let light_cap = turned(mesh, &facing, true);
        let dark_cap = turned(mesh, &facing, false);
        Self::assemble(mesh, adjacency, light, &orientation, light_cap, dark_cap)
    }

    /// `near` and `far` are the caps on the mesh's own vertex indices.
    fn assemble(
        mesh: &Mesh,
        adjacency: &EdgeAdjacency,
        light: HardLight,
        orientation: &Orientation,
        near: Vec<[u32; 3]>,
        far: Vec<[u32; 3]>,
    ) -> Self {
        let n = mesh.positions().len() as u32;
        let silhouette = Silhouette::new(mesh, adjacency, orientation);
        let mut triangles = near;
        let light_cap = 0..triangles.len();
        // Parallel light has one point at infinity for all vertices: the far
        // cap and the second triangle of each side have no extent.
        if !light.is_directional() {
            triangles.extend(far.into_iter().map(|t| t.map(|i| i + n)));
        }
        let dark_cap = light_cap.end..triangles.len();
        for &[a, b] in &silhouette.edges {
            triangles.push([b, a, a + n]);
            if !light.is_directional() {
                triangles.push([b, a + n, b + n]);
            }
        }
        let sides = dark_cap.end..triangles.len();
        Self {
            positions: extruded_positions(mesh, light),
            triangles,
            light_cap,
            dark_cap,
            sides,
            quads: !light.is_directional(),
            max_multiplicity: silhouette.max_multiplicity,
        }
    }

    /// `2 n` homogeneous positions, world space: `(p, 1)`, then `(p - light, 0)`.
    pub fn positions(&self) -> &[[f32; 4]] {
        &self.positions
    }

    /// All triangles: light cap, dark cap, sides.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Triangles of the light cap: positions, order and winding of the caster's
    /// own triangles (reversed for those that a generalised volume turned).
    pub fn light_cap(&self) -> &[[u32; 3]] {
        &self.triangles[self.light_cap.clone()]
    }

    /// Triangles of the dark cap, at infinity; none for directional lights.
    pub fn dark_cap(&self) -> &[[u32; 3]] {
        &self.triangles[self.dark_cap.clone()]
    }

    /// Side triangles: two per silhouette edge (one for directional lights),
    /// repeated as often as the edge's multiplicity.
    pub fn sides(&self) -> &[[u32; 3]] {
        &self.triangles[self.sides.clone()]
    }

    /// Ranges of light cap, dark cap and sides in [`ShadowVolume::triangles`].
    pub fn ranges(&self) -> [Range<usize>; 3] {
        [
            self.light_cap.clone(),
            self.dark_cap.clone(),
            self.sides.clone(),
        ]
    }

    /// The silhouette edges by their ends, world space, the occluder on the left seen
    /// from the light; an edge of multiplicity k comes k times.
    pub fn silhouette(&self) -> impl Iterator<Item = [glam::DVec3; 2]> {
        let step = usize::from(self.quads) + 1;
        self.sides().iter().step_by(step).map(|&[b, a, _]| {
            [a, b].map(|i| {
                let [x, y, z, _] = self.positions[i as usize].map(f64::from);
                glam::DVec3::new(x, y, z)
            })
        })
    }

    /// Largest multiplicity of a silhouette edge; above 255 an 8-bit stencil
    /// must wrap to survive.
    pub fn max_multiplicity(&self) -> u32 {
        self.max_multiplicity
    }
}

/// The triangles that face, or do not.
pub(crate) fn select(mesh: &Mesh, facing: &[bool], wanted: bool) -> Vec<[u32; 3]> {
    let pairs = mesh.triangles().iter().zip(facing);
    pairs
        .filter(|(_, f)| **f == wanted)
        .map(|(t, _)| *t)
        .collect()
}

/// All triangles, each turned to face, or not to.
pub(crate) fn turned(mesh: &Mesh, facing: &[bool], wanted: bool) -> Vec<[u32; 3]> {
    let pairs = mesh.triangles().iter().zip(facing);
    let turned = pairs.map(|(t, &f)| if f == wanted { *t } else { reversed(*t) });
    turned.collect()
}

/// Keeps the first corner, which anchors a triangle's depth plane.
fn reversed([a, b, c]: [u32; 3]) -> [u32; 3] {
    [a, c, b]
}

fn extruded_positions(mesh: &Mesh, light: HardLight) -> Vec<[f32; 4]> {
    let near = mesh.positions().iter().map(|&[x, y, z]| [x, y, z, 1.0]);
    let far = (0..mesh.positions().len() as u32).map(|i| {
        let [x, y, z] = narrow(light.shadow_direction(mesh.position(i)));
        [x, y, z, 0.0]
    });
    near.chain(far).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::winding::volume_winding;
    use crate::world::mesh::Shading;
    use crate::world::shape;
    use glam::DVec3;
    use proptest::prelude::*;

    /// Whether the open segment from `p` to the light crosses the triangle, by
    /// plain signed volumes; `None` when too close to call.
    fn blocks(mesh: &Mesh, t: usize, p: DVec3, light: HardLight) -> Option<bool> {
        const TOO_CLOSE: f64 = 1e-5; // directions at infinity are rounded to f32
        let d = light.towards_from(p);
        let [a, b, c] = mesh.corners(t).map(|v| v - p);
        let sides = [d.dot(a.cross(b)), d.dot(b.cross(c)), d.dot(c.cross(a))];
        let n = (b - a).cross(c - a);
        if n == DVec3::ZERO {
            return Some(false);
        }
        let t = n.dot(a) / n.dot(d);
        let reach = if light.is_directional() {
            f64::INFINITY
        } else {
            1.0
        };
        let doubtful = [n.dot(d), t - 1.0, t].into_iter().chain(sides);
        if doubtful.into_iter().any(|x| x.abs() < TOO_CLOSE) {
            return None;
        }
        let inside = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
        Some(inside && t > 0.0 && t < reach)
    }

    fn blockers(mesh: &Mesh, p: DVec3, light: HardLight) -> Option<i32> {
        let each = (0..mesh.triangles().len()).map(|t| blocks(mesh, t, p, light).map(i32::from));
        each.sum()
    }

    fn generalised(mesh: &Mesh, light: HardLight) -> ShadowVolume {
        ShadowVolume::generalised(mesh, &EdgeAdjacency::new(mesh.triangles()), light)
    }

    fn coordinate() -> impl Strategy<Value = f32> {
        (-64i32..64).prop_map(|i| i as f32 / 32.0)
    }

    fn soup() -> impl Strategy<Value = Mesh> {
        let positions = prop::collection::vec(prop::array::uniform3(coordinate()), 8);
        let triangles = prop::collection::vec(prop::array::uniform3(0u32..8), 1..12);
        (positions, triangles).prop_map(|(p, t)| Mesh::new(p, t, Shading::Flat).unwrap())
    }

    fn light() -> impl Strategy<Value = HardLight> {
        prop::array::uniform3(-3.0f64..3.0).prop_flat_map(|v| {
            let v = DVec3::from(v) + DVec3::new(0.01, 5.0, 0.02);
            prop_oneof![Just(HardLight::Point(v)), Just(HardLight::Directional(v))]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// Open, non-manifold, degenerate: the generalised volume's winding at
        /// any point is the number of triangles that block the light there,
        /// and the sum of the volumes of the single triangles.
        #[test]
        fn generalised_winding_counts_blockers(
            mesh in soup(), light in light(), p in prop::array::uniform3(-2.5f64..2.5),
        ) {
            let p = DVec3::from(p);
            prop_assume!(blockers(&mesh, p, light).is_some());
            let winding = volume_winding(&generalised(&mesh, light), p);
            prop_assert_eq!(winding, blockers(&mesh, p, light).unwrap());

            let alone = mesh.triangles().iter().map(|t| {
                let one = Mesh::new(mesh.positions().to_vec(), vec![*t], Shading::Flat).unwrap();
                volume_winding(&generalised(&one, light), p)
            });
            prop_assert_eq!(winding, alone.sum::<i32>());
        }

        /// Closed caster: the winding is the number of light-facing blockers,
        /// and the generalised volume counts exactly twice that outside.
        #[test]
        fn closed_winding_counts_layers(
            light in light(), p in prop::array::uniform3(-4.0f64..4.0),
        ) {
            let p = DVec3::from(p);
            let knot = shape::torus_knot(2, 3, 1.0, 0.4, 0.18, 48, 8, DVec3::ZERO);
            let mesh = knot.into_mesh(Shading::Smooth).unwrap();
            let all = blockers(&mesh, p, light);
            prop_assume!(all.is_some() && crate::geometry::winding::mesh_winding(&mesh, p) == 0);
            let adjacency = EdgeAdjacency::new(mesh.triangles());
            let closed = volume_winding(&ShadowVolume::of_closed(&mesh, &adjacency, light), p);
            prop_assert_eq!(2 * closed, all.unwrap());
            prop_assert_eq!(volume_winding(&generalised(&mesh, light), p), all.unwrap());
        }
    }

    #[test]
    fn a_box_casts_below_and_not_above() {
        let mesh = shape::cuboid(DVec3::ZERO, DVec3::ONE)
            .into_mesh(Shading::Flat)
            .unwrap();
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        for light in [
            HardLight::Point(DVec3::new(0.1, 5.0, 0.2)),
            HardLight::Directional(DVec3::new(0.1, 5.0, 0.2)),
        ] {
            let volume = ShadowVolume::of_closed(&mesh, &adjacency, light);
            assert_eq!(volume_winding(&volume, DVec3::new(0.1, -2.0, 0.05)), 1);
            assert_eq!(volume_winding(&volume, DVec3::new(0.1, 2.0, 0.05)), 0);
            assert_eq!(volume_winding(&volume, DVec3::new(7.0, -2.0, 0.05)), 0);
        }
    }

    /// Without the sides the count must come out wrong: the test above can fail.
    #[test]
    fn negative_control_caps_alone_do_not_count() {
        let mesh = shape::cuboid(DVec3::ZERO, DVec3::ONE)
            .into_mesh(Shading::Flat)
            .unwrap();
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let light = HardLight::Point(DVec3::new(0.1, 5.0, 0.2));
        let mut volume = ShadowVolume::of_closed(&mesh, &adjacency, light);
        volume.triangles.truncate(volume.sides.start);
        let exact =
            crate::geometry::winding::volume_solid_angle(&volume, DVec3::new(0.1, -2.0, 0.05));
        assert!((exact - 1.0).abs() > 0.1, "{exact}");
    }

    #[test]
    fn ranges_partition_the_triangles() {
        let mesh = shape::icosphere(2, 1.0, DVec3::ZERO)
            .into_mesh(Shading::Smooth)
            .unwrap();
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let light = HardLight::Point(DVec3::new(3.0, 4.0, 0.5));
        let volume = ShadowVolume::of_closed(&mesh, &adjacency, light);
        let [near, far, sides] = volume.ranges();
        assert_eq!((near.end, far.end), (far.start, sides.start));
        assert_eq!(near.len() + far.len(), mesh.triangles().len());
        assert_eq!(sides.end, volume.triangles().len());
        assert!(
            volume
                .light_cap()
                .iter()
                .flatten()
                .all(|&i| (i as usize) < mesh.positions().len())
        );
        assert!(
            volume
                .dark_cap()
                .iter()
                .flatten()
                .all(|&i| (i as usize) >= mesh.positions().len())
        );
    }
}
