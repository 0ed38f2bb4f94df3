//! Outlines in a plane, and solids of one thickness over them.

use earcut::Earcut;
use glam::{DVec2, DVec3};

use super::Shape;

/// An area with holes: corners counter-clockwise, of holes clockwise, without three in a
/// line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// The border.
    pub border: Vec<DVec2>,
    /// Borders of holes.
    pub holes: Vec<Vec<DVec2>>,
}

impl Outline {
    /// Without holes.
    pub fn solid(corners: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self {
            border: corners.into_iter().map(DVec2::from_array).collect(),
            holes: Vec::new(),
        }
    }

    /// A line of twice the `half` width along `path`, with mitred corners.
    ///
    /// # Panics
    /// The path has fewer than two points.
    pub fn stroke(path: &[DVec2], half: f64) -> Self {
        assert!(path.len() >= 2, "a path of {} points", path.len());
        let last = path.len() - 1;
        let direction = |k: usize| (path[k + 1] - path[k]).normalize_or_zero();
        let beside = |k: usize, side: f64| {
            let (before, after) = (direction(k.max(1) - 1), direction(k.min(last - 1)));
            let across = (before + after).normalize_or_zero().perp();
            // As far along the bisector as keeps the line's width.
            path[k] + across * (side * half / across.dot(after.perp()))
        };
        let right = (0..=last).map(|k| beside(k, -1.0));
        let left = (0..=last).rev().map(|k| beside(k, 1.0));
        Self {
            border: right.chain(left).collect(),
            holes: Vec::new(),
        }
    }

    /// Twice the area, with the sign of its orientation.
    fn twice_area(ring: &[DVec2]) -> f64 {
        let next = |k: usize| ring[(k + 1) % ring.len()];
        (0..ring.len()).map(|k| ring[k].perp_dot(next(k))).sum()
    }

    /// The area without holes.
    pub fn area(&self) -> f64 {
        let rings = std::iter::once(&self.border).chain(&self.holes);
        rings.map(|r| 0.5 * Self::twice_area(r)).sum()
    }
}

/// The solid between an outline at z = 0 and the same at `-depth`, closed.
pub fn prism(outline: &Outline, depth: f64) -> Shape {
    let rings: Vec<&Vec<DVec2>> = std::iter::once(&outline.border)
        .chain(&outline.holes)
        .collect();
    let corners: Vec<DVec2> = rings.iter().flat_map(|r| r.iter().copied()).collect();
    let n = corners.len() as u32;
    let mut triangles = caps(outline, &corners);
    let mut first = 0;
    for ring in rings {
        let count = ring.len() as u32;
        for k in 0..count {
            let (a, b) = (first + k, first + (k + 1) % count);
            triangles.extend([[a, n + a, b], [b, n + a, n + b]]);
        }
        first += count;
    }
    let at = |z: f64| corners.iter().map(move |c| c.extend(z));
    Shape {
        positions: at(0.0).chain(at(-depth)).collect::<Vec<DVec3>>(),
        triangles,
    }
}

/// Front and back.
fn caps(outline: &Outline, corners: &[DVec2]) -> Vec<[u32; 3]> {
    let plane: Vec<[f64; 2]> = corners.iter().map(|c| c.to_array()).collect();
    let mut at = outline.border.len() as u32;
    let mut holes = Vec::new();
    for hole in &outline.holes {
        holes.push(at);
        at += hole.len() as u32;
    }
    let mut ears: Vec<u32> = Vec::new();
    Earcut::new().earcut(plane, &holes, &mut ears);
    let n = corners.len() as u32;
    let mut triangles = Vec::with_capacity(2 * ears.len() / 3);
    for t in ears.chunks_exact(3) {
        let [a, b, c] = [t[0], t[1], t[2]];
        let [p, q, r] = [a, b, c].map(|i| corners[i as usize]);
        let turned = (q - p).perp_dot(r - p) < 0.0;
        let [a, b, c] = if turned { [a, c, b] } else { [a, b, c] };
        triangles.extend([[a, b, c], [n + a, n + c, n + b]]);
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;

    fn assert_solid(outline: &Outline, depth: f64) {
        let mesh = prism(outline, depth).into_mesh(Shading::Flat).unwrap();
        let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
        assert!(report.is_closed(), "{report}");
        let off = mesh.signed_volume() - outline.area() * depth;
        assert!(off.abs() < 1e-6, "{off}");
        assert!(outline.area() > 0.0);
    }

    #[test]
    fn prisms_hold_their_area_times_their_depth() {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let mut frame = Outline::solid(square);
        assert_solid(&frame, 0.5);
        let hole = [[-0.5, -0.5], [-0.5, 0.5], [0.5, 0.5], [0.5, -0.5]];
        frame.holes.push(hole.map(DVec2::from_array).to_vec());
        assert!((frame.area() - 3.0).abs() < 1e-12);
        assert_solid(&frame, 0.25);
    }

    #[test]
    fn strokes_keep_their_width_round_corners() {
        let path = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]].map(DVec2::from_array);
        let stroke = Outline::stroke(&path, 0.25);
        // Two bars that share a square at the corner, half of it on either side.
        assert!(
            (stroke.area() - (2.0 + 1.0) * 0.5).abs() < 1e-12,
            "{}",
            stroke.area()
        );
        assert_solid(&stroke, 0.3);
    }
}
