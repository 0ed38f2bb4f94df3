//! Which pixels of an image a wedge may cover.

use glam::DVec4;

use super::volume::Triangle;
use crate::parts::passes::View;

/// Beyond the image's edges, in shares of it: what lies there may round into it.
const MARGIN: f64 = 1e-3;

/// Least and greatest column and row, both inclusive, of pixels that the triangles may
/// cover in an image of `size`; `None` where they miss it. Conservative by a pixel.
pub(crate) fn pixels(view: &View, triangles: &[Triangle], size: [u32; 2]) -> Option<[[u32; 2]; 2]> {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for triangle in triangles {
        let mut polygon: Vec<DVec4> = triangle.iter().map(|v| clip_space(view, v)).collect();
        for plane in sides() {
            polygon = clipped(&polygon, plane);
        }
        for v in &polygon {
            for k in 0..2 {
                // The eye itself, in all directions.
                let at = if v.w > 0.0 { v[k] / v.w } else { f64::NAN };
                let [low, high] = &mut range[k];
                let all = at.is_nan();
                *low = if all { -1.0 } else { low.min(at) };
                *high = if all { 1.0 } else { high.max(at) };
            }
        }
    }
    let [x, y] = range;
    let columns = inclusive(x, size[0])?;
    let rows = inclusive([-y[1], -y[0]], size[1])?;
    Some([columns, rows])
}

fn clip_space(view: &View, vertex: &DVec4) -> DVec4 {
    let p = if vertex.w == 0.0 {
        vertex.truncate()
    } else {
        view.relative(vertex.truncate())
    };
    let p = p.extend(vertex.w);
    let row = |r: usize| DVec4::from_array(view.clip_from_world.0[r].map(f64::from)).dot(p);
    DVec4::new(row(0), row(1), row(2), row(3))
}

/// The sides of the view's pyramid, a little wider, positive inside.
fn sides() -> [DVec4; 4] {
    let w = 1.0 + MARGIN;
    [
        DVec4::new(1.0, 0.0, 0.0, w),
        DVec4::new(-1.0, 0.0, 0.0, w),
        DVec4::new(0.0, 1.0, 0.0, w),
        DVec4::new(0.0, -1.0, 0.0, w),
    ]
}

/// The part of a convex polygon on the positive side of a plane through the eye.
fn clipped(polygon: &[DVec4], plane: DVec4) -> Vec<DVec4> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (k, v) in polygon.iter().enumerate() {
        let next = &polygon[(k + 1) % polygon.len()];
        let (d, e) = (plane.dot(*v), plane.dot(*next));
        if d >= 0.0 {
            out.push(*v);
        }
        if (d < 0.0) != (e < 0.0) {
            out.push(*v + (*next - *v) * (d / (d - e)));
        }
    }
    out
}

/// Pixels under a range of normalised device coordinates.
fn inclusive([low, high]: [f64; 2], size: u32) -> Option<[u32; 2]> {
    let scale = 0.5 * f64::from(size);
    let first = ((low + 1.0) * scale - 1.0).floor().max(0.0);
    let last = ((high + 1.0) * scale + 1.0)
        .floor()
        .min(f64::from(size) - 1.0);
    (first <= last).then_some([first as u32, last as u32])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::Camera;

    const SIZE: [u32; 2] = [64, 48];

    fn view() -> View {
        View::new(&Camera::look_at([0.0, 0.0, 5.0], [0.0; 3]), SIZE)
    }

    fn at(x: f64, y: f64, z: f64) -> DVec4 {
        DVec4::new(x, y, z, 1.0)
    }

    #[test]
    fn a_small_triangle_in_the_middle_covers_little_there() {
        let small = [at(0.0, 0.0, 0.0), at(0.1, 0.0, 0.0), at(0.0, 0.1, 0.0)];
        let [[x0, x1], [y0, y1]] = pixels(&view(), &[small], SIZE).unwrap();
        assert!((29..=32).contains(&x0) && x1 - x0 <= 5, "{x0} {x1}");
        assert!((20..=24).contains(&y0) && y1 - y0 <= 5, "{y0} {y1}");
    }

    #[test]
    fn what_is_behind_the_eye_or_beside_the_image_covers_nothing() {
        let behind = [at(0.0, 0.0, 9.0), at(0.1, 0.0, 9.0), at(0.0, 0.1, 9.0)];
        assert_eq!(pixels(&view(), &[behind], SIZE), None);
        let beside = [at(50.0, 0.0, 0.0), at(51.0, 0.0, 0.0), at(50.0, 1.0, 0.0)];
        assert_eq!(pixels(&view(), &[beside], SIZE), None);
    }

    /// A direction past the eye: the triangle passes through its plane, and covers all to
    /// one side.
    #[test]
    fn a_triangle_that_passes_the_eye_reaches_the_edge() {
        let past = [
            at(0.5, 0.0, 0.0),
            at(0.5, 0.5, 0.0),
            DVec4::new(0.3, 0.0, 1.0, 0.0),
        ];
        let [[x0, x1], _] = pixels(&view(), &[past], SIZE).unwrap();
        assert!(x0 > 30 && x1 == SIZE[0] - 1, "{x0} {x1}");
    }

    #[test]
    fn all_round_the_eye_is_everything() {
        let e = 0.01;
        let c = [
            at(e, e, 5.0 + e),
            at(-e, -e, 5.0 + e),
            at(-e, e, 5.0 - e),
            at(e, -e, 5.0 - e),
        ];
        let round = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|t| t.map(|i: usize| c[i]));
        let all = [[0, SIZE[0] - 1], [0, SIZE[1] - 1]];
        assert_eq!(pixels(&view(), &round, SIZE), Some(all));
    }
}
