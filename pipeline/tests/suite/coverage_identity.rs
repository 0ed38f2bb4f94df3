//! `V = 1 - w + sum s c`: the coverage of single edges adds up to the visible
//! fraction of the light, against polygon clipping that knows of no edges, sides
//! or sectors.

use crate::wedge_support::{Frame, KINDS, Kind, Random, shape};
use glam::{DVec2, DVec3};
use gnomon_pipeline::geometry::coverage::{LightPlane, SphereOutline, loop_visibility, umbra_side};

/// A simple loop in light coordinates (units of the light's half size), clockwise:
/// star-shaped round some place near the light.
fn star(random: &mut Random) -> Vec<DVec2> {
    let n = 3 + random.below(9);
    let start = random.range(0.0, 6.3);
    let middle = DVec2::new(random.range(-1.4, 1.4), random.range(-1.4, 1.4));
    (0..n)
        .map(|k| {
            let angle = start - std::f64::consts::TAU * (k as f64 + 0.4 * random.unit()) / n as f64;
            middle + DVec2::new(libm::cos(angle), libm::sin(angle)) * random.range(0.15, 1.8)
        })
        .collect()
}

fn cross(a: DVec2, b: DVec2) -> f64 {
    a.x * b.y - a.y * b.x
}

fn area(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|k| 0.5 * cross(polygon[k], polygon[(k + 1) % n]))
        .sum()
}

/// Area of a simple polygon inside the square -1..1, by clipping the polygon to
/// one side after the other; bridges along the sides have no area.
fn area_in_square(polygon: &[DVec2]) -> f64 {
    let mut polygon = polygon.to_vec();
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let inside = |p: DVec2| 1.0 - sign * p[axis];
        let mut out = Vec::new();
        for k in 0..polygon.len() {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            let (fa, fb) = (inside(a), inside(b));
            if fa >= 0.0 {
                out.push(a);
            }
            if (fa < 0.0) != (fb < 0.0) {
                out.push(a + (b - a) * (fa / (fa - fb)));
            }
        }
        polygon = out;
    }
    area(&polygon).abs()
}

/// Area of a simple polygon inside the unit disc, edge by edge: triangles where
/// the edge is inside, arcs where it is outside.
fn area_in_disc(polygon: &[DVec2]) -> f64 {
    let arc = |p: DVec2, q: DVec2| 0.5 * libm::atan2(cross(p, q), p.dot(q));
    let n = polygon.len();
    let pieces = (0..n).map(|k| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        let d = b - a;
        let (dd, ad) = (d.dot(d), a.dot(d));
        let inside = ad * ad - dd * (a.dot(a) - 1.0);
        if inside <= 0.0 {
            return arc(a, b);
        }
        let at = |s: f64| ((-ad + s * inside.sqrt()) / dd).clamp(0.0, 1.0);
        let (p, q) = (a + d * at(-1.0), a + d * at(1.0));
        let chord = if at(-1.0) < at(1.0) {
            0.5 * cross(p, q)
        } else {
            0.0
        };
        let joined = if at(-1.0) < at(1.0) { 0.0 } else { arc(p, q) };
        arc(a, p) + chord + joined + arc(q, b)
    });
    pieces.sum::<f64>().abs()
}

/// A light, a receiver, and a loop in light coordinates lifted into space.
struct Case {
    light: LightPlane,
    receiver: DVec3,
    image: Vec<DVec2>,
    points: Vec<DVec3>,
    square: bool,
}

fn case(kind: Kind, random: &mut Random) -> Case {
    let mut frame = Frame::random(random);
    let shape = shape(kind, &frame);
    let [x, y] = [(); 2].map(|()| random.range(-3.0, 3.0));
    let behind = kind != Kind::Sphere && random.below(4) == 0;
    if behind {
        frame.axes[1] = -frame.axes[1]; // seen from the other side, right-handed again
        frame.axes[2] = -frame.axes[2];
    }
    let receiver = frame.at(x, y, random.range(4.0, 9.0));
    let light = LightPlane::new(&shape, SphereOutline::Equator).unwrap();
    let (axes, square) = match light {
        LightPlane::Rectangle { half_edges, .. } => {
            let sign = if behind { -1.0 } else { 1.0 };
            ([half_edges[0], half_edges[1] * sign], true)
        }
        LightPlane::Disc { radius, .. } => {
            ([frame.axes[0] * radius, frame.axes[1] * radius], false)
        }
        LightPlane::Sphere { centre, radius, .. } => {
            let n = (receiver - centre).normalize();
            let u = n.any_orthonormal_vector();
            ([u * radius, n.cross(u) * radius], false)
        }
    };
    let image = star(random);
    let lift = |p: &DVec2| {
        let on_light = light.centre() + axes[0] * p.x + axes[1] * p.y;
        on_light + (receiver - on_light) * random.range(0.1, 0.9)
    };
    let points = image.iter().map(lift).collect();
    Case {
        light,
        receiver,
        image,
        points,
        square,
    }
}

