//! PCF, PCSS and N shadow maps against closed forms and the exact oracle
//! (docs/papers.md, baselines).

use crate::map_support::{self, SIZE, by, centre_of, figure, plate_error, scene, truth};
use glam::DVec3;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::world::light::{ConvexPolygon, LightShape};
use gnomon_pipeline::world::scene::Scene;

const DISTANCES: [f64; 4] = [3.0, 4.9, 5.1, 8.0];

fn rmse(technique: &str, scene: &Scene, truth: &VisibilityImage, set: &[&str]) -> f64 {
    let picture = by(technique, scene, set);
    let error = VisibilityError::measure(truth, SIZE, &picture.visibility).unwrap();
    let views = figure(&picture, "views");
    println!("{technique} {set:?}, {views} views: {:?}", error.all);
    error.all.unwrap().rmse
}

/// T: the closed form within the map's resolution. Each edge of the plate is half
/// a texel off at most, which of a kernel 2w wide hides 1/4w too much along one
/// axis; so two edges, or corners, are off by 1/2w.
#[test]
fn whole_kernels_are_the_closed_form_within_texels() {
    let mut all = [0.0, 0.0];
    for d in DISTANCES {
        for (k, size) in ["map-size=128", "map-size=256"].into_iter().enumerate() {
            let set = ["sampling=all", "fit=receivers", size];
            let (error, kernel) = plate_error("pcss", d, &set);
            assert!(error.max <= 0.5 / kernel + 1e-3, "{d} {size}: {error:?}");
            all[k] += error.rmse;
        }
        // A picture that is fitted to the plate has its edges between texels: no
        // error is left but f32's.
        let (error, _) = plate_error("pcss", d, &["sampling=all", "map-size=64"]);
        assert!(error.max < 3e-5, "{d}: {error:?}");
    }
    // Halved texels halve the error; and texels are not exact.
    assert!(all[1] < 0.7 * all[0] && all[1] > 1e-4, "{all:?}");
}

/// T: N maps are the closed form within the steps of N points and the texels.
#[test]
fn many_maps_are_the_closed_form_within_their_steps() {
    for d in [3.0, 8.0] {
        let mut before = f64::INFINITY;
        for (maps, side) in [("maps=4", 2.0), ("maps=16", 4.0), ("maps=64", 8.0)] {
            let set = ["pattern=grid", "map-size=256", maps];
            let (error, kernel) = plate_error("shadow-maps-n", d, &set);
            // Along each axis two edges, half a step each, and what texels add.
            let bound = 2.0 / side + 0.5 / kernel;
            assert!(error.max <= bound + 1e-3, "{d} {maps}: {error:?}");
            assert!(error.rmse < 0.7 * before, "{d} {maps}: {error:?}");
            before = error.rmse;
        }
        assert!(before < 0.03, "{d}: {before}");
    }
}

/// Sampled kernels have the steps of their points: worse than all texels, and
/// better with more points.
#[test]
fn sampled_kernels_approach_the_whole_ones() {
    let of = |set: &[&str]| {
        let set = [set, &["map-size=128"]].concat();
        plate_error("pcss", 4.9, &set).0.rmse
    };
    let whole = of(&["sampling=all"]);
    let few = of(&["samples=16", "search-samples=64"]);
    let many = of(&["samples=256", "search-samples=64"]);
    assert!(
        whole < 0.5 * many && many < 0.5 * few,
        "{whole} {many} {few}"
    );
}

/// T, negative control: a kernel of fixed width that is right for one floor fails
/// at the others, by far more than the resolution that PCSS is held to.
#[test]
fn one_fixed_kernel_fails_where_another_width_is_needed() {
    let kernel = plate_error("pcf", 3.0, &["map-size=64"]).1;
    let taps = format!("taps={}", (2.0 * kernel).round());
    let tuned = |d| plate_error("pcf", d, &["map-size=64", &taps]);
    let (fitting, width) = tuned(3.0);
    assert!(fitting.max <= 1.0 / width + 1e-3, "right here: {fitting:?}");
    for d in [4.9, 5.1, 8.0] {
        let (error, width) = tuned(d);
        assert!(error.max > 5.0 * (0.5 / width + 1e-3), "{d}: {error:?}");
    }
}

/// T: variance. One random point sees the light or not: variance V(1 - V). N
/// jittered ones, each in its cell, have less, and it falls as N^-3/2, for only
/// the cells that an edge crosses vary: √N of N.
#[test]
fn variance_falls_as_predicted() {
    map_support::variance_falls_as_predicted(
        "shadow-maps-n",
        "maps",
        &["pattern=stratified", "map-size=128"],
    );
}

