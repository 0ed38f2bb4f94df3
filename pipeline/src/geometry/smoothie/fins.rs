//! Smoothies: rectangles in the light's picture along silhouette edges, and corners as
//! quads between them (Chan and Durand 2003).

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::{Corner, Edge, PictureFrame, Reach, SmoothieVertex, Smoothies, edges};

/// Turns below this leave no gap that a texel could show.
const STRAIGHT: f64 = 1e-6;

/// Attaches smoothies `width` tangents wide to a loop.
pub(super) fn attach(
    all: &mut Smoothies,
    corners: &[Corner],
    frame: &PictureFrame,
    reach: Reach,
    width: f64,
) {
    let edges = edges(corners, reach, &mut all.cut);
    for (k, edge) in edges.iter().enumerate() {
        rectangle(all, edge, frame, width);
        let next = &edges[(k + 1) % edges.len()];
        corner(all, edge, next, frame, reach, width);
    }
}

/// The vertex `offset` widths off a corner, in the picture.
fn beside(corner: &Corner, offset: DVec2, frame: &PictureFrame, width: f64) -> SmoothieVertex {
    let z = corner.local.z;
    let place = corner.place() + offset * width;
    SmoothieVertex {
        position: frame.world(DVec3::new(place.x * z, place.y * z, z)),
        offset,
        ..corner.vertex()
    }
}

/// Of fixed width in the picture; its plane holds the edge.
fn rectangle(all: &mut Smoothies, edge: &Edge, frame: &PictureFrame, width: f64) {
    let [from, to] = &edge.ends;
    let off = |c: &Corner| SmoothieVertex {
        // Only the length counts, which is linear in the picture.
        offset: DVec2::Y,
        ..beside(c, edge.outward(), frame, width)
    };
    all.edges += 1;
    all.quad([from.vertex(), to.vertex(), off(to), off(from)]);
}

/// What lies between the rectangles of two edges at a convex corner. Each quad spans a
/// quarter turn at most, and holds the part of a disc in its angle.
fn corner(
    all: &mut Smoothies,
    edge: &Edge,
    next: &Edge,
    frame: &PictureFrame,
    reach: Reach,
    width: f64,
) {
    let (first, along) = (edge.outward(), edge.direction);
    let last = next.outward();
    let (sine, cosine) = (last.dot(along), last.dot(first));
    if sine < 0.0 {
        all.concave += 1;
        return;
    }
    let turn = libm::atan2(sine, cosine);
    if turn < STRAIGHT {
        return;
    }
    // Where an edge between both is seen as a point, both ends of it.
    let ends = [edge.ends[1], next.ends[0]];
    let count = if ends[0].world == ends[1].world { 1 } else { 2 };
    for at in ends.iter().take(count).filter(|c| reach.holds(c)) {
        all.corners += 1;
        let quads = (turn / FRAC_PI_2).ceil().max(1.0);
        let step = turn / quads;
        let towards = |angle: f64| first * libm::cos(angle) + along * libm::sin(angle);
        for k in 0..quads as u32 {
            let angle = step * f64::from(k);
            let middle = towards(angle + step / 2.0) / libm::cos(step / 2.0);
            let off = |offset| beside(at, offset, frame, width);
            let (low, high) = (towards(angle), towards(angle + step));
            all.quad([at.vertex(), off(low), off(middle), off(high)]);
        }
    }
}
