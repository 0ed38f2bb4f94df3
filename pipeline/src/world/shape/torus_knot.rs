//! Closed tubes round torus knots.

use glam::DVec3;

use super::{Shape, on_circle, step_angle};

/// A tube of radius `tube` round the (p,q) torus knot, swept with its Frenet
/// frame: `along * around` vertices, twice as many triangles.
#[expect(
    clippy::too_many_arguments,
    reason = "the peers' signature, argument for argument"
)]
pub fn torus_knot(
    p: u32,
    q: u32,
    ring: f64,
    minor: f64,
    tube: f64,
    along: u32,
    around: u32,
    centre: DVec3,
) -> Shape {
    let mut positions = Vec::with_capacity((along * around) as usize);
    for i in 0..along {
        let frame = Frame::at(
            f64::from(p),
            f64::from(q),
            ring,
            minor,
            step_angle(i, along),
        );
        for j in 0..around {
            let (cos, sin) = on_circle(step_angle(j, around));
            let offset = (frame.normal * cos + frame.binormal * sin) * tube;
            positions.push(centre + frame.centre + offset);
        }
    }
    Shape {
        positions,
        triangles: tube_triangles(along, around),
    }
}

/// Point of the knot with its Frenet frame.
struct Frame {
    centre: DVec3,
    normal: DVec3,
    binormal: DVec3,
}

impl Frame {
    fn at(p: f64, q: f64, ring: f64, minor: f64, u: f64) -> Self {
        let ((cp, sp), (cq, sq)) = (on_circle(p * u), on_circle(q * u));
        let w = ring + minor * cq;
        let w1 = -minor * q * sq; // dw/du
        let w2 = -minor * q * q * cq; // d2w/du2
        let centre = DVec3::new(w * cp, minor * sq, w * sp);
        let first = DVec3::new(w1 * cp - w * p * sp, minor * q * cq, w1 * sp + w * p * cp);
        let second = DVec3::new(
            w2 * cp - 2.0 * w1 * p * sp - w * p * p * cp,
            -minor * q * q * sq,
            w2 * sp + 2.0 * w1 * p * cp - w * p * p * sp,
        );
        let tangent = first / first.length();
        let turn = first.cross(second);
        let binormal = turn / turn.length();
        Self {
            centre,
            normal: binormal.cross(tangent),
            binormal,
        }
    }
}

fn tube_triangles(along: u32, around: u32) -> Vec<[u32; 3]> {
    let vertex = |i: u32, j: u32| (i % along) * around + j % around;
    (0..along)
        .flat_map(|i| (0..around).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b] = [vertex(i, j), vertex(i, j + 1)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i + 1, j)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}
