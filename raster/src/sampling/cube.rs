//! Cube maps: from a direction to a face, and over the edges of faces
//! (`docs/texture-rules.md`, §4; the orientation is Vulkan's, §16.5.4).

use crate::simd::{F32, I32, Lanes, Mask};

/// The face that a direction meets.
#[derive(Clone, Copy)]
pub(super) struct Face<L: Lanes> {
    /// 0..6: +x, −x, +y, −y, +z, −z.
    pub(super) number: I32<L>,
    /// The direction's x, y; z is largest.
    major: [Mask<L>; 2],
    negative: Mask<L>,
}

impl<L: Lanes> Face<L> {
    /// The axis of the largest component; of equal ones z before y before x.
    #[inline(always)]
    pub(super) fn of([x, y, z]: [F32<L>; 3]) -> Self {
        let l = x.lanes();
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let is_z = az.ge(ax) & az.ge(ay);
        let is_y = !is_z & ay.ge(ax);
        let is_x = !is_z & !is_y;
        let along = is_x.select_f32(x, is_y.select_f32(y, z));
        let negative = along.lt(F32::splat(l, 0.0));
        let axis = is_x.select_i32(
            I32::splat(l, 0),
            is_y.select_i32(I32::splat(l, 2), I32::splat(l, 4)),
        );
        let number = axis + negative.select_i32(I32::splat(l, 1), I32::splat(l, 0));
        Self {
            number,
            major: [is_x, is_y],
            negative,
        }
    }

    /// A vector along the face's s, t and outward axes.
    #[inline(always)]
    fn turned(&self, [x, y, z]: [F32<L>; 3]) -> [F32<L>; 3] {
        let [is_x, is_y] = self.major;
        let n = self.negative;
        let s = is_x.select_f32(n.select_f32(z, -z), is_y.select_f32(x, n.select_f32(-x, x)));
        let t = is_y.select_f32(n.select_f32(-z, z), -y);
        let m = is_x.select_f32(x, is_y.select_f32(y, z));
        [s, t, n.select_f32(-m, m)]
    }

    /// Normalised coordinates on the face.
    #[inline(always)]
    pub(super) fn coordinate(&self, direction: [F32<L>; 3]) -> [F32<L>; 3] {
        let [s, t, m] = self.turned(direction);
        [
            (s / m) * 0.5 + 0.5,
            (t / m) * 0.5 + 0.5,
            F32::splat(m.lanes(), 0.0),
        ]
    }

    /// How the face coordinates change where the direction changes by `by`.
    #[inline(always)]
    pub(super) fn gradient(&self, direction: [F32<L>; 3], by: [F32<L>; 3]) -> [F32<L>; 3] {
        let [s, t, m] = self.turned(direction);
        let [ds, dt, dm] = self.turned(by);
        let square = m * m;
        [
            ((m * ds - s * dm) / square) * 0.5,
            ((m * dt - t * dm) / square) * 0.5,
            F32::splat(m.lanes(), 0.0),
        ]
    }
}

/// The axes of a face: (component, sign) of s, t and outwards.
const AXES: [[(usize, i32); 3]; 6] = [
    [(2, -1), (1, -1), (0, 1)],
    [(2, 1), (1, -1), (0, -1)],
    [(0, 1), (2, 1), (1, 1)],
    [(0, 1), (2, -1), (1, -1)],
    [(0, 1), (1, -1), (2, 1)],
    [(0, -1), (1, -1), (2, -1)],
];

/// The texel (i, j) of a face, each in −1..=n. Beyond one edge it is the texel of
/// the neighbouring face that touches there; beyond two, where no texel is, the
/// face's own corner.
pub(super) fn fold(face: usize, i: i32, j: i32, n: i32) -> (usize, i32, i32) {
    let out = |v: i32| v < 0 || v >= n;
    let [s, t, outward] = AXES[face];
    let (over, along) = match (out(i), out(j)) {
        (false, false) => return (face, i, j),
        (true, true) => return (face, i.clamp(0, n - 1), j.clamp(0, n - 1)),
        (true, false) => ((s, i), (t, j)),
        (false, true) => ((t, j), (s, i)),
    };
    // Twice the position in the cube −n..n of the texel that touches the edge.
    let mut point = [0; 3];
    let side = if over.1 < 0 { -over.0.1 } else { over.0.1 };
    point[over.0.0] = side * n;
    point[along.0.0] = along.0.1 * (2 * along.1 + 1 - n);
    point[outward.0] = outward.1 * (n - 1);
    let face = 2 * over.0.0 + usize::from(side < 0);
    let [s, t, _] = AXES[face];
    let texel = |(component, sign): (usize, i32)| (sign * point[component] + n - 1) / 2;
    (face, texel(s), texel(t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{LANES, SimdLevel, with_lanes};

    fn face_of(d: [f32; 3]) -> i32 {
        with_lanes!(SimdLevel::scalar(), l => Face::of(d.map(|v| F32::splat(l, v))).number.to_array()[0])
    }

    #[test]
    fn faces_of_axes_ties_and_nonsense() {
        let axes = [
            [1., 0., 0.],
            [-1., 0., 0.],
            [0., 1., 0.],
            [0., -1., 0.],
            [0., 0., 1.],
            [0., 0., -1.],
        ];
        for (n, d) in axes.into_iter().enumerate() {
            assert_eq!(face_of(d), n as i32);
        }
        assert_eq!(face_of([1.0, 1.0, 1.0]), 4);
        assert_eq!(face_of([1.0, -1.0, 0.5]), 3);
        assert_eq!(face_of([0.0; 3]), 4);
        assert!((0..6).contains(&face_of([f32::NAN; 3])));
    }

    #[test]
    fn axes_agree_with_the_coordinates_of_faces() {
        for (face, [s, t, outward]) in AXES.into_iter().enumerate() {
            let mut d = [0.0; 3];
            d[s.0] = s.1 as f32 * 0.5;
            d[t.0] = t.1 as f32 * -0.25;
            d[outward.0] = outward.1 as f32;
            let c = with_lanes!(SimdLevel::scalar(), l => {
                let d = d.map(|v| F32::splat(l, v));
                let f = Face::of(d);
                (f.number.to_array()[0], f.coordinate(d).map(|v| v.to_array()[LANES - 1]))
            });
            assert_eq!(c, (face as i32, [0.75, 0.375, 0.0]));
        }
    }

    #[test]
    fn folding_is_mutual_and_lands_on_an_edge() {
        let n = 5;
        for face in 0..6 {
            for k in 0..n {
                for (i, j, back) in [
                    (-1, k, (0, k)),
                    (n, k, (n - 1, k)),
                    (k, -1, (k, 0)),
                    (k, n, (k, n - 1)),
                ] {
                    let (f, x, y) = fold(face, i, j, n);
                    assert!(f != face && (0..n).contains(&x) && (0..n).contains(&y));
                    let edge = |v: i32| v == 0 || v == n - 1;
                    assert!(edge(x) || edge(y));
                    // One of the neighbour's outward steps leads back.
                    let steps = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                    let returns = steps.map(|(x, y)| fold(f, x, y, n));
                    assert!(returns.contains(&(face, back.0, back.1)), "{face} {i} {j}");
                }
            }
        }
    }
}
