//! Clipping to, and sectors of, a convex polygon round the origin: the f64 twin of the
//! shaders', and what tables for polygons hold.

use glam::{DVec2, DVec3};

/// A convex polygon, counter-clockwise, with the light's centre at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonImage {
    corners: Vec<DVec2>,
}

impl PolygonImage {
    /// Through these corners.
    pub fn new(corners: Vec<DVec2>) -> Self {
        Self { corners }
    }

    fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let n = self.corners.len();
        (0..n).map(move |k| [self.corners[k], self.corners[(k + 1) % n]])
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        0.5 * self.edges().map(|[a, b]| a.perp_dot(b)).sum::<f64>()
    }

    /// The part of the edge between two points of its plane that is on it.
    pub fn clip(&self, [p, q]: [DVec2; 2]) -> Option<[DVec2; 2]> {
        self.clip_homogeneous(p.extend(1.0), q.extend(1.0))
    }

    /// The same of an edge in homogeneous coordinates.
    pub fn clip_homogeneous(&self, a: DVec3, b: DVec3) -> Option<[DVec2; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for [c, d] in self.edges() {
            let normal = (d - c).perp();
            let inside = |p: DVec3| normal.dot(p.truncate()) - normal.dot(c) * p.z;
            cut(inside(a), inside(b), [&mut from, &mut to]);
        }
        let at = |t: f64| {
            let h = a + (b - a) * t;
            (h.z > 0.0).then(|| h.truncate() / h.z)
        };
        (from < to).then_some([at(from)?, at(to)?])
    }

    /// Area between the rays from the centre through p and q, on the side where they are
    /// less than half a turn apart.
    pub fn sector(&self, p: DVec2, q: DVec2) -> f64 {
        let (p, q) = if p.perp_dot(q) < 0.0 { (q, p) } else { (p, q) };
        let between = |[a, b]: [DVec2; 2]| {
            let (mut from, mut to) = (0.0f64, 1.0f64);
            cut(p.perp_dot(a), p.perp_dot(b), [&mut from, &mut to]);
            cut(a.perp_dot(q), b.perp_dot(q), [&mut from, &mut to]);
            (to - from).max(0.0) * a.perp_dot(b)
        };
        0.5 * self.edges().map(between).sum::<f64>()
    }

    /// Covered share for an edge between two points of its plane.
    pub fn coverage(&self, edge: [DVec2; 2]) -> f64 {
        self.clip(edge).map_or(0.0, |[p, q]| {
            let area = self.sector(p, q) - 0.5 * p.perp_dot(q).abs();
            (area / self.area()).max(0.0)
        })
    }
}

/// Leaves out what is negative of a function with values at both ends.
fn cut(fa: f64, fb: f64, [from, to]: [&mut f64; 2]) {
    match (fa < 0.0, fb < 0.0) {
        (true, true) => (*from, *to) = (2.0, -1.0),
        (true, false) => *from = from.max(fa / (fa - fb)),
        (false, true) => *to = to.min(fa / (fa - fb)),
        (false, false) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::coverage::square_share;

    fn square() -> PolygonImage {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        PolygonImage::new(corners.map(DVec2::from).to_vec())
    }

    #[test]
    fn four_corners_cover_as_a_square_does() {
        let at = |k: i32| {
            DVec2::new(
                0.31 * f64::from(k % 7) - 0.93,
                0.27 * f64::from(k / 7) - 0.9,
            )
        };
        for (i, j) in (0..49).flat_map(|i| (0..49).map(move |j| (i, j))) {
            let (p, q) = (at(i), at(j));
            if p.perp_dot(q) == 0.0 {
                continue;
            }
            let expected = square_share(p, q) - 0.125 * p.perp_dot(q).abs();
            let found = square().coverage([p, q]);
            assert!(
                (found - expected).abs() < 1e-12,
                "{p} {q}: {found} {expected}"
            );
        }
        assert_eq!(
            square()
                .clip([DVec2::new(-3.0, 0.5), DVec2::new(3.0, 0.5)])
                .unwrap()[0]
                .x,
            -1.0
        );
        assert_eq!(
            square().clip([DVec2::new(-3.0, 2.5), DVec2::new(3.0, 2.5)]),
            None
        );
    }

    /// A triangle's sectors add up to it, and an edge through its centre halves it by area.
    #[test]
    fn sectors_of_a_triangle_add_up() {
        let corners = [[1.0, 0.0], [-0.5, 0.8], [-0.5, -0.8]].map(DVec2::from);
        let triangle = PolygonImage::new(corners.to_vec());
        let thirds = (0..3).map(|k| triangle.sector(corners[k], corners[(k + 1) % 3]));
        assert!((thirds.sum::<f64>() - triangle.area()).abs() < 1e-15);
        let half = triangle.coverage([DVec2::new(-2.0, 0.0), DVec2::new(2.0, 0.0)]);
        assert!((half - 0.5).abs() < 1e-15);
    }
}
