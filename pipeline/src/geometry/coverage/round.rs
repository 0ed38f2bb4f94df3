//! Clipping to, and sectors of, the unit disc.

use glam::{DVec2, DVec3};

/// Parameters of the part of the homogeneous segment with
/// `x^2 + y^2 <= w^2, w >= 0`: a convex cone, so one interval.
pub(super) fn clip(a: DVec3, b: DVec3) -> Option<[f64; 2]> {
    let form = |p: DVec3, q: DVec3| p.x * q.x + p.y * q.y - p.z * q.z;
    let d = b - a;
    let roots = roots(form(d, d), form(a, d), form(a, a));
    let mut cuts = vec![0.0];
    cuts.extend(roots.into_iter().filter(|t| *t > 0.0 && *t < 1.0));
    cuts.push(1.0);
    let inside = |[from, to]: &[f64; 2]| {
        let middle = a + d * (0.5 * (from + to));
        from < to && middle.z >= 0.0 && form(middle, middle) <= 0.0
    };
    let pieces = cuts.windows(2).map(|w| [w[0], w[1]]).filter(inside);
    // Neighbouring pieces only where the segment touches the cone.
    pieces.reduce(|first, last| [first[0], last[1]])
}

/// Real roots of `a t^2 + 2 b t + c`, rising, by the formula that cancels no
/// digits; a leading term of zero leaves the linear root.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 || discriminant.is_nan() {
        return Vec::new();
    }
    let root = discriminant.sqrt();
    let q = if b < 0.0 { root - b } else { -b - root };
    let mut roots: Vec<f64> = [q / a, c / q]
        .into_iter()
        .filter(|t| t.is_finite())
        .collect();
    roots.sort_by(f64::total_cmp);
    roots
}

/// Area of the disc between the rays through p and q, less than half a turn.
pub(super) fn sector(p: DVec2, q: DVec2) -> f64 {
    // No difference of two arctangents, so no cut where they jump.
    0.5 * libm::atan2(p.perp_dot(q).abs(), p.dot(q))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_are_found_in_all_degenerate_forms() {
        let v = DVec3::new;
        // Across the disc.
        let [from, to] = clip(v(-2.0, 0.0, 1.0), v(2.0, 0.0, 1.0)).unwrap();
        assert!((from - 0.25).abs() < 1e-15 && (to - 0.75).abs() < 1e-15);
        // Parallel to a generator of the cone: the leading term vanishes.
        let [from, to] = clip(v(-1.0, 0.0, 0.0), v(1.0, 0.0, 2.0)).unwrap();
        assert!((from - 0.25).abs() < 1e-15 && to == 1.0, "{from} {to}");
        // Behind the receiver, beside the disc, and nothing at all.
        assert_eq!(clip(v(-2.0, 0.0, -1.0), v(2.0, 0.0, -1.0)), None);
        assert_eq!(clip(v(-2.0, 1.5, 1.0), v(2.0, 1.5, 1.0)), None);
        assert!(clip(DVec3::ZERO, DVec3::ZERO).is_some());
    }

    #[test]
    fn sectors_across_the_cut_of_the_arctangent() {
        let (p, q) = (DVec2::new(-1.0, 0.01), DVec2::new(-1.0, -0.01));
        assert!((sector(p, q) - libm::atan(0.01)).abs() < 1e-16);
        assert_eq!(sector(DVec2::ZERO, DVec2::ZERO), 0.0);
    }
}
