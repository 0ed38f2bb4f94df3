//! Cube faces (texture rules, §4).

use std::ops::Neg;

/// The table: a vector along a face's s and t, and outwards.
fn along<T: Neg<Output = T>>(face: usize, [x, y, z]: [T; 3]) -> [T; 3] {
    match face {
        0 => [-z, -y, x],
        1 => [z, -y, -x],
        2 => [x, z, y],
        3 => [x, -z, -y],
        4 => [x, -y, z],
        _ => [-x, -y, -z],
    }
}

/// The face that a direction meets.
pub(super) fn face_of(d: [f32; 3]) -> usize {
    let [x, y, z] = d.map(f32::abs);
    let axis = if z >= x && z >= y {
        2
    } else if y >= x {
        1
    } else {
        0
    };
    2 * axis + usize::from(d[axis] < 0.0)
}

/// Coordinates on a face.
pub(super) fn coordinate(face: usize, d: [f32; 3]) -> [f32; 3] {
    let [s, t, m] = along(face, d);
    [(s / m) * 0.5 + 0.5, (t / m) * 0.5 + 0.5, 0.0]
}

/// How they change where the direction changes by `by`.
pub(super) fn change(face: usize, d: [f32; 3], by: [f32; 3]) -> [f32; 3] {
    let ([s, t, m], [ds, dt, dm]) = (along(face, d), along(face, by));
    let of = |s: f32, ds: f32| ((m * ds - s * dm) / (m * m)) * 0.5;
    [of(s, ds), of(t, dt), 0.0]
}

/// The face and texel that texel `at` of a face of `n` texels a side stands
/// for; indices are -1..=n.
///
/// Found in the cube -n..=n, where texels have side 2: the middle of the edge
/// that the texel shares with its neighbour lies on both their faces.
pub(super) fn fold(face: usize, at: [i64; 2], n: i64) -> (usize, [i64; 2]) {
    let outside = at.map(|i| i < 0 || i >= n);
    if outside == [false, false] {
        return (face, at);
    }
    if outside == [true, true] {
        return (face, at.map(|i| i.clamp(0, n - 1)));
    }
    let on_face = at.map(|i| (2 * i + 1 - n).clamp(-n, n));
    let point = in_space(face, [on_face[0], on_face[1], n]);
    let meets = |k: &usize| *k != face / 2 && point[*k].abs() == n;
    let axis = (0..3)
        .find(meets)
        .expect("a texel beyond an edge touches another face");
    let other = 2 * axis + usize::from(point[axis] < 0);
    let [s, t, _] = along(other, point);
    (other, [s, t].map(|v| ((v + n) / 2).clamp(0, n - 1)))
}

/// The vector that has the given components along a face.
fn in_space(face: usize, local: [i64; 3]) -> [i64; 3] {
    std::array::from_fn(|k| {
        let unit = std::array::from_fn(|c| i64::from(c == k));
        let axes = along(face, unit);
        (0..3).map(|c| local[c] * axes[c]).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Crossing an edge and coming back gives the texel that was left.
    #[test]
    fn folding_is_mutual() {
        for n in [1, 2, 5] {
            for face in 0..6 {
                for k in 0..n {
                    for (out, own) in [
                        ([-1, k], [0, k]),
                        ([n, k], [n - 1, k]),
                        ([k, -1], [k, 0]),
                        ([k, n], [k, n - 1]),
                    ] {
                        let (f, [x, y]) = fold(face, out, n);
                        assert!(f / 2 != face / 2, "an opposite face");
                        let steps = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
                        let back = steps.map(|s| fold(f, s, n));
                        assert!(back.contains(&(face, own)), "{face} {out:?} of {n}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_face_s_coordinates_point_back_to_it() {
        for face in 0..6 {
            let d = in_space(face, [1, -2, 4]).map(|v| v as f32);
            assert_eq!(face_of(d), face);
            assert_eq!(coordinate(face, d), [0.625, 0.25, 0.0]);
        }
    }
}
