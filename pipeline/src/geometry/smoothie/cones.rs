//! Cones and sheets: the outer border of penumbrae of a round light (Haines 2001; Wyman
//! and Hansen 2003). A cone holds all lines through a vertex of the silhouette from the
//! rim of the light; a sheet is the plane through an edge that touches the rim.

use glam::{DVec2, DVec3};

use super::{Corner, Edge, PictureFrame, Reach, SmoothieVertex, Smoothies, edges};

/// Sides of a cone.
const SIDES: u32 = 32;

/// Attaches cones and sheets of a light of this radius to a loop.
pub(super) fn attach(
    all: &mut Smoothies,
    corners: &[Corner],
    frame: &PictureFrame,
    reach: Reach,
    radius: f64,
) {
    for edge in edges(corners, reach, &mut all.cut) {
        sheet(all, &edge, frame, reach.far, radius);
    }
    for corner in corners.iter().filter(|c| reach.holds(c)) {
        cone(all, corner, frame, reach.far, radius);
    }
}

/// Where the line from a point of the light through a corner is at the far distance.
fn beyond(corner: &Corner, light: DVec2, frame: &PictureFrame, far: f64) -> SmoothieVertex {
    let p = corner.local;
    let from = DVec3::new(light.x, light.y, 0.0);
    let local = p + (p - from) * ((far - p.z) / p.z);
    SmoothieVertex {
        position: frame.world(local),
        distance: far,
        ..corner.vertex()
    }
}

fn cone(all: &mut Smoothies, corner: &Corner, frame: &PictureFrame, far: f64, radius: f64) {
    all.corners += 1;
    let rim = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k % SIDES) / f64::from(SIDES);
        let light = DVec2::new(libm::cos(angle), libm::sin(angle)) * radius;
        beyond(corner, light, frame, far)
    };
    for k in 0..SIDES {
        all.vertices.extend([corner.vertex(), rim(k), rim(k + 1)]);
    }
}

fn sheet(all: &mut Smoothies, edge: &Edge, frame: &PictureFrame, far: f64, radius: f64) {
    let Some(light) = touched(edge, radius) else {
        return;
    };
    all.edges += 1;
    let [from, to] = &edge.ends;
    let off = |c: &Corner| beyond(c, light, frame, far);
    all.quad([from.vertex(), to.vertex(), off(to), off(from)]);
}

/// Where the outer plane through an edge touches the light's rim: on the side that what
/// casts is on. `None` where the edge's line meets the light: the cones are all there is.
fn touched(edge: &Edge, radius: f64) -> Option<DVec2> {
    let [p, q] = edge.ends.map(|c| c.local);
    let along = q - p;
    let inward = -edge.outward();
    // Lines that meet the light's plane too far away are parallel to it.
    const FAR: f64 = 1e9;
    if along.z.abs() * FAR * radius <= along.truncate().length() * p.z {
        let normal = DVec2::new(-along.y, along.x).normalize();
        return Some(normal * radius * normal.dot(inward).signum());
    }
    let met = (p - along * (p.z / along.z)).truncate();
    let square = met.length_squared();
    if square <= radius * radius {
        return None;
    }
    let middle = met * (radius * radius / square);
    let aside = met.perp() * (radius * (square - radius * radius).sqrt() / square);
    let both = [middle + aside, middle - aside];
    let deeper = both[0].dot(inward) >= both[1].dot(inward);
    Some(both[usize::from(!deeper)])
}