impl Case {
    fn truth(&self) -> f64 {
        if self.square {
            1.0 - area_in_square(&self.image) / 4.0
        } else {
            1.0 - area_in_disc(&self.image) / std::f64::consts::PI
        }
    }

    fn visibility(&self, points: &[DVec3]) -> f64 {
        loop_visibility(&self.light, points, self.receiver).unwrap()
    }
}

#[test]
fn coverage_adds_up_for_simple_loops() {
    for kind in KINDS {
        let mut random = Random(1);
        let (mut worst, mut shadowed, mut partly): (f64, i32, i32) = (0.0, 0, 0);
        for _ in 0..5000 {
            let case = case(kind, &mut random);
            let (truth, ours) = (case.truth(), case.visibility(&case.points));
            worst = worst.max((truth - ours).abs());
            shadowed += i32::from(truth < 0.5);
            partly += i32::from(truth > 0.001 && truth < 0.999);
        }
        eprintln!(
            "{kind:?}: worst {worst:.1e}; {partly} partly lit, {shadowed} mostly dark of 5000"
        );
        assert!(worst < 1e-12, "{kind:?}: {worst}");
        assert!(partly > 2500 && shadowed > 100, "{partly} {shadowed}");
    }
}

/// The sign is what a sham would get wrong: one edge with the other sign, or a
/// loop that runs the other way, must show.
#[test]
fn negative_control_wrong_signs_do_not_add_up() {
    let mut random = Random(2);
    let (mut flipped, mut reversed) = (0, 0);
    for _ in 0..500 {
        let case = case(Kind::Square, &mut random);
        let truth = case.truth();
        let projection = case.light.seen_from(case.receiver).unwrap();
        let edge = [case.points[0], case.points[1]];
        let once_more = 2.0 * projection.coverage(edge);
        let sign = if umbra_side(case.light.centre(), edge, case.receiver) {
            -1.0
        } else {
            1.0
        };
        let wrong = case.visibility(&case.points) + sign * once_more;
        flipped += i32::from((wrong - truth).abs() > 1e-3);
        let mut backwards = case.points.clone();
        backwards.reverse();
        reversed += i32::from((case.visibility(&backwards) - truth).abs() > 1e-3);
    }
    assert!(flipped > 100 && reversed > 300, "{flipped} {reversed}");
}

/// Splitting every edge into m collinear pieces changes nothing.
#[test]
fn subdivision_changes_nothing() {
    let mut worst: f64 = 0.0;
    for kind in KINDS {
        let mut random = Random(3);
        for _ in 0..200 {
            let case = case(kind, &mut random);
            let whole = case.visibility(&case.points);
            for m in [2, 3, 7, 16, 64] {
                let n = case.points.len();
                let split: Vec<DVec3> = (0..n * m)
                    .map(|k| {
                        let (a, b) = (case.points[k / m], case.points[(k / m + 1) % n]);
                        a + (b - a) * ((k % m) as f64 / m as f64)
                    })
                    .collect();
                worst = worst.max((case.visibility(&split) - whole).abs());
            }
        }
    }
    eprintln!("subdivision into up to 64 pieces: worst change {worst:.1e}");
    assert!(worst < 1e-12, "{worst}");
}

