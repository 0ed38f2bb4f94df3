//! What an edge covers of an image on a light, and what of it a polygon holds: sums
//! along lines instead of areas, by Green's theorem.
//!
//! With F(x, y) the light left of x in the row of y, the integral of F dy round a region
//! is the light in it. Along a line F is linear between the borders of cells, so its
//! value half way between two of them gives the integral of the piece without error.

use glam::DVec2;

use super::square_swept;
use crate::world::light_image::LightImage;

/// An image prepared for sums.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageSums {
    side: usize,
    /// Share of its colour's light in each cell.
    cells: Vec<[f64; 3]>,
    /// The same, of all cells left of it in its row.
    left: Vec<[f64; 3]>,
    /// The same, of all rows before a row; one more than rows.
    below: Vec<[f64; 3]>,
}

/// A point of the light with what sums need of the ray from the centre through it.
#[derive(Clone, Copy, Debug)]
pub struct Spoke {
    point: DVec2,
    /// Along the ray, from the point to the border.
    outwards: [f64; 3],
    /// Along the border counter-clockwise, from (1, -1) to where the ray meets it.
    border: [f64; 3],
    /// How far round that is.
    swept: f64,
}

impl ImageSums {
    /// Prepares `image`.
    pub fn new(image: &LightImage) -> Self {
        let (side, cells) = (image.side(), image.shares());
        let mut left = Vec::with_capacity(cells.len());
        let mut below = vec![[0.0; 3]];
        for row in cells.chunks_exact(side) {
            let mut sum = [0.0; 3];
            for cell in row {
                left.push(sum);
                sum = plus(sum, *cell);
            }
            let all = below.last().copied().unwrap_or_default();
            below.push(plus(all, sum));
        }
        Self {
            side,
            cells,
            left,
            below,
        }
    }

    /// Share of each colour in a polygon, counter-clockwise and within the light.
    pub fn within(&self, polygon: &[DVec2]) -> [f64; 3] {
        let n = polygon.len();
        let edges = (0..n).map(|k| self.along(polygon[k], polygon[(k + 1) % n]));
        edges.fold([0.0; 3], plus)
    }

    /// Prepares a point.
    pub fn spoke(&self, point: DVec2) -> Spoke {
        let reach = point.x.abs().max(point.y.abs());
        // Nothing is covered up to the centre.
        let end = if reach > 0.0 { point / reach } else { point };
        Spoke {
            point,
            outwards: self.along(point, end),
            border: self.border(end),
            swept: square_swept(end),
        }
    }

    /// Covered share of each colour for an edge between two points, between it and the
    /// border, within the rays from the centre through them.
    pub fn covered(&self, p: &Spoke, q: &Spoke) -> [f64; 3] {
        let turn = p.point.perp_dot(q.point);
        if turn == 0.0 {
            // Through the centre, half of the light is on either side: their mean.
            let opposite = p.point.dot(q.point) < 0.0;
            return [if opposite { 0.5 } else { 0.0 }; 3];
        }
        let (p, q) = if turn > 0.0 { (p, q) } else { (q, p) };
        let round = if q.swept < p.swept { 1.0 } else { 0.0 };
        let back = self.along(q.point, p.point);
        [0, 1, 2].map(|c| {
            let border = q.border[c] - p.border[c] + round;
            (p.outwards[c] + border - q.outwards[c] + back[c]).max(0.0)
        })
    }

    /// The integral from (1, -1) round to a point of the border: F is everything on the
    /// right side, nothing on the left, and dy is 0 on the others.
    fn border(&self, end: DVec2) -> [f64; 3] {
        let swept = square_swept(end);
        if swept <= 1.0 {
            return self.rows_up_to(end.y);
        }
        self.below.last().copied().unwrap_or_default()
    }

