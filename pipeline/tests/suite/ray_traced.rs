//! Shadow rays in a shader against the hard truth, the closed form and the exact oracle
//! (docs/papers.md, baselines).

use crate::map_support::{
    self, SIZE, by, error, figure, plates, sampled_plate_error, scene, sized, truth,
};
use glam::{DMat4, DVec3};
use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth};
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;
use gnomon_shaders::shadow_rays::SHADOW_RAYS;

fn lit_by(name: &str, shape: LightShape) -> Scene {
    let mut scene = scene(name);
    scene.lights[0].shape = shape;
    scene
}

/// Pixels that have no excuse to differ from the hard truth, and those that do.
fn against_the_hard_truth(scene: &Scene, set: &[&str]) -> [usize; 3] {
    let picture = by("ray-traced", scene, set);
    let truth = HardTruth::of_scene(scene, 0, SIZE, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
    let (mut judged, mut dark, mut wrong) = (0, 0, 0);
    for (pixel, seen) in truth.pixels.iter().zip(&picture.visibility) {
        if !pixel.interior || pixel.centre.hit.is_none() || seen.is_nan() {
            continue;
        }
        judged += 1;
        dark += usize::from(!pixel.is_lit());
        wrong += usize::from((*seen == 1.0) != pixel.is_lit());
    }
    println!(
        "{} {set:?}: {judged} judged, {dark} dark, {wrong} wrong",
        scene.name
    );
    [judged, dark, wrong]
}

const POINTS: [LightShape; 3] = [
    LightShape::Point {
        position: DVec3::new(1.4, 4.0, 1.1),
    },
    LightShape::Point {
        position: DVec3::new(-2.0, 3.0, 2.5),
    },
    LightShape::Directional {
        towards: DVec3::new(0.5, 1.0, 0.4),
    },
];

/// T: one ray to a point is the hard truth, at every pixel that has no excuse.
#[test]
fn one_ray_is_the_hard_shadow() {
    let mut all_dark = 0;
    for name in ["cylinder", "creature", "columns", "spheres"] {
        for shape in POINTS {
            let [judged, dark, wrong] = against_the_hard_truth(&lit_by(name, shape), &[]);
            assert!(judged > 3000, "{name}: {judged}");
            assert_eq!(wrong, 0, "{name}");
            all_dark += dark;
        }
    }
    assert!(all_dark > 800, "{all_dark}");
}

/// Negative control: rays that start on their surfaces meet them.
#[test]
fn rays_from_the_surface_itself_meet_it() {
    let scene = lit_by("spheres", POINTS[0].clone());
    assert!(against_the_hard_truth(&scene, &["bias=0"])[2] > 0);
    // Far off their surfaces they pass casters by.
    assert!(against_the_hard_truth(&scene, &["bias=0.3"])[2] > 20);
}

/// T: the closed form within the steps of N points: each edge crosses √N of the cells, in
/// each of which a point is anywhere.
#[test]
fn many_rays_are_the_closed_form_within_their_steps() {
    for d in [3.0, 8.0] {
        for (set, side) in [("samples=16", 4.0f64), ("samples=256", 16.0)] {
            let error = sampled_plate_error("ray-traced", d, &[set]);
            // Two edges along each axis, no more than a cell wide.
            assert!(error.max <= 4.0 / side, "{d} {set}: {error:?}");
            // Standard deviation of one edge: √(N^1/2 / 6) / N.
            let expected = (side / 6.0).sqrt() / (side * side);
            assert!(error.rmse < 1.5 * expected, "{d} {set}: {error:?}");
            assert!(error.mean.abs() < 0.1 * expected, "{d} {set}: {error:?}");
        }
    }
}

/// T: variance. One point sees the light or not: V(1 - V). N jittered ones, each in its
/// cell, have less, falling as N^-3/2, for only cells that an edge crosses vary.
#[test]
fn variance_falls_as_predicted() {
    map_support::variance_falls_as_predicted("ray-traced", "samples", &[]);
}

/// Scenes with everything in them, and lights of every shape: the oracle, but for noise.
#[test]
fn scenes_are_the_truth_but_for_noise() {
    let centre = DVec3::new(1.4, 4.0, 1.1);
    let sphere = LightShape::Sphere {
        centre,
        radius: 0.5,
    };
    let disc = LightShape::Disc {
        centre,
        normal: DVec3::new(-0.2, -1.0, -0.1),
        radius: 0.5,
    };
    for scene in [
        scene("cylinder"),
        scene("creature"),
        scene("spheres"),
        scene("single-silhouette"),
        lit_by("cylinder", sphere),
        lit_by("cylinder", disc),
    ] {
        let truth = truth(&scene);
        let of = |set: &str| error("ray-traced", &scene, &truth, &[set]);
        let [few, many] = ["samples=16", "samples=144"].map(of);
        assert!(many.rmse < 0.01 && many.mean.abs() < 1e-3, "{}", scene.name);
        // N^-3/4: 5.2. Single pixels at the end of a surface may be wrong with any N.
        let fall = few.p99 / many.p99;
        assert!((3.5..7.5).contains(&fall), "{}: {fall}", scene.name);
    }
}

/// Rays end at their light: what lies behind it hides nothing.
#[test]
fn casters_behind_a_light_hide_nothing() {
    let mut scene = lit_by("cylinder", POINTS[0].clone());
    // Aslant, so that its triangles' boxes reach below the light.
    let aslant = DMat4::from_translation(DVec3::new(0.0, 7.0, 0.0)) * DMat4::from_rotation_x(0.5);
    let above = shape::cuboid(DVec3::ZERO, DVec3::new(20.0, 0.2, 20.0)).transformed(aslant);
    let without = by("ray-traced", &scene, &[]);
    let lid = above.into_mesh(Shading::Flat).unwrap();
    let matt = Material::matt([0.7; 3]);
    scene.objects.push(Object::new("lid", lid, matt));
    let with = by("ray-traced", &scene, &[]);
    let lit = without.visibility.iter().filter(|v| **v == 1.0).count();
    assert!(lit > 1000, "{lit}");
    let same = |(a, b): (&f32, &f32)| a.is_nan() || a == b;
    assert!(without.visibility.iter().zip(&with.visibility).all(same));
}

/// A facet that casts is lit on the side that is seen, be it its back: rays start there.
#[test]
fn facets_that_are_seen_from_behind_are_lit_from_there() {
    for height in [4.0, -4.0] {
        let mut light = builtin::build("cylinder").unwrap().lights[0].clone();
        light.shape = LightShape::Point {
            position: DVec3::new(0.3, height, 0.2),
        };
        let mut camera = Camera::look_at([0.0, height / 2.0, 0.0], [0.0, 0.0, 0.0]);
        camera.up = DVec3::Z;
        let sheet = shape::plane(1.0, 0.0).into_mesh(Shading::Flat).unwrap();
        let objects = vec![Object::new("sheet", sheet, Material::matt([0.7; 3]))];
        let picture = by("ray-traced", &Scene::new(camera, vec![light], objects), &[]);
        let seen = picture.visibility.iter().filter(|v| !v.is_nan());
        let (lit, dark): (Vec<&f32>, Vec<&f32>) = seen.partition(|v| **v == 1.0);
        assert!(
            lit.len() > 200 && dark.is_empty(),
            "{height}: {}",
            dark.len()
        );
    }
}

/// Nothing slips between triangles: inside a closed ball no light is seen, wherever rays
/// go through edges and corners.
#[test]
fn no_ray_slips_between_triangles() {
    let matt = Material::matt([0.7; 3]);
    let solid = |shape: shape::Shape| shape.into_mesh(Shading::Flat).unwrap();
    let ball = solid(shape::icosphere(3, 2.0, DVec3::ZERO));
    let floor = solid(shape::plane(1.0, 0.0));
    let mut camera = Camera::look_at([0.0, 1.0, 0.0], [0.0, 0.0, 0.0]);
    camera.up = DVec3::Z;
    let mut light = builtin::build("cylinder").unwrap().lights[0].clone();
    light.shape = LightShape::Sphere {
        centre: DVec3::new(0.0, 9.0, 0.0),
        radius: 3.0,
    };
    let objects = vec![
        Object::new("floor", floor, matt).receiver_only(),
        Object::new("ball", ball, matt),
    ];
    let scene = Scene::new(camera, vec![light], objects);
    let picture = by("ray-traced", &scene, &["samples=64"]);
    let rays = figure(&picture, SHADOW_RAYS);
    assert!(rays > 500_000.0, "{rays}");
    assert!(picture.visibility.iter().all(|v| *v == 0.0));
}

/// Rays and points are counted exactly, and boxes leave most of the scene out.
#[test]
fn rays_and_fetches_are_counted() {
    let scene = scene("creature");
    let picture = by("ray-traced", &scene, &["samples=16"]);
    let receivers = picture.visibility.iter().filter(|v| !v.is_nan()).count() as u64;
    assert_eq!(figure(&picture, SHADOW_RAYS), (16 * receivers) as f64);
    let passes = &picture.report.passes;
    let pass = passes.iter().find(|p| p.label == "shadow rays").unwrap();
    let fetches = pass.totals().traffic.tex_fetches;
    assert_eq!(fetches[0], u64::from(SIZE[0] * SIZE[1]));
    let casters = scene.objects.iter().filter(|o| o.casts);
    let triangles = casters
        .map(|o| o.mesh.triangles().len() as u64)
        .sum::<u64>();
    let per_ray = fetches[1] as f64 / (16 * receivers) as f64;
    println!("{triangles} triangles, {per_ray} texels of nodes a ray");
    assert!(per_ray >= 2.0 && per_ray < 0.1 * 4.0 * triangles as f64);
    let all_nothing = by("ray-traced", &without_casters(&scene), &["samples=4"]);
    assert!(
        all_nothing
            .visibility
            .iter()
            .all(|v| v.is_nan() || *v == 1.0)
    );
}

fn without_casters(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.objects.iter_mut().for_each(|o| o.casts = false);
    scene
}

#[test]
fn bad_parameters_and_lights_are_refused() {
    let (mut scene, _) = plates(3.0);
    for (set, told) in [
        ("samples=15", "square numbers"),
        ("block=3", "a power of two, 1 to 32"),
        ("bias=-1", "auto, or a number from 0"),
    ] {
        let message = sized("ray-traced", &scene, &[set], SIZE).unwrap_err();
        assert!(message.contains(told), "{set}: {message}");
    }
    let towards = DVec3::ZERO;
    scene.lights[0].shape = LightShape::Directional { towards };
    let message = sized("ray-traced", &scene, &[], SIZE).unwrap_err();
    assert!(message.contains("direction is"), "{message}");
}
