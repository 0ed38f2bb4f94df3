//! Winding numbers by summed solid angles, in f64.
//!
//! Slow (one arctangent per triangle) and independent of rays, silhouettes and
//! rasterisation: the reference for what a volume counts, and the test for
//! whether a light or an eye is inside a caster.
//!
//! Source: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle",
//! IEEE Trans. Biomed. Eng. 1983.

use glam::{DVec3, DVec4};

use crate::geometry::volume::ShadowVolume;
use crate::world::mesh::Mesh;

/// How often a closed mesh with outward-facing triangles winds round `p`: 1
/// inside, 0 outside, more where parts overlap. Meaningless on the surface.
pub fn mesh_winding(mesh: &Mesh, p: DVec3) -> i32 {
    let angles = (0..mesh.triangles().len()).map(|t| solid_angle(mesh.corners(t).map(|v| v - p)));
    nearest_count(angles.sum::<f64>() / FULL_SPHERE)
}

/// How often a shadow volume winds round `p`: the value that an ideal stencil
/// would hold for a surface point at `p`. Meaningless on the volume's boundary.
pub fn volume_winding(volume: &ShadowVolume, p: DVec3) -> i32 {
    nearest_count(volume_solid_angle(volume, p))
}

/// The solid angle of the volume's boundary from `p`, in full spheres; a whole
/// number exactly when the volume is closed.
pub fn volume_solid_angle(volume: &ShadowVolume, p: DVec3) -> f64 {
    let seen_from_p = |i: u32| {
        let [x, y, z, w] = volume.positions()[i as usize].map(f64::from);
        DVec3::new(x, y, z) - p * w // w = 0: a direction looks the same from everywhere
    };
    let angles = volume
        .triangles()
        .iter()
        .map(|t| solid_angle(t.map(seen_from_p)));
    angles.sum::<f64>() / FULL_SPHERE
}

/// How often a closed surface of homogeneous triangles winds round `p`.
pub(crate) fn of_triangles(triangles: impl Iterator<Item = [DVec4; 3]>, p: DVec3) -> i32 {
    let seen_from_p = |v: DVec4| v.truncate() - p * v.w;
    let angles = triangles.map(|t| solid_angle(t.map(seen_from_p)));
    nearest_count(angles.sum::<f64>() / FULL_SPHERE)
}

const FULL_SPHERE: f64 = 4.0 * std::f64::consts::PI;

fn nearest_count(spheres: f64) -> i32 {
    spheres.round() as i32
}

/// Signed solid angle of the triangle from the origin; positive when its
/// counter-clockwise side faces away from the origin.
fn solid_angle(corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| v / v.length().max(f64::MIN_POSITIVE));
    let numerator = a.dot(b.cross(c));
    let denominator = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    2.0 * libm::atan2(numerator, denominator)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::mesh::Shading;
    use crate::world::shape;

    #[test]
    fn inside_counts_one_and_overlap_two() {
        let one = shape::icosphere(2, 1.0, DVec3::ZERO);
        let other = shape::icosphere(2, 1.0, DVec3::X);
        let both = shape::Shape::merged([one, other])
            .into_mesh(Shading::Smooth)
            .unwrap();
        assert_eq!(mesh_winding(&both, DVec3::new(0.5, 0.1, 0.0)), 2);
        assert_eq!(mesh_winding(&both, DVec3::new(-0.5, 0.1, 0.0)), 1);
        assert_eq!(mesh_winding(&both, DVec3::new(-1.5, 0.1, 0.0)), 0);
    }

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        let octant = solid_angle([DVec3::X, DVec3::Y * 3.0, DVec3::Z]);
        assert!((octant - FULL_SPHERE / 8.0).abs() < 1e-15);
    }
}
