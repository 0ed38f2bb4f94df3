//! Area of a polygon inside the unit disc, in closed form.

use std::f64::consts::PI;

type Point = [f64; 2];

/// Area of the unit disc.
pub(super) const UNIT_DISC: f64 = PI;

/// Area of the part of a counter-clockwise polygon that lies in the unit disc
/// about the origin: the sum over edges of the signed area between the edge and
/// the origin, bounded by chords inside the circle and by arcs outside.
pub(super) fn area_in_disc(polygon: &[Point]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .map(|(a, b)| under_edge(*a, *b))
        .sum()
}

/// Whether an edge has the whole disc on its outer side; then the polygon
/// misses the disc. For polygons of about the disc's size.
pub(super) fn misses_disc(polygon: &[Point]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).any(|(a, b)| {
        let along = sub(*b, *a);
        // The origin's distance to the right of a -> b, times the edge's length;
        // edges so short that rounding turns them decide nothing.
        let right = -cross(*a, *b);
        right >= dot(along, along).sqrt() + 1e-15
    })
}

/// Signed area of the triangle (origin, a, b) inside the disc.
fn under_edge(a: Point, b: Point) -> f64 {
    let along = sub(b, a);
    let (length2, height) = (dot(along, along), cross(a, b));
    let inside = length2 - height * height; // (half chord * length)^2
    if inside <= 0.0 {
        return sector(a, b);
    }
    let (middle, half) = (-dot(a, along), inside.sqrt());
    let (enter, leave) = ((middle - half) / length2, (middle + half) / length2);
    if enter >= 1.0 || leave <= 0.0 {
        return sector(a, b);
    }
    let at = |t: f64| [a[0] + along[0] * t, a[1] + along[1] * t];
    let (before, p) = if enter > 0.0 {
        (sector(a, at(enter)), at(enter))
    } else {
        (0.0, a)
    };
    let (after, q) = if leave < 1.0 {
        (sector(at(leave), b), at(leave))
    } else {
        (0.0, b)
    };
    before + 0.5 * cross(p, q) + after
}

/// Signed area of the unit disc's sector from the direction of `a` to that of `b`.
fn sector(a: Point, b: Point) -> f64 {
    0.5 * libm::atan2(cross(a, b), dot(a, b))
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: Point, high: Point) -> [Point; 4] {
        [low, [high[0], low[1]], high, [low[0], high[1]]]
    }

    /// The disc's part right of x = d.
    fn segment(d: f64) -> f64 {
        libm::acos(d) - d * (1.0 - d * d).sqrt()
    }

    #[test]
    fn known_areas() {
        let close = |polygon: &[Point], expected: f64| {
            let area = area_in_disc(polygon);
            assert!((area - expected).abs() < 1e-15 * 8.0, "{area} {expected}");
        };
        close(&square([-1.0, -1.0], [1.0, 1.0]), PI);
        close(&square([-9.0, -9.0], [9.0, 9.0]), PI);
        close(&square([-0.5, -0.5], [0.5, 0.5]), 1.0);
        close(&square([0.0, 0.0], [2.0, 2.0]), PI / 4.0);
        close(&square([-3.0, -3.0], [-1.5, 3.0]), 0.0);
        for d in [-0.999, -0.3, 0.0, 1e-9, 0.4, 0.99999] {
            close(&square([d, -4.0], [4.0, 4.0]), segment(d));
        }
        // A chord between arcs: two segments taken off a disc.
        close(
            &square([-0.2, -7.0], [0.6, 7.0]),
            segment(-0.2) - segment(0.6),
        );
    }

    /// Any cut through a polygon splits its area.
    #[test]
    fn cutting_preserves_area() {
        let whole = square([-0.8, -1.4], [1.3, 0.7]);
        for k in 0..40 {
            let x = -0.8 + 2.1 * (f64::from(k) + 0.5) / 40.0;
            let left = square([-0.8, -1.4], [x, 0.7]);
            let right = square([x, -1.4], [1.3, 0.7]);
            let sum = area_in_disc(&left) + area_in_disc(&right);
            assert!((sum - area_in_disc(&whole)).abs() < 1e-14);
        }
    }

    #[test]
    fn only_polygons_outside_miss() {
        assert!(misses_disc(&square([1.001, -1.0], [2.0, 1.0])));
        assert!(misses_disc(&[[2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]));
        assert!(!misses_disc(&square([0.9999, -1.0], [2.0, 1.0])));
        assert!(!misses_disc(&square([-9.0, -9.0], [9.0, 9.0])));
        // A corner that rounding doubled, the doubles in the wrong order.
        let doubled = [
            [0.1 - 1e-17, 0.7],
            [0.1, 0.7 + 1e-16],
            [-0.9, 0.3],
            [0.0, -0.8],
        ];
        assert!(!misses_disc(&doubled));
    }
}