/// A flat convex occluder in space, its shadow projected by plain division.
#[test]
fn convex_planar_occluders_equal_polygon_clipping() {
    let mut random = Random(4);
    let (mut worst, mut partly): (f64, i32) = (0.0, 0);
    for _ in 0..5000 {
        let frame = Frame::random(&mut random);
        let light = LightPlane::new(&shape(Kind::Square, &frame), SphereOutline::Seen).unwrap();
        let receiver = frame.at(random.range(-2.0, 2.0), random.range(-2.0, 2.0), 7.0);
        // A tilted regular polygon, counter-clockwise seen from the light.
        let tilt = (random.direction() * 0.3 + frame.axes[2]).normalize();
        let u = tilt.cross(frame.axes[0]).normalize();
        let v = tilt.cross(u);
        let middle = frame.at(random.range(-0.7, 0.7), random.range(-0.7, 0.7), 3.5);
        let n = 3 + random.below(6);
        let size = random.range(0.2, 0.9);
        let corner = |k: usize| {
            let t = -std::f64::consts::TAU * k as f64 / n as f64;
            middle + (u * libm::cos(t) + v * libm::sin(t)) * size
        };
        let points: Vec<DVec3> = (0..n).map(corner).collect();
        let image: Vec<DVec2> = points
            .iter()
            .map(|q| {
                let d = *q - receiver;
                let t = frame.axes[2].dot(frame.centre - receiver) / frame.axes[2].dot(d);
                let on = receiver + d * t - frame.centre;
                DVec2::new(frame.axes[0].dot(on), frame.axes[1].dot(on)) * 2.0
            })
            .collect();
        let truth = 1.0 - area_in_square(&image) / 4.0;
        let ours = loop_visibility(&light, &points, receiver).unwrap();
        worst = worst.max((truth - ours).abs());
        partly += i32::from(truth > 0.001 && truth < 0.999);
    }
    eprintln!("convex planar occluders: worst {worst:.1e}, {partly} of 5000 partly lit");
    assert!(worst < 1e-12 && partly > 1500, "{worst} {partly}");
}

/// Receivers on the plane of a hard shadow quad, and a few ulps beside it.
#[test]
fn receivers_at_a_hard_shadow_quad_stay_in_range() {
    let frame = Frame {
        centre: DVec3::ZERO,
        axes: [DVec3::X, DVec3::Y, DVec3::Z],
    };
    let light = LightPlane::new(&shape(Kind::Square, &frame), SphereOutline::Seen).unwrap();
    // The edge x = 0.1 at z = 2 throws its quad through (0.3, y, 6).
    let corners = [(0.1, -0.7), (0.1, 0.9), (1.3, 0.9), (1.3, -0.7)];
    let points = corners.map(|(x, y)| DVec3::new(x, y, 2.0));
    let on_plane = 0.1f64 * 3.0;
    let values: Vec<f64> = (-8i64..=8)
        .map(|ulps| {
            let x = f64::from_bits((on_plane.to_bits() as i64 + ulps) as u64);
            loop_visibility(&light, &points, DVec3::new(x, 0.0, 6.0)).unwrap()
        })
        .collect();
    let spread = values
        .iter()
        .fold(0.0f64, |s, v| s.max((v - values[0]).abs()));
    assert!(spread < 1e-13, "{values:?}");
    assert!(values.iter().all(|v| (0.0..=1.0).contains(v)));
}

/// A sphere looks larger than its equator: a disc of radius r would miss it.
#[test]
fn the_seen_outline_of_a_sphere_is_its_tangent_cone() {
    let mut random = Random(5);
    for _ in 0..500 {
        let frame = Frame::random(&mut random);
        let LightPlane::Sphere { centre, radius, .. } =
            LightPlane::new(&shape(Kind::Sphere, &frame), SphereOutline::Seen).unwrap()
        else {
            unreachable!();
        };
        let receiver = frame.at(0.3, -0.2, random.range(0.8, 4.0));
        let towards = random.direction();
        let [seen, equator] = [SphereOutline::Seen, SphereOutline::Equator].map(|outline| {
            let light = LightPlane::Sphere {
                centre,
                radius,
                outline,
            };
            let ray = receiver + towards;
            let tiny = [ray, ray + random.direction() * 1e-6];
            light.seen_from(receiver).unwrap().clip(tiny).is_some()
        });
        // Distance of the line of sight from the centre.
        let ahead = towards.dot(centre - receiver);
        let miss = (centre - receiver - towards * ahead).length() - radius;
        if miss.abs() > 1e-4 {
            assert_eq!(seen, miss < 0.0 && ahead > 0.0);
            assert!(!equator || seen);
        }
    }
}
