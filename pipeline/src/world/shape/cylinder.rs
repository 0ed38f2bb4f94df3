//! Capped cylinders about the y axis.

use glam::DVec3;

use super::{Shape, on_circle, step_angle};

/// A cylinder of `segments` sides from height `y0` to `y1`: rings at y0 and
/// y1, then the two centres; sides, bottom, top.
pub fn cylinder(segments: u32, radius: f64, y0: f64, y1: f64) -> Shape {
    let n = segments;
    let ring = |y: f64| {
        (0..n).map(move |k| {
            let (cos, sin) = on_circle(step_angle(k, n));
            DVec3::new(radius * cos, y, radius * sin)
        })
    };
    let centres = [DVec3::new(0.0, y0, 0.0), DVec3::new(0.0, y1, 0.0)];
    let next = |k: u32| (k + 1) % n;
    let sides = (0..n).flat_map(|k| [[k, n + k, n + next(k)], [k, n + next(k), next(k)]]);
    let bottom = (0..n).map(|k| [2 * n, k, next(k)]);
    let top = (0..n).map(|k| [2 * n + 1, n + next(k), n + k]);
    Shape {
        positions: ring(y0).chain(ring(y1)).chain(centres).collect(),
        triangles: sides.chain(bottom).chain(top).collect(),
    }
}
