//! Masks convolved with the light, and projections counted on planes, against the closed
//! form and the exact oracle (docs/papers.md, baselines).

use std::collections::BTreeSet;

use crate::map_support::{
    SIZE, by, error, plate_error, plates, sampled_plate_error, scene, sized, truth,
};
use glam::DVec3;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::truth::oracle::hard::HardOracle;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::Scene;

/// T: with occluders in one plane a convolved mask is the closed form, within half a
/// texel at each edge.
#[test]
fn convolved_masks_are_the_closed_form_within_texels() {
    for d in [3.0, 4.9, 8.0] {
        let set = ["plane=nearest", "fit=receivers", "map-size=256"];
        let (error, kernel) = plate_error("soler-sillion", d, &set);
        let bound = 0.5 / kernel + 5e-3;
        assert!(error.max <= bound, "{d}: {error:?} above {bound}");
    }
}

/// T, negative control: two plates at different distances are not in one plane, wherever
/// that is.
#[test]
fn one_plane_fails_where_occluders_are_in_two() {
    let (mut scene, plates) = plates(8.0);
    let mut lower = scene.objects[1].clone();
    let moved = lower.mesh.as_ref().clone();
    let down = |p: &[f32; 3]| [p[0] + 1.2, p[1] - 4.0, p[2]];
    let positions = moved.positions().iter().map(down).collect();
    let mesh = Mesh::new(positions, moved.triangles().to_vec(), Shading::Flat);
    lower.mesh = std::sync::Arc::new(mesh.unwrap());
    scene.objects.push(lower);
    assert!(plates.floor_distance > 7.0);
    let truth = truth(&scene);
    for plane in ["plane=nearest", "plane=middle", "plane=farthest"] {
        let found = error("soler-sillion", &scene, &truth, &[plane]);
        assert!(found.max > 0.1, "{plane}: {found:?}");
    }
    let right = error("ray-traced", &scene, &truth, &["samples=256"]);
    assert!(right.rmse < 0.01, "{right:?}");
}

/// The scene with receivers that do not cast and nothing else.
fn floor_only(name: &str) -> Scene {
    let mut scene = scene(name);
    scene.objects.iter_mut().for_each(|o| o.receives = !o.casts);
    scene
}

/// Root mean square error where a receiver that does not cast is seen.
fn on_floors(technique: &str, scene: &Scene, truth: &VisibilityImage, set: &[&str]) -> f64 {
    let picture = by(technique, scene, set);
    let oracle = HardOracle::new(scene, scene.lights[0].hard());
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let (mut squares, mut pixels) = (0.0, 0.0);
    for (k, (seen, known)) in picture.visibility.iter().zip(&truth.values).enumerate() {
        let place = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
        let hit = oracle.sample(&rays, place[0], place[1]).hit;
        let floor = hit.is_some_and(|h| scene.objects[h.object as usize].receives);
        if floor && !seen.is_nan() {
            let error = f64::from(*seen) - known;
            squares += error * error;
            pixels += 1.0;
        }
    }
    let rmse = f64::sqrt(squares / pixels);
    println!(
        "{} {technique} {set:?}: {rmse:.5} over {pixels} pixels",
        scene.name
    );
    assert!(pixels > 2000.0);
    rmse
}

/// Receivers that do not cast, in scenes with everything in them.
#[test]
fn floors_of_built_in_scenes_against_the_truth() {
    for name in ["cylinder", "creature", "spheres"] {
        let scene = floor_only(name);
        let truth = truth(&scene);
        let none = on_floors("unshadowed", &scene, &truth, &[]);
        let mask = on_floors("soler-sillion", &scene, &truth, &[]);
        let counted = on_floors("heckbert-herf", &scene, &truth, &[]);
        assert!(mask < 0.45 * none, "{name}: {mask} of {none}");
        assert!(counted < 0.03, "{name}: {counted}");
    }
}

