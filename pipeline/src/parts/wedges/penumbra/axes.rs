//! Separating axes between a wedge and a box of screen space, beyond the wedge's
//! own planes (paper II, §4: the full separating-axis test).
//!
//! An axis of an edge of the box and one of the wedge is a plane through the
//! wedge's edge and parallel to the box's: of two of the wedge's planes, the
//! non-negative combination in which that coordinate cancels. So these planes
//! hold the whole wedge, wherever it is clipped. The box's own axes across the
//! image need no test, since only tiles under the wedge are drawn; depth does, by
//! the wedge's range of it: the paper's quick rejection test.

use glam::DVec4;
use gnomon_shaders::penumbra::plane::ScreenPlane;

use super::screen::Screen;
use crate::geometry::wedge::paper1::LinkedWedge;
use crate::parts::passes::View;

/// Relative to the largest value a plane takes in the image: how far beyond it
/// counts as surely outside. Far above the rounding of plane and point.
const MARGIN: f64 = 1e-5;

/// Planes through edges that hold all of the wedge, each with its margin.
pub(crate) fn of_edges(
    screen: &Screen,
    view: &View,
    wedge: &LinkedWedge,
    size: [u32; 2],
) -> Vec<(ScreenPlane, f32)> {
    let planes = wedge.planes().map(|p| screen.coefficients(view, &p));
    let mut out = Vec::new();
    for i in 0..4 {
        for j in i + 1..4 {
            for k in [0, 1, 3] {
                out.extend(cancelled(&planes[i], &planes[j], k));
            }
        }
    }
    with_margins(out, size)
}

/// The wedge's range of depth as planes, each with its margin.
pub(crate) fn of_depth(
    view: &View,
    vertices: impl Iterator<Item = DVec4>,
    size: [u32; 2],
) -> Vec<(ScreenPlane, f32)> {
    with_margins(depth_range(view, vertices).into_iter().flatten(), size)
}

fn with_margins(
    planes: impl IntoIterator<Item = [f64; 4]>,
    size: [u32; 2],
) -> Vec<(ScreenPlane, f32)> {
    let extent = [f64::from(size[0]), f64::from(size[1]), 1.0, 1.0];
    let planes = planes.into_iter();
    planes.filter_map(|p| with_margin(p, extent)).collect()
}

/// The combination of two planes, with positive factors, without coordinate k.
fn cancelled(p: &[f64; 4], q: &[f64; 4], k: usize) -> Option<[f64; 4]> {
    let (a, b) = (p[k], q[k]);
    if a * b >= 0.0 {
        return None;
    }
    let mut sum = [0, 1, 2, 3].map(|i| b.abs() * p[i] + a.abs() * q[i]);
    sum[k] = 0.0;
    Some(sum)
}

/// Bounds of 1 - depth over a wedge's vertices, as planes; none where it passes the eye.
fn depth_range(view: &View, vertices: impl Iterator<Item = DVec4>) -> [Option<[f64; 4]>; 2] {
    let row = |r: usize| view.clip_from_world.0[r].map(f64::from);
    let (z, w) = (row(2), row(3));
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in vertices {
        let p = if v.w == 0.0 {
            v.truncate()
        } else {
            view.relative(v.truncate())
        };
        let apply = |m: [f64; 4]| m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3] * v.w;
        let (z, w) = (apply(z), apply(w));
        if w < 0.0 || (w == 0.0 && v.w != 0.0) {
            return [None, None];
        }
        if w == 0.0 {
            least = f64::NEG_INFINITY; // runs beside the image plane; q stays finite
            continue;
        }
        let q = 1.0 - z / w;
        least = least.min(q);
        greatest = greatest.max(q);
    }
    let near = greatest.is_finite().then_some([0.0, 0.0, greatest, -1.0]);
    let far = (least.is_finite() && least > 0.0).then_some([0.0, 0.0, -least, 1.0]);
    [near, far]
}

fn with_margin(p: [f64; 4], extent: [f64; 4]) -> Option<(ScreenPlane, f32)> {
    let largest = p
        .iter()
        .zip(extent)
        .map(|(c, e)| c.abs() * e)
        .fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let plane = ScreenPlane(p.map(|c| (c / largest) as f32));
    Some((plane, MARGIN as f32))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::world::scene::Camera;

    /// What runs beside the image plane comes to no end in depth, and what runs away does.
    #[test]
    fn a_range_of_depth_is_open_where_a_wedge_runs_beside_the_image() {
        let view = View::new(&Camera::look_at([0.0, 0.0, 5.0], [0.0; 3]), [64, 48]);
        let near = DVec4::new(0.0, 0.0, 0.0, 1.0);
        let range = |far: DVec3| depth_range(&view, [near, far.extend(0.0)].into_iter());
        assert!(range(DVec3::X)[1].is_none());
        // To infinity q falls to 0, which bounds nothing either.
        assert!(range(DVec3::NEG_Z)[1].is_none());
        let nearer = DVec4::new(0.0, 0.0, 1.0, 1.0);
        assert!(depth_range(&view, [near, nearer].into_iter())[1].is_some());
    }
}
