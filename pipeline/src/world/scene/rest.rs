//! Objects that move as a whole.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::world::mesh::{Mesh, widen};

/// The mesh of an object before it moved, and how it moved since. What depends on an
/// object's shape alone need not be computed again while it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// The mesh in its own axes.
    pub mesh: Arc<Mesh>,
    /// From its axes to the world's; turns without scaling.
    pub turn: DMat3,
    /// Where its origin came to lie.
    pub offset: DVec3,
}

/// How far a vertex may be from where the motion takes it, as a share of the largest
/// coordinate: some roundings to f32.
const TOLERANCE: f64 = 1e-6;

impl Rest {
    /// Whether `moved` is this mesh where it came to lie, vertex for vertex and normal
    /// for normal.
    pub fn is_of(&self, moved: &Mesh) -> bool {
        let same = self.mesh.triangles() == moved.triangles()
            && self.mesh.normal_triangles() == moved.normal_triangles();
        same && self.all_moved(self.mesh.positions(), moved.positions(), self.offset)
            && self.all_moved(self.mesh.normals(), moved.normals(), DVec3::ZERO)
    }

    fn all_moved(&self, from: &[[f32; 3]], to: &[[f32; 3]], offset: DVec3) -> bool {
        let largest = to.iter().flatten().map(|c| f64::from(c.abs()));
        let most = TOLERANCE
            * largest
                .fold(self.offset.length().min(1.0), f64::max)
                .max(1e-300);
        let near = |(a, b): (&[f32; 3], &[f32; 3])| {
            let off = self.turn * widen(*a) + offset - widen(*b);
            off.abs().max_element() <= 4.0 * most
        };
        from.len() == to.len() && from.iter().zip(to).all(near)
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat4;

    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::shape::{self, on_circle};

    #[test]
    fn a_moved_mesh_is_known_again_and_others_are_not() {
        let (cos, sin) = on_circle(0.7);
        let turn = DMat3::from_cols(
            DVec3::new(cos, 0.0, -sin),
            DVec3::Y,
            DVec3::new(sin, 0.0, cos),
        );
        let offset = DVec3::new(3.0, -1.0, 0.5);
        let shape = || shape::capsule(DVec3::ZERO, DVec3::new(0.3, 0.9, 0.0), 0.3, 0.2, 12, 4);
        let place = DMat4::from_translation(offset) * DMat4::from_mat3(turn);
        let mesh = |s: shape::Shape| s.into_mesh(Shading::Smooth).unwrap();
        let moved = mesh(shape().transformed(place));
        let rest = Rest {
            mesh: Arc::new(mesh(shape())),
            turn,
            offset,
        };
        assert!(rest.is_of(&moved));
        let still = Rest {
            turn: DMat3::IDENTITY,
            ..rest.clone()
        };
        assert!(!still.is_of(&moved));
        let away = Rest {
            offset: offset + DVec3::X * 1e-4,
            ..rest.clone()
        };
        assert!(!away.is_of(&moved));
        let other = mesh(shape::cuboid(DVec3::ZERO, DVec3::ONE));
        assert!(!rest.is_of(&other));
    }
}
