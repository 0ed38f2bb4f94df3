//! Axis-aligned boxes.

use glam::DVec3;

use super::Shape;

/// The box about `centre` with edge lengths `size`: 8 vertices, 12 triangles.
pub fn cuboid(centre: DVec3, size: DVec3) -> Shape {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        centre + size * DVec3::new(side(0), side(1), side(2))
    };
    const FACES: [[u32; 4]; 6] = [
        [0, 4, 6, 2], // -x
        [1, 3, 7, 5], // +x
        [0, 1, 5, 4], // -y
        [2, 6, 7, 3], // +y
        [0, 2, 3, 1], // -z
        [4, 5, 7, 6], // +z
    ];
    Shape {
        positions: (0..8).map(corner).collect(),
        triangles: FACES
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}
