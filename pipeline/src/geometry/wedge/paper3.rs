//! Wedges that bound the penumbra of a sphere round the light (paper III, §3.1).
//!
//! The end of the edge that is farther from the light slides towards the light's
//! centre until both ends are equally far. Front and back plane hold the edge
//! thus moved and touch the sphere; the planes at the ends hold one end each and
//! the normal of the hard shadow quad, and touch it too.
//!
//! Undefined where the line of the moved edge meets the sphere (h <= r), or where
//! the edge points at the light's centre, so that it shrinks to a point.

use glam::DVec3;

use super::polyhedron::{End, Ends};

/// Why there is no wedge of this kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undefined {
    /// The edge points at the light's centre.
    AimedAtCentre,
    /// The line through the moved edge meets the light or its bounding sphere.
    MeetsLight,
}

/// Relative margin to where the construction breaks down.
const MARGIN: f64 = 1e-9;

/// The edge with its farther end moved towards `centre`, until both ends are
/// equally far from it.
///
/// # Errors
/// [`Undefined::AimedAtCentre`].
pub fn relocated(centre: DVec3, edge: [DVec3; 2]) -> Result<[DVec3; 2], Undefined> {
    let arms = edge.map(|e| e - centre);
    let [d0, d1] = arms.map(|arm| arm.length());
    let near = d0.min(d1);
    let moved = |k: usize, d: f64| {
        if d > near {
            centre + arms[k] * (near / d)
        } else {
            edge[k]
        }
    };
    let out = [moved(0, d0), moved(1, d1)];
    if (out[1] - out[0]).length() <= MARGIN * near {
        return Err(Undefined::AimedAtCentre);
    }
    Ok(out)
}

/// Ends of the wedge for a light within `radius` of `centre`.
///
/// # Errors
/// Where the construction is undefined.
pub fn ends(centre: DVec3, radius: f64, edge: [DVec3; 2]) -> Result<Ends, Undefined> {
    let [e0, e1] = relocated(centre, edge)?;
    let middle = 0.5 * (e0 + e1) - centre;
    let h = middle.length(); // the ends are equally far: their middle is nearest
    if h <= radius * (1.0 + MARGIN) {
        return Err(Undefined::MeetsLight);
    }
    let along = (e1 - e0).normalize();
    let away = middle / h;
    let outer = away.cross(along);
    let front = tangent(away, -outer, radius / h);
    let back = tangent(away, outer, radius / h);
    let side = |e: DVec3, inwards: DVec3| {
        let axis = (e - centre).normalize();
        let across = (inwards - axis * inwards.dot(axis)).normalize();
        let side = tangent(axis, across, radius / (e - centre).length());
        let rays = vec![common_ray(front, side, back), common_ray(back, side, front)];
        End { apex: e, rays }
    };
    Ok(Ends::Two([side(e0, along), side(e1, -along)]))
}

/// Normal of a plane that touches the light: `axis` turned towards `towards` so
/// that its sine against the light is `sine`.
fn tangent(axis: DVec3, towards: DVec3, sine: f64) -> DVec3 {
    axis * sine + towards * (1.0 - sine * sine).max(0.0).sqrt()
}

/// The ray in both planes, given by their normals, on the inner side of a third.
fn common_ray(a: DVec3, b: DVec3, inside: DVec3) -> DVec3 {
    let ray = a.cross(b);
    if ray.dot(inside) < 0.0 { -ray } else { ray }
}
