//! Procedural solids in f64, before they are placed and rounded.
//!
//! One generator per file. All solids are closed, counter-clockwise from
//! outside; the generators that the peers share (`plane`, `cylinder`,
//! `icosphere`, `terrain`, `torus_knot`) keep their vertex and triangle order.

mod bevelled_plate;
mod blade;
mod capsule;
mod creature;
mod cuboid;
mod cylinder;
mod diamond_square;
mod icosphere;
mod plane;
mod prism;
mod statue;
mod terrain;
mod torus_knot;
mod tube;

pub use bevelled_plate::{bevelled_plate, bevelled_plate_in_pieces};
pub use blade::{Rib, blade};
pub use capsule::capsule;
pub use creature::{CREATURE_PARTS, creature, placed_creature};
pub use cuboid::cuboid;
pub use cylinder::cylinder;
pub use diamond_square::diamond_square;
pub use icosphere::icosphere;
pub use plane::plane;
pub use prism::{Outline, prism};
pub use statue::statue;
pub use terrain::{Terrain, terrain};
pub use torus_knot::torus_knot;
pub use tube::tube;

use glam::{DMat4, DVec3};

use crate::world::error::MeshError;
use crate::world::mesh::{Mesh, Shading, narrow, widen};

/// An indexed triangle list with f64 positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    /// Triangles, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// Positions (widened exactly) and triangles of a mesh.
    pub fn from_mesh(mesh: &Mesh) -> Self {
        Self {
            positions: mesh.positions().iter().map(|&p| widen(p)).collect(),
            triangles: mesh.triangles().to_vec(),
        }
    }

    /// Applies an affine `world_from_local` in f64. A mirroring transform turns
    /// the triangles round, so that outside stays outside.
    pub fn transformed(mut self, world_from_local: DMat4) -> Self {
        for p in &mut self.positions {
            *p = world_from_local.transform_point3(*p);
        }
        if world_from_local.determinant() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    /// Smallest and largest coordinates; `None` for a shape without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (first, rest) = self.positions.split_first()?;
        let around = |(low, high): (DVec3, DVec3), p: &DVec3| (low.min(*p), high.max(*p));
        Some(rest.iter().fold((*first, *first), around))
    }

    /// Moves by `offset`.
    pub fn translated(mut self, offset: DVec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p += offset);
        self
    }

    /// Concatenates shapes; vertices are not shared between them.
    pub fn merged(shapes: impl IntoIterator<Item = Self>) -> Self {
        let mut out = Self::default();
        for shape in shapes {
            let base = out.positions.len() as u32;
            out.positions.extend(shape.positions);
            out.triangles
                .extend(shape.triangles.iter().map(|t| t.map(|i| i + base)));
        }
        out
    }

    /// Rounds coordinates to multiples of 2^-16, ties upwards, as the peers do;
    /// f32 then holds them exactly (below 256).
    pub fn snapped(mut self) -> Self {
        const SNAP: f64 = 65536.0;
        for p in &mut self.positions {
            *p = (*p * SNAP + DVec3::splat(0.5)).floor() / SNAP;
        }
        self
    }

    /// Rounds positions to f32 once and computes normals.
    ///
    /// # Errors
    /// As [`Mesh::new`]; a coordinate beyond f32's range becomes infinite.
    pub fn into_mesh(self, shading: Shading) -> Result<Mesh, MeshError> {
        let positions = self.positions.into_iter().map(narrow).collect();
        Mesh::new(positions, self.triangles, shading)
    }
}

/// The point at `angle` (radians) on the unit circle, `(cos, sin)`.
pub(crate) fn on_circle(angle: f64) -> (f64, f64) {
    (libm::cos(angle), libm::sin(angle))
}

/// Angle of step `k` of `n` round the circle, formed as the peers form it.
pub(crate) fn step_angle(k: u32, n: u32) -> f64 {
    2.0 * std::f64::consts::PI * f64::from(k) / f64::from(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;

    fn check_closed_and_outward(shape: Shape) {
        let mesh = shape.into_mesh(Shading::Smooth).unwrap();
        let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
        assert!(report.is_closed(), "{report}");
        assert_eq!(report.zero_area_triangles, 0);
        assert!(mesh.signed_volume() > 0.0);
    }

    #[test]
    fn solids_are_closed_and_face_outwards() {
        check_closed_and_outward(cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)));
        check_closed_and_outward(cylinder(7, 0.5, -1.0, 2.0));
        check_closed_and_outward(icosphere(3, 0.5, DVec3::ONE));
        check_closed_and_outward(capsule(
            DVec3::ZERO,
            DVec3::new(1.0, 2.0, -0.5),
            0.3,
            0.2,
            12,
            4,
        ));
        check_closed_and_outward(torus_knot(1, 0, 1.0, 0.0, 0.3, 24, 12, DVec3::ZERO));
        check_closed_and_outward(bevelled_plate(0.3, 2.0, 0.01, 1.5));
        check_closed_and_outward(bevelled_plate_in_pieces(0.3, 2.0, 0.01, 1.5, 5));
        creature(0.7).into_iter().for_each(check_closed_and_outward);
        check_closed_and_outward(torus_knot(2, 3, 1.0, 0.4, 0.18, 64, 8, DVec3::ZERO));
    }

    #[test]
    fn mirroring_keeps_outside_outside() {
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 2.0, 1.0));
        check_closed_and_outward(cylinder(7, 0.5, -1.0, 2.0).transformed(mirror));
    }
}
