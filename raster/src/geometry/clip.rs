//! Clipping in homogeneous space (rules §2).

use super::GeometryState;
use crate::MAX_VARYINGS;

/// Clip planes: W, near, far guard, right, left, bottom, top.
pub(super) const PLANES: usize = 7;
/// Smallest w that is kept.
pub(super) const W_MIN: f32 = f32::from_bits((127 - 100) << 23); // 2⁻¹⁰⁰
/// With depth clamp, geometry is kept as near as z = −1024·w.
pub(super) const DEPTH_GUARD: f64 = 1024.0;

/// A vertex on its way through the clipper.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    pub(super) position: [f32; 4],
    pub(super) varyings: [f32; MAX_VARYINGS],
}

/// Signed distance to clip plane `plane`, in doubles.
pub(super) fn distance(state: &GeometryState, plane: usize, p: &[f32; 4]) -> f64 {
    let [x, y, z, w] = p.map(f64::from);
    let guard = state.viewport.guard.map(f64::from);
    match plane {
        0 => w - f64::from(W_MIN),
        1 if state.depth_clamp => z + DEPTH_GUARD * w,
        1 => z,
        2 => DEPTH_GUARD * w - z,
        3 => guard[0] * w - x,
        4 => guard[1] * w + x,
        5 => guard[2] * w + y,
        _ => guard[3] * w - y,
    }
}

/// The point where inside → outside crosses `plane`; always computed in that
/// direction, so that both neighbours of an edge get the same bits.
fn cut(state: &GeometryState, plane: usize, i: &ClipVertex, o: &ClipVertex) -> ClipVertex {
    let di = distance(state, plane, &i.position);
    let t = di / (di - distance(state, plane, &o.position));
    let mix = |a: f32, b: f32| (f64::from(a) + t * (f64::from(b) - f64::from(a))) as f32;
    let mut c = ClipVertex {
        position: core::array::from_fn(|k| mix(i.position[k], o.position[k])),
        varyings: core::array::from_fn(|k| mix(i.varyings[k], o.varyings[k])),
    };
    match plane {
        0 => c.position[3] = W_MIN,
        1 if !state.depth_clamp => c.position[2] = 0.0,
        _ => {}
    }
    c
}

/// Clips a polygon in place against the planes of `mask`.
pub(super) fn polygon(
    state: &GeometryState,
    mask: u16,
    poly: &mut Vec<ClipVertex>,
    spare: &mut Vec<ClipVertex>,
) {
    for plane in (0..PLANES).filter(|p| mask >> p & 1 != 0) {
        spare.clear();
        for (k, a) in poly.iter().enumerate() {
            let b = &poly[(k + 1) % poly.len()];
            let inside = |v: &ClipVertex| distance(state, plane, &v.position) >= 0.0;
            match (inside(a), inside(b)) {
                (true, true) => spare.push(*a),
                (true, false) => {
                    spare.push(*a);
                    spare.push(cut(state, plane, a, b));
                }
                (false, true) => spare.push(cut(state, plane, b, a)),
                (false, false) => {}
            }
        }
        core::mem::swap(poly, spare);
    }
}

/// Clips a segment; `None` where nothing is left.
pub(super) fn segment(
    state: &GeometryState,
    mask: u16,
    mut a: ClipVertex,
    mut b: ClipVertex,
) -> Option<[ClipVertex; 2]> {
    for plane in (0..PLANES).filter(|p| mask >> p & 1 != 0) {
        let inside = |v: &ClipVertex| distance(state, plane, &v.position) >= 0.0;
        match (inside(&a), inside(&b)) {
            (true, true) => {}
            (true, false) => b = cut(state, plane, &a, &b),
            (false, true) => a = cut(state, plane, &b, &a),
            (false, false) => return None,
        }
    }
    Some([a, b])
}
