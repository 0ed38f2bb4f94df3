//! Widths, corners and planes of what is attached, in f64.

use super::*;
use crate::geometry::silhouette::{Orientation, light_facing};
use crate::world::adjacency::EdgeAdjacency;
use crate::world::light::HardLight;
use crate::world::mesh::Shading;
use crate::world::shape::{self, Shape};

const LIGHT: DVec3 = DVec3::new(0.3, 5.0, 0.2);
const REACH: Reach = Reach {
    near: 0.1,
    far: 5.0,
};

/// Looking down.
const FRAME: PictureFrame = PictureFrame {
    centre: LIGHT,
    axes: [DVec3::X, DVec3::Z, DVec3::NEG_Y],
};

/// Right × down has to be along.
#[test]
fn the_frame_is_one() {
    let [right, down, along] = FRAME.axes;
    assert_eq!(right.cross(down), along);
    let p = DVec3::new(0.4, 1.2, -0.3);
    assert!((FRAME.world(FRAME.local(p)) - p).length() < 1e-12);
}

fn of(shape: Shape, attachment: Attachment) -> (Mesh, Smoothies) {
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    let facing = light_facing(&mesh, HardLight::Point(LIGHT));
    let adjacency = EdgeAdjacency::new(mesh.triangles());
    let silhouette = Silhouette::new(&mesh, &adjacency, &Orientation::closed(&facing));
    let found = attach(&mesh, &silhouette, &FRAME, REACH, attachment);
    (mesh, found)
}

fn block() -> Shape {
    shape::cuboid(DVec3::Y, DVec3::new(1.0, 0.6, 0.8))
}

/// A plus from above: four concave corners.
fn plus() -> Shape {
    let corners = [
        [1.0, 3.0],
        [1.0, 1.0],
        [3.0, 1.0],
        [3.0, -1.0],
        [1.0, -1.0],
        [1.0, -3.0],
        [-1.0, -3.0],
        [-1.0, -1.0],
        [-3.0, -1.0],
        [-3.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 3.0],
    ];
    let ring = |y: f64| corners.map(|[x, z]| DVec3::new(x * 0.2, y, z * 0.2));
    let n = corners.len() as u32;
    let mut positions: Vec<DVec3> = ring(1.2).into_iter().chain(ring(0.8)).collect();
    let (top, bottom) = (2 * n, 2 * n + 1);
    positions.extend([DVec3::Y * 1.2, DVec3::Y * 0.8]);
    let mut triangles = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        triangles.extend([[top, k, next], [bottom, n + next, n + k]]);
        triangles.extend([[k, n + k, next], [next, n + k, n + next]]);
    }
    Shape {
        positions,
        triangles,
    }
}

/// The farthest that anything attached is from the silhouette in the picture, and whether
/// each rectangle's outer side is outside of what casts.
#[test]
fn smoothies_are_as_wide_as_asked_for_and_outside() {
    for width in [0.01, 0.07] {
        let (mesh, found) = of(block(), Attachment::Smoothies(width));
        assert!(found.edges >= 4 && found.corners == found.edges && found.concave == 0);
        let place = |p: DVec3| {
            let p = FRAME.local(p);
            p.truncate() / p.z
        };
        // The block's picture is convex: what is outside of it is farther from its middle
        // along the outward direction than any corner.
        let corners: Vec<DVec2> = mesh
            .positions()
            .iter()
            .map(|p| place(crate::world::mesh::widen(*p)))
            .collect();
        let mut outer = 0;
        for t in found.vertices.chunks(3) {
            for v in t {
                assert!((v.distance - FRAME.local(v.position).z).abs() < 1e-9);
                assert!((v.blocker - v.distance).abs() < 1e-9);
                if v.offset == DVec2::ZERO {
                    continue;
                }
                outer += 1;
                let nearest = corners.iter().map(|c| (*c - place(v.position)).length());
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                assert!(nearest > width * 0.999, "{nearest}");
                assert!(nearest < width * 1.5, "{nearest}");
            }
        }
        assert!(outer > 12);
        // No outer vertex is inside the hull of the corners.
        let inside = |p: DVec2| {
            let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
            let along = (p - middle).normalize();
            let most = corners
                .iter()
                .map(|c| along.dot(*c - middle))
                .fold(0.0, f64::max);
            along.dot(p - middle) < most
        };
        let off = found.vertices.iter().filter(|v| v.offset.length() > 0.999);
        let count = off.clone().count();
        let within = off.filter(|v| inside(place(v.position))).count();
        // Beside long edges the hull's corners reach farther than the edge.
        assert!(within < count / 2, "{within} of {count}");
    }
}

