//! Closed tubes through rings.

use glam::DVec3;

use super::Shape;

/// A tube through rings of equally many points, closed by fans over the first and the last
/// one. Points of a ring follow each other counter-clockwise about the direction in which
/// the tube begins; that way round they stay where it turns back into itself, as the wall
/// of a bell does.
///
/// # Panics
/// There are fewer than two rings, or a ring has fewer than three points or another number
/// than the first.
pub fn tube(rings: &[Vec<DVec3>]) -> Shape {
    let around = rings[0].len() as u32;
    let along = rings.len() as u32;
    assert!(along >= 2 && around >= 3, "{along} rings of {around}");
    assert!(rings.iter().all(|r| r.len() as u32 == around));
    let mut triangles = Vec::new();
    for i in 0..along - 1 {
        for j in 0..around {
            let next = (j + 1) % around;
            let [a, b] = [i * around + j, i * around + next];
            let [d, c] = [a + around, b + around];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let last = (along - 1) * around;
    for j in 1..around - 1 {
        triangles.push([0, j + 1, j]);
        triangles.push([last, last + j, last + j + 1]);
    }
    Shape {
        positions: rings.iter().flatten().copied().collect(),
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::winding::mesh_winding;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;

    #[test]
    fn a_tube_is_closed_and_faces_outwards_also_where_it_turns_back() {
        let ring = |y: f64, r: f64| {
            let corners = [[1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0, 1.0]];
            corners.map(|[x, z]| DVec3::new(r * x, y, r * z)).to_vec()
        };
        // A cup: up outside, down inside to half its height.
        let cup = tube(&[
            ring(0.0, 1.0),
            ring(2.0, 1.0),
            ring(2.0, 0.8),
            ring(1.0, 0.8),
        ]);
        let mesh = cup.into_mesh(Shading::Smooth).unwrap();
        assert!(
            EdgeAdjacency::new(mesh.triangles())
                .closedness(&mesh)
                .is_closed()
        );
        assert_eq!(mesh_winding(&mesh, DVec3::new(0.1, 0.5, 0.0)), 1);
        assert_eq!(mesh_winding(&mesh, DVec3::new(0.1, 1.5, 0.0)), 0);
        assert_eq!(mesh_winding(&mesh, DVec3::new(0.45, 1.5, 0.43)), 1);
    }
}