/// Receivers that are not in their own masks, in whole scenes: nearer to the truth than with
/// one mask of everything, but where no piece is convex (`peer-c`), which changes nothing.
#[test]
fn masks_without_their_receivers_are_nearer_to_the_truth() {
    let mut failed = Vec::new();
    for (name, bound, gain) in [
        ("spheres", 0.053, 0.7),
        ("cylinder", 0.036, 0.7),
        ("two-box", 0.028, 0.7),
        ("peer-a", 0.034, 0.6),
        ("peer-b", 0.075, 0.75),
        ("peer-c", 0.04, 1.0),
        ("overlap", 0.07, 0.97),
        ("creature", 0.061, 0.95),
        ("columns", 0.15, 0.9),
        ("demo", 0.105, 0.8),
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let of = |set: &str| error("soler-sillion", &scene, &truth, &["horizon=on", set]).rmse;
        let [all, each] = ["groups=all", "groups=each"].map(of);
        println!("{name}: {each:.4} of {all:.4}");
        if each >= bound || each > gain * all {
            failed.push(format!("{name}: {each} of {all}"));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

/// Objects that stay in their own masks, being not convex, are told of.
#[test]
fn receivers_in_their_own_masks_are_told_of() {
    let told = |name: &str, set: &[&str]| {
        let warnings = by("soler-sillion", &scene(name), set).warnings;
        warnings.iter().any(|w| w.code == "receivers-that-cast")
    };
    assert!(told("peer-c", &[]) && told("peer-c", &["groups=all"]));
    assert!(!told("spheres", &[]) && told("spheres", &["groups=all"]));
}

/// T: counts are whole numbers, so that there are N + 1 levels at most.
#[test]
fn projections_have_as_many_levels_as_points() {
    let scene = floor_only("creature");
    for points in [4u32, 16, 64, 256] {
        let set = format!("samples={points}");
        let picture = by("heckbert-herf", &scene, &[&set]);
        let n = f64::from(points);
        let mut levels = BTreeSet::new();
        for v in picture.visibility.iter().filter(|v| !v.is_nan()) {
            let count = f64::from(*v) * n;
            assert!(
                (count - count.round()).abs() < 1e-3 * n.max(1.0) / 64.0,
                "{v}"
            );
            levels.insert(count.round() as i64);
        }
        println!("{points} points: {} levels", levels.len());
        assert!(levels.len() <= points as usize + 1);
        assert!(levels.len() > points as usize / 3);
    }
}

/// T: the closed form within the steps of N points, more than one stencil keeps apart
/// among them.
#[test]
fn projections_are_the_closed_form_within_their_steps() {
    for d in [3.0, 8.0] {
        let mut before = f64::INFINITY;
        for (set, side) in [
            ("samples=16", 4.0f64),
            ("samples=64", 8.0),
            ("samples=256", 16.0),
        ] {
            let error = sampled_plate_error("heckbert-herf", d, &[set]).rmse;
            assert!(error <= 0.5 / side, "{d} {set}: {error}");
            assert!(error < 0.8 * before, "{d} {set}: {error}");
            before = error;
        }
    }
}

/// Points and directions have one projection, which is the hard shadow.
#[test]
fn one_projection_is_the_hard_shadow() {
    for shape in [
        LightShape::Point {
            position: DVec3::new(1.4, 4.0, 1.1),
        },
        LightShape::Directional {
            towards: DVec3::new(0.5, 1.0, 0.4),
        },
    ] {
        let mut scene = floor_only("creature");
        scene.lights[0].shape = shape;
        let truth = truth(&scene);
        let of = |set: &str| on_floors("heckbert-herf", &scene, &truth, &[set]);
        let [fine, coarse] = ["map-size=1024", "map-size=32"].map(of);
        assert!(fine < 0.06 && fine < 0.6 * coarse, "{fine} {coarse}");
    }
}

/// Receivers that are not flat are lit, and that is said.
#[test]
fn receivers_that_are_not_flat_are_told() {
    let codes = |scene: &Scene| -> Vec<&'static str> {
        let picture = by("heckbert-herf", scene, &["samples=4"]);
        picture.warnings.iter().map(|w| w.code).collect()
    };
    assert!(codes(&scene("spheres")).contains(&"receivers-not-flat"));
    assert!(!codes(&floor_only("spheres")).contains(&"receivers-not-flat"));
}

#[test]
fn bad_parameters_are_refused() {
    let (scene, _) = plates(3.0);
    for (name, set, told) in [
        ("heckbert-herf", "samples=15", "square numbers"),
        ("heckbert-herf", "map-size=100", "a power of two"),
        ("soler-sillion", "plane=top", "nearest"),
    ] {
        let message = sized(name, &scene, &[set], SIZE).unwrap_err();
        assert!(message.contains(told), "{name} {set}: {message}");
    }
}
