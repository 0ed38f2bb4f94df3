//! Lines and points as pairs of triangles (rules §3.3).

use super::ScreenVertex;

/// Corners of a point's square, in the order a, b, c, d.
pub(super) fn point_corners(p: ScreenVertex, size: f32) -> [ScreenVertex; 4] {
    let h = (128.0 * f64::from(size)).round_ties_even() as f32;
    let at = |dx: f32, dy: f32| ScreenVertex {
        x: p.x + dx,
        y: p.y + dy,
        ..p
    };
    [at(-h, -h), at(h, -h), at(h, h), at(-h, h)]
}

/// Corners of a line's rectangle; `None` for a line of no length. Corners a, d
/// belong to `p`, b, c to `q`.
pub(super) fn line_corners(
    p: ScreenVertex,
    q: ScreenVertex,
    width: f32,
) -> Option<[ScreenVertex; 4]> {
    let (dx, dy) = (
        f64::from(q.x) - f64::from(p.x),
        f64::from(q.y) - f64::from(p.y),
    );
    let length = (dx * dx + dy * dy).sqrt();
    if length == 0.0 {
        return None;
    }
    let s = f64::from(width);
    let ox = (-dy / length * 128.0 * s).round_ties_even() as f32;
    let oy = (dx / length * 128.0 * s).round_ties_even() as f32;
    let at = |v: ScreenVertex, sign: f32| ScreenVertex {
        x: v.x + sign * ox,
        y: v.y + sign * oy,
        ..v
    };
    Some([at(p, -1.0), at(q, -1.0), at(q, 1.0), at(p, 1.0)])
}
