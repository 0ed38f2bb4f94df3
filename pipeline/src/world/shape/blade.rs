//! Thin blades along a line: leaves and wings.

use glam::DVec3;

use super::{Shape, tube};

/// A place along the middle of a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rib {
    /// Where.
    pub middle: DVec3,
    /// To the left border, half the width.
    pub half: DVec3,
    /// To the upper face, half the thickness in the middle; borders are a quarter of it.
    pub up: DVec3,
}

/// A closed blade through ribs, which follow one another along `half` x `up` or against it.
///
/// # Panics
/// There are fewer than two ribs.
pub fn blade(ribs: &[Rib]) -> Shape {
    let along = ribs[ribs.len() - 1].middle - ribs[0].middle;
    let against = ribs[0].half.cross(ribs[0].up).dot(along) < 0.0;
    let ring = |rib: &Rib| {
        let border = |side: f64, z: f64| rib.middle + rib.half * side + rib.up * (0.25 * z);
        let ring = [
            border(1.0, -1.0),
            border(1.0, 1.0),
            rib.middle + rib.up,
            border(-1.0, 1.0),
            border(-1.0, -1.0),
            rib.middle - rib.up,
        ];
        let mut ring = ring.to_vec();
        if against {
            ring.reverse();
        }
        ring
    };
    tube(&ribs.iter().map(ring).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;

    #[test]
    fn blades_are_closed_and_face_outwards_either_way() {
        for way in [1.0, -1.0] {
            let rib = |k: u32| {
                let t = f64::from(k) / 6.0;
                Rib {
                    middle: DVec3::new(way * t, 0.2 * t * t, 0.0),
                    half: DVec3::Z * (0.05 + 0.3 * t * (1.0 - t)),
                    up: DVec3::Y * 0.01,
                }
            };
            let ribs: Vec<Rib> = (0..=6).map(rib).collect();
            let mesh = blade(&ribs).into_mesh(Shading::Flat).unwrap();
            let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
            assert!(report.is_closed(), "{report}");
            assert!(mesh.signed_volume() > 0.0, "{way}");
        }
    }
}