    /// Light of all rows up to y.
    fn rows_up_to(&self, y: f64) -> [f64; 3] {
        let at = self.grid(y);
        let row = (at as usize).min(self.side - 1);
        let part = at - row as f64;
        let (from, to) = (self.below[row], self.below[row + 1]);
        [0, 1, 2].map(|c| from[c] + (to[c] - from[c]) * part)
    }

    /// Place in cells, 0 to side.
    fn grid(&self, x: f64) -> f64 {
        ((x + 1.0) * 0.5 * self.side as f64).clamp(0.0, self.side as f64)
    }

    /// The integral of F dy from `p` to `q`.
    fn along(&self, p: DVec2, q: DVec2) -> [f64; 3] {
        let [a, b] = [p, q].map(|v| DVec2::new(self.grid(v.x), self.grid(v.y)));
        let d = b - a;
        let mut sum = [0.0; 3];
        if d.y == 0.0 {
            return sum;
        }
        let mut borders = [Crossings::new(a.x, d.x), Crossings::new(a.y, d.y)];
        let mut from = 0.0;
        while from < 1.0 {
            let to = borders[0].next.min(borders[1].next).min(1.0);
            let value = self.left_of(a + d * (0.5 * (from + to)));
            let rise = (to - from) * d.y;
            sum = [0, 1, 2].map(|c| sum[c] + value[c] * rise);
            borders.iter_mut().for_each(|b| b.pass(to));
            from = to;
        }
        sum
    }

    /// F at a place in cells.
    fn left_of(&self, at: DVec2) -> [f64; 3] {
        let [column, row] = [at.x, at.y].map(|x| (x as usize).min(self.side - 1));
        let cell = row * self.side + column;
        let part = at.x - column as f64;
        let (left, own) = (self.left[cell], self.cells[cell]);
        [0, 1, 2].map(|c| left[c] + own[c] * part)
    }
}

/// Where a line crosses the borders of cells along one axis.
struct Crossings {
    start: f64,
    slope: f64,
    /// The border that comes next, and where along the line.
    border: f64,
    next: f64,
}

impl Crossings {
    fn new(start: f64, slope: f64) -> Self {
        let border = if slope > 0.0 {
            start.floor() + 1.0
        } else {
            start.ceil() - 1.0
        };
        let mut crossings = Self {
            start,
            slope,
            border,
            next: f64::INFINITY,
        };
        crossings.find();
        crossings
    }

    fn find(&mut self) {
        if self.slope != 0.0 {
            self.next = (self.border - self.start) / self.slope;
        }
    }

