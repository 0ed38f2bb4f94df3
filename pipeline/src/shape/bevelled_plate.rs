//! Horizontal plates whose shadow is exactly that of their upper face.

use glam::DVec3;

use super::Shape;

/// A closed square plate: upper face of half side `half` at height `y`, lower
/// face `thickness` below and smaller by `slope * thickness` on each side. For
/// light from above whose rays lean by at most `slope` from the vertical, the
/// lower face and the bevels never block more than the upper face does.
pub fn bevelled_plate(half: f64, y: f64, thickness: f64, slope: f64) -> Shape {
    let ring =
        |h: f64, y: f64| [(-h, -h), (h, -h), (h, h), (-h, h)].map(|(x, z)| DVec3::new(x, y, z));
    let upper = ring(half, y);
    let lower = ring(half - slope * thickness, y - thickness);
    let bevels = (0..4).flat_map(|k| {
        let m = (k + 1) % 4;
        [[k, m, 4 + m], [k, 4 + m, 4 + k]]
    });
    Shape {
        positions: upper.into_iter().chain(lower).collect(),
        triangles: [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]
            .into_iter()
            .chain(bevels)
            .collect(),
    }
}
