//! A horizontal square sheet.

use glam::DVec3;

use super::Shape;

/// The square `|x|, |z| <= half` at height `y`, facing up: 2 triangles, not
/// closed (a receiver).
pub fn plane(half: f64, y: f64) -> Shape {
    let corner = |x, z| DVec3::new(x, y, z);
    Shape {
        positions: vec![
            corner(-half, -half),
            corner(half, -half),
            corner(half, half),
            corner(-half, half),
        ],
        triangles: vec![[0, 2, 1], [0, 3, 2]],
    }
}
