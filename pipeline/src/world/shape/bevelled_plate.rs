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

/// The same body with each of its edges round the plate in `pieces` collinear ones,
/// and a vertex in the middle of either face.
pub fn bevelled_plate_in_pieces(
    half: f64,
    y: f64,
    thickness: f64,
    slope: f64,
    pieces: u32,
) -> Shape {
    let ring = |h: f64, y: f64| {
        let corners = [(-h, -h), (h, -h), (h, h), (-h, h)].map(|(x, z)| DVec3::new(x, y, z));
        let side = move |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            (0..pieces).map(move |i| from + (to - from) * (f64::from(i) / f64::from(pieces)))
        };
        (0..4).flat_map(side).collect::<Vec<DVec3>>()
    };
    let mut positions = ring(half, y);
    let n = positions.len() as u32;
    positions.extend(ring(half - slope * thickness, y - thickness));
    positions.extend([DVec3::Y * y, DVec3::Y * (y - thickness)]);
    let (top, bottom) = (2 * n, 2 * n + 1);
    let round = (0..n).flat_map(|k| {
        let m = (k + 1) % n;
        [
            [top, m, k],
            [bottom, n + k, n + m],
            [k, m, n + m],
            [k, n + m, n + k],
        ]
    });
    Shape {
        triangles: round.collect(),
        positions,
    }
}