/// Errors on scenes with everything in them, for whoever reads the output; bounds
/// hold what was measured with some room.
#[test]
fn built_in_scenes_against_the_truth() {
    for (name, bounds) in [
        ("parallel-plates", [1e-5, 0.02, 0.01]),
        ("cylinder", [0.09, 0.10, 0.02]),
        ("creature", [0.065, 0.08, 0.03]),
        ("spheres", [0.095, 0.09, 0.055]),
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let error = |technique: &str, set: &[&str]| {
            let picture = by(technique, &scene, set);
            let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
            assert_eq!(error.mask.out_of_range, 0);
            let all = error.all.unwrap();
            let bias = figure(&picture, "bias");
            println!("{name} {technique} {set:?} bias {bias:.4}: {all:?}");
            all.rmse
        };
        let hard = error("shadow-map", &[]);
        let whole = error("pcss", &["sampling=all", "map-size=256"]);
        let sampled = error("pcss", &[]);
        let many = error("shadow-maps-n", &["maps=64"]);
        assert!(
            whole < bounds[0] && sampled < bounds[1] && many < bounds[2],
            "{name}"
        );
        assert!(many < 0.4 * hard, "{name}");
        let few = error("shadow-maps-n", &["maps=4"]);
        let coarse = error("shadow-maps-n", &["map-size=64"]);
        assert!(many < few && many < coarse, "{name}");
    }
}

/// Where light and plate are parallel, PCSS is exact for rectangles of any shape and
/// direction; others are taken for squares, which is nearly right.
#[test]
fn lights_of_every_shape_are_looked_at() {
    let mut scene = scene("parallel-plates");
    let centre = centre_of(&scene);
    // The bevels of the plate are 0.01 below its face.
    let whole = ["sampling=all", "map-size=256", "bias=0.0005"];
    let rectangle = |u: DVec3, v: DVec3| LightShape::Rectangle {
        centre,
        edge_u: u,
        edge_v: v,
    };
    let slanted = DVec3::new(0.8, 0.0, 0.6);
    let house: Vec<DVec3> = [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.3], [-0.4, 0.5]]
        .map(|[x, z]| centre + DVec3::new(x, 0.0, z))
        .to_vec();
    for (shape, bound) in [
        (rectangle(DVec3::X * 0.2, DVec3::Z * 1.4), 1e-4),
        (rectangle(slanted, DVec3::new(-0.3, 0.0, 0.4)), 0.001),
        (
            LightShape::Disc {
                centre,
                normal: DVec3::Y,
                radius: 0.5,
            },
            0.02,
        ),
        (
            LightShape::Sphere {
                centre,
                radius: 0.5,
            },
            0.03,
        ),
        (
            LightShape::Polygon(ConvexPolygon::new(house).unwrap()),
            0.04,
        ),
    ] {
        scene.lights[0].shape = shape.clone();
        let truth = truth(&scene);
        let error = rmse("pcss", &scene, &truth, &whole);
        assert!(error < bound, "{shape:?}: {error}");
        let error = rmse("shadow-maps-n", &scene, &truth, &["map-size=256"]);
        assert!(error < 0.02, "{shape:?}: {error}");
    }
}

/// Cube faces see what planar views see.
#[test]
fn cube_faces_are_as_good_as_planar_views() {
    for name in ["parallel-plates", "cylinder", "creature"] {
        let scene = scene(name);
        let truth = truth(&scene);
        for (technique, set) in [
            ("shadow-maps-n", &["maps=16", "map-size=512"][..]),
            ("pcss", &["sampling=all", "map-size=256"]),
        ] {
            let of = |view| rmse(technique, &scene, &truth, &[set, &[view]].concat());
            let [planar, cube] = ["view=planar", "view=cube"].map(of);
            assert!(
                cube < 1.25 * planar + 0.004,
                "{name} {technique}: {planar} {cube}"
            );
        }
    }
}

/// The umbra of the cube's lower face is missed by one view from the light's centre,
/// which sees the upper face alone; many views have it.
#[test]
fn one_view_misses_umbrae_that_many_views_have() {
    let scene = scene("single-silhouette");
    let truth = truth(&scene);
    let umbra = |technique: &str, set: &[&str]| {
        let picture = by(technique, &scene, set);
        let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
        error.of_region(LightRegion::Umbra).unwrap()
    };
    let one = umbra("pcss", &["sampling=all", "map-size=256"]);
    let many = umbra("shadow-maps-n", &["maps=64"]);
    println!("umbra: one view {one:?}, many {many:?}");
    assert!(one.max > 0.1 && many.rmse < 0.3 * one.rmse);
}
