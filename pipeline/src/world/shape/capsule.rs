//! Capsules: limbs with round ends, possibly tapering.

use glam::DVec3;

use super::{Shape, on_circle, step_angle};

/// A closed limb from `from` (radius `r0`) to `to` (radius `r1`) with
/// half-sphere ends: `segments` sides round, `rings` rings per end. The
/// distance of the end points must not be zero.
pub fn capsule(from: DVec3, to: DVec3, r0: f64, r1: f64, segments: u32, rings: u32) -> Shape {
    let axis = (to - from) / (to - from).length();
    let (u, v) = perpendicular(axis);
    let mut positions = vec![from - axis * r0];
    for (along, radius) in profile(rings, (to - from).length(), r0, r1) {
        for k in 0..segments {
            let (cos, sin) = on_circle(step_angle(k, segments));
            positions.push(from + axis * along + (u * cos + v * sin) * radius);
        }
    }
    positions.push(to + axis * r1);
    Shape {
        triangles: triangles(segments, 2 * rings),
        positions,
    }
}

/// `(distance along the axis, radius)` of each ring, from the first pole on.
fn profile(rings: u32, length: f64, r0: f64, r1: f64) -> Vec<(f64, f64)> {
    let angle = |k: u32| std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(rings);
    let first = (1..=rings).map(|k| {
        let (cos, sin) = on_circle(angle(k));
        (-r0 * cos, r0 * sin)
    });
    let second = (1..=rings).rev().map(|k| {
        let (cos, sin) = on_circle(angle(k));
        (length + r1 * cos, r1 * sin)
    });
    first.chain(second).collect()
}

/// Two unit vectors with `u x v = axis`, from the world axis least aligned.
fn perpendicular(axis: DVec3) -> (DVec3, DVec3) {
    let helper = if axis.y.abs() < 0.9 {
        DVec3::Y
    } else {
        DVec3::X
    };
    let u = helper.cross(axis);
    let u = u / u.length();
    (u, axis.cross(u))
}

fn triangles(segments: u32, rings: u32) -> Vec<[u32; 3]> {
    let vertex = |ring: u32, k: u32| 1 + ring * segments + k % segments;
    let last = 1 + rings * segments;
    let mut out = Vec::new();
    for k in 0..segments {
        out.push([0, vertex(0, k + 1), vertex(0, k)]);
    }
    for ring in 1..rings {
        for k in 0..segments {
            let [a, b] = [vertex(ring - 1, k), vertex(ring - 1, k + 1)];
            let [c, d] = [vertex(ring, k + 1), vertex(ring, k)];
            out.extend([[a, b, c], [a, c, d]]);
        }
    }
    for k in 0..segments {
        out.push([last, vertex(rings - 1, k), vertex(rings - 1, k + 1)]);
    }
    out
}
