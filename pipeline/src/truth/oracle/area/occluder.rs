//! What one triangle hides of a flat light, as seen from a point.

use glam::DVec3;

use super::emitter::Frame;
use super::fragments::HalfPlane;
use crate::truth::oracle::bvh::Region;

/// A triangle whose plane passes the receiver at less than this share of the
/// largest coordinate is seen edge-on, and one that lies as near to the light
/// lies in it: both hide nothing. A tenth of the lift of
/// [`crate::truth::oracle::surfaces::Receiver`], ten times the rounding of a point and
/// more.
const EDGE_ON: f64 = 1e-14;

/// A light's outline is too nearly in line with the receiver for a side of the
/// pyramid when the sine is below this.
const IN_LINE: f64 = 1e-9;

/// The half-planes of the light that a triangle's shadow consists of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shadow {
    /// It does not meet the light.
    Nothing,
    /// The light is hidden altogether.
    Everything,
    /// The part inside the first `count` planes.
    Part {
        planes: [HalfPlane; 4],
        count: usize,
    },
}

/// The part of `light` (relative to `p`) that the triangle hides from `p`.
///
/// The points hidden are those in the cone over the triangle, bounded by three
/// planes through `p`, and beyond the triangle's own plane by more than
/// rounding, so that a triangle in the plane of the light, such as the lamp's
/// own mesh, hides nothing of it. No point is
/// projected, so a triangle may cross the plane of the light or the plane
/// through `p` parallel to it. Two triangles that share an edge have planes
/// there that are equal or opposite to the bit, so they leave no gap.
pub(super) fn shadow_on(
    light: &Frame,
    outline: &[[f64; 2]],
    p: DVec3,
    corners: &[DVec3; 3],
) -> Shadow {
    let [a, mut b, mut c] = corners.map(|v| v - p);
    let mut normal = (b - a).cross(c - a);
    let distance = normal.dot(a); // times the length of the normal
    let reach = light.centre.abs() + light.u.abs() + light.v.abs(); // from p
    let largest = corners.iter().map(|v| v.abs().max_element());
    let largest = largest.fold(p.abs().max_element().max(reach.max_element()), f64::max);
    let slack = EDGE_ON * largest * normal.length();
    let clear = distance.abs() > slack;
    if !clear {
        return Shadow::Nothing;
    }
    if distance < 0.0 {
        (b, c) = (c, b);
        normal = -normal;
    }
    let bounds = [
        light.trace(a.cross(b), 0.0),
        light.trace(b.cross(c), 0.0),
        light.trace(c.cross(a), 0.0),
        light.trace(normal, -distance.abs() - slack),
    ];
    cut_by(bounds, outline)
}

/// Drops the planes that the whole light is inside of.
fn cut_by(bounds: [HalfPlane; 4], outline: &[[f64; 2]]) -> Shadow {
    let mut planes = [HalfPlane::default(); 4];
    let mut count = 0;
    for plane in bounds {
        let (mut inside, mut outside) = (false, false);
        for corner in outline {
            let value = plane.at(*corner);
            inside |= value > 0.0;
            outside |= value < 0.0;
        }
        if !inside {
            return Shadow::Nothing;
        }
        if outside {
            planes[count] = plane;
            count += 1;
        }
    }
    if count == 0 {
        Shadow::Everything
    } else {
        Shadow::Part { planes, count }
    }
}

/// Sets `region` to the pyramid between `p` and the light (relative to `p`), or
/// to more where the pyramid is too flat for its sides to be told.
pub(super) fn pyramid(region: &mut Region, p: DVec3, light: &Frame, outline: &[[f64; 2]]) {
    region.reset(p);
    let normal = light.u.cross(light.v);
    let height = normal.dot(light.centre);
    let normal = if height < 0.0 { -normal } else { normal };
    region.keep(normal, 0.0);
    region.keep(-normal, height.abs());
    let next = outline.iter().cycle().skip(1);
    for (from, to) in outline.iter().zip(next) {
        let [from, to] = [light.at(*from), light.at(*to)];
        let side = from.cross(to);
        let inner = side.dot(light.centre);
        let clear = side.length() > IN_LINE * from.length() * to.length()
            && inner.abs() > IN_LINE * side.length() * light.centre.length();
        if clear {
            region.keep(if inner < 0.0 { -side } else { side }, 0.0);
        }
    }
}