/// A triangle's signed area in the picture.
fn area(t: &[SmoothieVertex]) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|k| {
        let p = FRAME.local(t[k].position);
        p.truncate() / p.z
    });
    (b - a).perp_dot(c - a) / 2.0
}

/// T: concave corners have nothing; rectangles and corners of convex outlines do not
/// overlap: their areas are those of an outline grown by the width, but for corners' tips.
#[test]
fn corners_are_at_convex_vertices_only() {
    // Right under the light, which sees none of its sides.
    let plus = plus().translated(DVec3::new(LIGHT.x, 0.0, LIGHT.z));
    let (_, found) = of(plus, Attachment::Smoothies(0.02));
    assert_eq!((found.concave, found.corners), (4, 8));
    let (_, found) = of(block(), Attachment::Smoothies(0.02));
    let areas: f64 = found.vertices.chunks(3).map(|t| area(t).abs()).sum();
    let edges: f64 = {
        let rectangles = found
            .vertices
            .chunks(3)
            .filter(|t| t.iter().any(|v| v.offset == DVec2::Y));
        rectangles.map(|t| area(t).abs()).sum()
    };
    // The corners' turns add up to a whole one: more than a disc, less than a square.
    let corners = areas - edges;
    let square = 0.02 * 0.02;
    assert!(corners > std::f64::consts::PI * square, "{corners}");
    assert!(corners < 4.001 * square * 1.2, "{corners}");
}

/// Cones reach as far as the border of the penumbra: from any point of them the light's
/// rim is seen past the vertex. Sheets touch the light.
#[test]
fn cones_and_sheets_touch_the_light() {
    let radius = 0.4;
    let (_, found) = of(block(), Attachment::Cones(radius));
    assert!(found.corners >= 4 && found.edges >= 4);
    // Sheets are first. Each side of a cone is a line through its vertex and the rim.
    for t in found.vertices.chunks(3).skip(2 * found.edges) {
        let [apex, rest @ ..] = [0, 1, 2].map(|k| FRAME.local(t[k].position));
        for far in rest {
            let met = far + (apex - far) * (far.z / (far.z - apex.z));
            assert!((met.truncate().length() - radius).abs() < 1e-9, "{met}");
        }
        assert!(t.iter().all(|v| v.blocker == t[0].distance));
    }
    // A sheet's plane has all of the light on one side.
    let sheets = found.vertices.chunks(3).take(2 * found.edges);
    for t in sheets {
        let [a, b, c] = [0, 1, 2].map(|k| FRAME.local(t[k].position));
        let normal = (b - a).cross(c - a).normalize();
        let middle = -normal.dot(a);
        let reach = radius * normal.truncate().length();
        assert!((middle.abs() - reach).abs() < 1e-6, "{middle} {reach}");
    }
}

/// Nothing is attached without a width, nor to what is nearer than what is looked at.
#[test]
fn what_is_out_of_reach_has_nothing() {
    for nothing in [0.0, f64::NAN] {
        let (_, found) = of(block(), Attachment::Smoothies(nothing));
        assert_eq!(found, Smoothies::default());
    }
    let near = Shape {
        positions: block()
            .positions
            .iter()
            .map(|p| *p + DVec3::Y * 4.5)
            .collect(),
        ..block()
    };
    let (_, found) = of(near, Attachment::Smoothies(0.1));
    assert_eq!(found.edges, 0);
}
