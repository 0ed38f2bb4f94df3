//! Which pixels a triangle covers (rules, §3.5 and §4).

use gnomon_raster::state::{ScissorRect, Viewport};

use super::plane::Plane;
use super::setup::{Triangle, doubled_area};

/// Whether the centre of pixel (i, j) belongs to the triangle with snapped corners.
pub(super) fn covers(xy: [[i64; 2]; 3], i: u32, j: u32) -> bool {
    let sign = doubled_area(xy).signum();
    let (px, py) = (256 * i64::from(i) + 128, 256 * i64::from(j) + 128);
    sign != 0
        && (0..3).all(|k| {
            let (a, b) = (xy[k], xy[(k + 1) % 3]);
            let (dx, dy) = (sign * (b[0] - a[0]), sign * (b[1] - a[1]));
            let e = dx * (py - a[1]) - dy * (px - a[0]);
            let owns = dy < 0 || (dy == 0 && dx > 0);
            e > 0 || (e == 0 && owns)
        })
}

/// Pixels of a `width`×`height` image that a triangle with snapped corners
/// covers, row by row.
#[must_use]
pub fn covered_pixels(xy: [[i64; 2]; 3], width: u32, height: u32) -> Vec<bool> {
    (0..height)
        .flat_map(|j| (0..width).map(move |i| covers(xy, i, j)))
        .collect()
}

/// Half-open pixel rectangle of a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawRect {
    x: [f64; 2],
    y: [f64; 2],
}

impl DrawRect {
    pub(super) fn new([w, h]: [u32; 2], viewport: &Viewport, scissor: Option<ScissorRect>) -> Self {
        let s = scissor.unwrap_or(ScissorRect {
            x: 0,
            y: 0,
            width: w,
            height: h,
        });
        let span = |from: f32, size: f32, s0: u32, s1: u32, limit: u32| {
            let first = (f64::from(from) - 0.5).ceil();
            let end = (f64::from(from + size) - 0.5).ceil();
            let scissor_end = f64::from(s0) + f64::from(s1);
            [
                first.max(f64::from(s0)).max(0.0),
                end.min(scissor_end).min(f64::from(limit)),
            ]
        };
        Self {
            x: span(viewport.x, viewport.width, s.x, s.width, w),
            y: span(viewport.y, viewport.height, s.y, s.height, h),
        }
    }

    pub(super) fn contains(&self, i: u32, j: u32) -> bool {
        let inside = |[a, b]: [f64; 2], v: u32| a <= f64::from(v) && f64::from(v) < b;
        inside(self.x, i) && inside(self.y, j)
    }
}

/// User clip planes over a triangle.
pub(super) struct ClipPlanes(Vec<Plane>);

impl ClipPlanes {
    pub(super) fn new(t: &Triangle, planes: &[[f32; 4]]) -> Self {
        let distance = |p: &[f32; 4], k: usize| {
            let corner = &t.corners[k];
            let [x, y, z, w] = corner.vertex.position;
            (((p[0] * x + p[1] * y) + p[2] * z) + p[3] * w) * corner.inverse_w
        };
        Self(
            planes
                .iter()
                .map(|p| Plane::through(t.xy(), [0, 1, 2].map(|k| distance(p, k))))
                .collect(),
        )
    }

    pub(super) fn keep(&self, i: u32, j: u32) -> bool {
        self.0.iter().all(|p| p.at(i, j) >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(a: i64, b: i64) -> [[[i64; 2]; 3]; 2] {
        [[[a, a], [b, a], [b, b]], [[a, a], [b, b], [a, b]]]
    }

    #[test]
    fn corners_on_centres_belong_to_the_top_and_left_edges() {
        // From the centre of pixel 1 to the centre of pixel 3: pixels 1 and 2.
        let halves = square(256 + 128, 3 * 256 + 128);
        let covered: Vec<_> = (0..25u32)
            .filter(|p| halves.iter().any(|&t| covers(t, p % 5, p / 5)))
            .map(|p| (p % 5, p / 5))
            .collect();
        assert_eq!(covered, [(1, 1), (2, 1), (1, 2), (2, 2)]);
        assert!((0..25).all(|p| !halves.iter().all(|&t| covers(t, p % 5, p / 5))));
    }

    #[test]
    fn winding_does_not_matter() {
        let [t, _] = square(100, 1000);
        let flipped = [t[0], t[2], t[1]];
        assert_eq!(covered_pixels(t, 6, 6), covered_pixels(flipped, 6, 6));
    }

    #[test]
    fn the_viewport_takes_pixels_whose_centres_it_holds() {
        let v = Viewport {
            x: 0.5,
            y: -3.0,
            width: 2.0,
            height: 4.75,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let r = DrawRect::new([10, 10], &v, None);
        assert_eq!(
            r,
            DrawRect {
                x: [0.0, 2.0],
                y: [0.0, 2.0]
            }
        );
    }
}