    /// Goes on behind `at`.
    fn pass(&mut self, at: f64) {
        while self.next <= at {
            self.border += self.slope.signum();
            self.find();
        }
    }
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| a[c] + b[c])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::coverage::square_share;

    fn points() -> Vec<DVec2> {
        let at = |k: i32| f64::from(k) / 3.0 - 0.97;
        (0..6)
            .flat_map(|i| (0..6).map(move |j| DVec2::new(at(i), at(j))))
            .collect()
    }

    fn covered(image: &LightImage, p: DVec2, q: DVec2) -> [f64; 3] {
        let sums = ImageSums::new(image);
        sums.covered(&sums.spoke(p), &sums.spoke(q))
    }

    fn white(side: usize) -> LightImage {
        LightImage::of_picture([side; 2], &vec![[1.0; 3]; side * side]).unwrap()
    }

    #[test]
    fn a_white_image_covers_as_a_plain_light() {
        for p in points() {
            for q in points().into_iter().filter(|q| p.perp_dot(*q) != 0.0) {
                let plain = square_share(p, q) - 0.125 * p.perp_dot(q).abs();
                for share in covered(&white(3), p, q) {
                    assert!((share - plain).abs() < 1e-12, "{p} {q}: {share} {plain}");
                }
            }
        }
    }

    /// By cutting the region at the borders of every cell.
    #[test]
    fn sums_along_lines_are_sums_over_cells() {
        for image in [
            LightImage::windows(),
            LightImage::fire(3),
            LightImage::halves(),
        ] {
            let sums = ImageSums::new(&image);
            for p in points() {
                for q in points().into_iter().filter(|q| p.perp_dot(*q) != 0.0) {
                    let (shares, expected) =
                        (covered(&image, p, q), by_cells(&image, &region(p, q)));
                    let within = sums.within(&region(p, q));
                    for c in 0..3 {
                        assert!((shares[c] - expected[c]).abs() < 1e-12, "{p} {q}");
                        assert!((within[c] - expected[c]).abs() < 1e-12, "{p} {q}");
                    }
                }
            }
        }
    }

    #[test]
    fn edges_through_the_centre_cover_half() {
        let [p, q] = [DVec2::new(0.75, 0.25), DVec2::new(-0.375, -0.125)];
        assert_eq!(covered(&white(4), p, q), [0.5; 3]);
        assert_eq!(covered(&white(4), p, -q), [0.0; 3]);
        let beside = q + DVec2::new(1e-9, 0.0);
        assert!((covered(&white(4), p, beside)[0] - 0.5).abs() < 1e-8);
    }

    #[test]
    fn colours_are_covered_apart() {
        // An edge up the whole left side: all of red beyond it, none of cyan.
        let [p, q] = [DVec2::new(-0.5, 1.0), DVec2::new(-0.5, -1.0)];
        let [r, g, b] = covered(&LightImage::halves(), p, q);
        assert!(
            (r - 0.5).abs() < 1e-12 && g == 0.0 && b == 0.0,
            "{r} {g} {b}"
        );
    }

    fn by_cells(image: &LightImage, region: &[DVec2]) -> [f64; 3] {
        let (side, shares) = (image.side(), image.shares());
        let n = side as f64;
        let mut sum = [0.0; 3];
        for (k, share) in shares.iter().enumerate() {
            let low = DVec2::new((k % side) as f64, (k / side) as f64) * (2.0 / n) - 1.0;
            let high = low + 2.0 / n;
            let mut polygon = region.to_vec();
            for (axis, limit, sign) in [
                (0, low.x, 1.0),
                (0, high.x, -1.0),
                (1, low.y, 1.0),
                (1, high.y, -1.0),
            ] {
                polygon = clip(&polygon, |v| sign * (v[axis] - limit));
            }
            let part = area(&polygon) * n * n / 4.0;
            sum = [0, 1, 2].map(|c| sum[c] + share[c] * part);
        }
        sum
    }

    /// The convex region between an edge and the border, counter-clockwise.
    fn region(p: DVec2, q: DVec2) -> Vec<DVec2> {
        const CORNERS: [[f64; 2]; 4] = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let (p, q) = if p.perp_dot(q) > 0.0 { (p, q) } else { (q, p) };
        let border = |v: DVec2| v / v.x.abs().max(v.y.abs());
        let (from, to) = (square_swept(p), square_swept(q));
        let to = if to < from { to + 4.0 } else { to };
        let corners = (1..8)
            .filter(|k| f64::from(*k) > from && f64::from(*k) < to)
            .map(|k| DVec2::from(CORNERS[k as usize % 4]));
        let ends = [p, border(p)].into_iter().chain(corners);
        ends.chain([border(q), q]).collect()
    }

    /// What is not negative of a convex polygon.
    fn clip(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
        let mut out = Vec::new();
        for (k, &a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            let (fa, fb) = (inside(a), inside(b));
            if fa >= 0.0 {
                out.push(a);
            }
            if (fa < 0.0) != (fb < 0.0) {
                out.push(a + (b - a) * (fa / (fa - fb)));
            }
        }
        out
    }

    fn area(polygon: &[DVec2]) -> f64 {
        let n = polygon.len();
        let twice: f64 = (0..n)
            .map(|k| polygon[k].perp_dot(polygon[(k + 1) % n]))
            .sum();
        (0.5 * twice).max(0.0)
    }
}
