//! Clipping to, and sectors of, the square -1..1.

use glam::{DVec2, DVec3};

/// Parameters of the part of the homogeneous segment with `|x| <= w, |y| <= w`.
pub(super) fn clip(a: DVec3, b: DVec3) -> Option<[f64; 2]> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (fa, fb) in [
        (a.z - a.x, b.z - b.x),
        (a.z + a.x, b.z + b.x),
        (a.z - a.y, b.z - b.y),
        (a.z + a.y, b.z + b.y),
    ] {
        match (fa < 0.0, fb < 0.0) {
            (true, true) => return None,
            (true, false) => from = from.max(fa / (fa - fb)),
            (false, true) => to = to.min(fa / (fa - fb)),
            (false, false) => {}
        }
    }
    (from < to).then_some([from, to])
}

/// Area of the square between the rays from the centre through p and q, on the
/// side where they are less than half a turn apart. No trigonometry: along a side
/// of the square the area grows linearly, as half the tangent.
pub(super) fn sector(p: DVec2, q: DVec2) -> f64 {
    let turn = p.perp_dot(q);
    let ahead = if turn < 0.0 {
        swept(p) - swept(q)
    } else {
        swept(q) - swept(p)
    };
    if ahead < 0.0 { ahead + 4.0 } else { ahead }
}

/// Area swept counter-clockwise from the direction (1, -1) to that of p, 0 to 4.
pub(super) fn swept(p: DVec2) -> f64 {
    if p.x.abs() >= p.y.abs() {
        let along = if p.x == 0.0 { 0.0 } else { p.y / p.x };
        let sides = if p.x >= 0.0 { 0.5 } else { 2.5 };
        sides + 0.5 * along
    } else {
        let sides = if p.y >= 0.0 { 1.5 } else { 3.5 };
        sides - 0.5 * (p.x / p.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_and_halves() {
        let v = DVec2::new;
        assert_eq!(sector(v(1.0, 0.0), v(0.0, 0.3)), 1.0);
        assert_eq!(sector(v(0.0, 0.3), v(1.0, 0.0)), 1.0);
        assert_eq!(sector(v(1.0, -1.0), v(-0.5, -0.5)), 1.0);
        assert_eq!(sector(v(0.2, 0.1), v(-0.2, -0.1)), 2.0);
        assert_eq!(sector(v(0.7, -0.1), v(0.7, -0.1)), 0.0);
    }

    #[test]
    fn segments_behind_the_receiver_are_left_out() {
        assert_eq!(
            clip(DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.1, 0.0, -2.0)),
            None
        );
        let [from, to] = clip(DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.0)).unwrap();
        assert_eq!([from, to], [0.5, 1.0]);
        assert_eq!(
            clip(DVec3::ZERO, DVec3::ZERO).map(|[a, b]| a < b),
            Some(true)
        );
    }
}
