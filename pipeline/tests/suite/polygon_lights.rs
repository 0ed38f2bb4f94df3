//! Soft shadow volumes under convex polygons, against the exact oracle.

use glam::DVec3;

use crate::drawing::drawn;
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::world::light::{ConvexPolygon, LightShape};
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [96, 64];
const SOFT: &str = "soft-shadow-volumes";
const OPTIMISED: &str = "soft-shadow-volumes-optimised";

/// A built-in scene under a polygon of `n` corners, each at another distance from the
/// middle, turned and tilted.
fn scene(name: &str, n: u32, tilt: f64) -> Scene {
    let mut scene = builtin::build(name).unwrap();
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = scene.lights[0].shape
    else {
        unreachable!()
    };
    let up = edge_u.cross(edge_v).normalize() * edge_u.length();
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(n) * std::f64::consts::TAU + 0.3;
        // Of few corners not all at one distance; of many that would not be convex.
        let wide = if n < 8 && !k.is_multiple_of(2) {
            0.46
        } else {
            0.5
        };
        let (s, t) = (libm::cos(angle) * wide, libm::sin(angle) * wide * 0.8);
        centre + edge_u * s + edge_v * t + up * (tilt * s)
    };
    let corners: Vec<DVec3> = (0..n).map(corner).collect();
    scene.lights[0].shape = LightShape::Polygon(ConvexPolygon::new(corners).unwrap());
    scene
}

fn error(scene: &Scene, technique: &str, set: &[&str]) -> ErrorSummary {
    let done = drawn(scene, technique, set, SIZE);
    let truth = Reference::new(scene, 0, SIZE, ReferenceKind::Exact, None, &|| ()).unwrap();
    let truth = truth.under(&done.depth).unwrap().truth;
    let all = VisibilityError::measure(&truth, SIZE, &done.visibility)
        .unwrap()
        .all
        .unwrap();
    println!("{} {technique} {set:?}: {all:?}", scene.name);
    all
}

/// One flat caster: the closed form is exact, whatever the corners, and what looks up is
/// as near as for rectangles.
#[test]
fn a_plate_under_a_polygon_is_the_truth() {
    for (corners, tilt) in [(3, 0.0), (5, 0.2), (7, -0.3), (16, 0.1)] {
        let scene = scene("parallel-plates", corners, tilt);
        assert!(error(&scene, SOFT, &[]).rmse < 2e-6, "{corners}");
        assert!(error(&scene, OPTIMISED, &[]).rmse < 2e-4, "{corners}");
    }
    let scene = scene("parallel-plates", 5, 0.2);
    let table = ["backend=texture4d", "texture-size=20"];
    assert!(error(&scene, SOFT, &table).rmse < 0.02);
    assert!(error(&scene, OPTIMISED, &["coverage=lut"]).rmse < 0.01);
    // A hard shadow, for comparison.
    assert!(error(&scene, "shadow-volumes", &[]).rmse > 0.05);
}

/// Bodies, under every construction of wedges: as good as under a rectangle.
#[test]
fn bodies_under_a_polygon_are_as_near_as_under_a_rectangle() {
    let rectangle = builtin::build("cylinder").unwrap();
    let limit = error(&rectangle, SOFT, &[]).rmse;
    let scene = scene("cylinder", 5, 0.1);
    let exact = drawn(&scene, SOFT, &[], SIZE);
    for wedge in ["wedge=paper3", "wedge=paper4", "skip=off"] {
        let done = drawn(&scene, SOFT, &[wedge], SIZE);
        assert_eq!(done.visibility_hash(), exact.visibility_hash(), "{wedge}");
    }
    assert!(error(&scene, SOFT, &[]).rmse < 1.2 * limit, "{limit}");
}

/// A rectangle given by its corners is the rectangle.
#[test]
fn four_corners_are_a_rectangle() {
    let rectangle = builtin::build("cylinder").unwrap();
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = rectangle.lights[0].shape
    else {
        unreachable!()
    };
    let corner = |s: f64, t: f64| centre + edge_u * s + edge_v * t;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let corners: Vec<DVec3> = corners.iter().map(|(s, t)| corner(*s, *t)).collect();
    let mut polygon = rectangle.clone();
    polygon.lights[0].shape = LightShape::Polygon(ConvexPolygon::new(corners).unwrap());
    let [a, b] = [&rectangle, &polygon].map(|s| drawn(s, SOFT, &[], SIZE).visibility);
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    assert!(off.filter(|d| !d.is_nan()).fold(0.0, f32::max) < 1e-4);
}

#[test]
fn what_polygons_cannot_have_is_said() {
    let refused = |scene: &Scene, set: &[&str]| {
        let technique = find(SOFT).unwrap();
        let params = Params::parse(technique, set).unwrap();
        technique
            .frame(scene, SIZE, &params)
            .err()
            .unwrap()
            .to_string()
    };
    let many = refused(&scene("cylinder", 17, 0.0), &[]);
    assert!(
        many.contains("17 corners") && many.contains("up to 16"),
        "{many}"
    );
    let image = refused(&scene("cylinder", 5, 0.0), &["light-image=fire"]);
    assert!(image.contains("rectangles for light-image"), "{image}");
}
