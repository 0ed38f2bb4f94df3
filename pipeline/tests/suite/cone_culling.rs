//! Cone culling (Bavoil and Silva 2006) against brute force, the closed form of solid
//! angles and the exact oracle.

use crate::map_support::{figure, sized};
use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape::{self, Shape};
use gnomon_raster::Counters;

const SIZE: [u32; 2] = [72, 48];

fn drawn(scene: &Scene, set: &[&str]) -> Rendered {
    sized("cone-culling", scene, set, SIZE).unwrap()
}

fn sphere(centre: DVec3, radius: f64) -> Light {
    Light {
        shape: LightShape::Sphere { centre, radius },
        colour: [1.0; 3],
    }
}

fn solid(name: &str, shape: Shape) -> Object {
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    Object::new(name, mesh, Material::matt([0.8; 3]))
}

/// Plates over a floor, each with centre and half side, under a sphere; the plates are
/// not looked at.
fn under_plates(plates: &[(DVec3, f64)], radius: f64) -> Scene {
    let plate = |(at, half): &(DVec3, f64)| {
        let shape = shape::bevelled_plate(*half, at.y, 0.01, 1.6);
        let mut plate = solid("plate", shape.translated(DVec3::new(at.x, 0.0, at.z)));
        plate.receives = false;
        plate
    };
    let floor = solid("floor", shape::plane(8.0, 0.0)).receiver_only();
    let objects = [floor].into_iter().chain(plates.iter().map(plate));
    let mut camera = Camera::look_at([0.02, -5.0, 0.01], [0.0, 0.0, 0.0]);
    camera.up = DVec3::Z;
    let light = sphere(DVec3::Y * 4.0, radius);
    Scene::new(camera, vec![light], objects.collect())
}

fn one_plate() -> Scene {
    under_plates(&[(DVec3::Y * 1.5, 0.6)], 0.4)
}

fn with_sphere(name: &str) -> Scene {
    let mut scene = builtin::build(name).unwrap();
    scene.lights[0] = sphere(DVec3::new(1.4, 4.0, 1.1), 0.45);
    scene.lights.truncate(1);
    scene
}

/// Counters of all passes of a role.
fn counters(done: &Rendered, role: PassRole) -> Counters {
    let mut all = Counters::default();
    let passes = done.report.passes.iter().enumerate();
    for (_, pass) in passes.filter(|(k, _)| done.roles.of_pass(*k) == role) {
        all.add(&pass.totals());
    }
    all
}

fn rms_between(a: &Rendered, b: &Rendered) -> f64 {
    let both = a.visibility.iter().zip(&b.visibility);
    let squares = both.filter(|(x, _)| !x.is_nan()).map(|(x, y)| {
        let off = f64::from(x - y);
        off * off
    });
    let (sum, n) = squares.fold((0.0, 0.0), |(s, n), q| (s + q, n + 1.0));
    (sum / n).sqrt()
}

/// T: the tree finds what brute force finds, patch for patch, so that sums have the same
/// bits; and reads far less.
#[test]
fn the_tree_finds_the_set_of_brute_force() {
    for (name, scene) in [
        ("cylinder", with_sphere("cylinder")),
        ("creature", with_sphere("creature")),
        ("wireframe", builtin::build("wireframe").unwrap()),
        ("plate", one_plate()),
    ] {
        for form in ["patches=spheres", "patches=rectangles"] {
            let of = |method| drawn(&scene, &[method, form, "map-size=64"]);
            let [tree, all, kernel] = ["method=octree", "method=all", "method=kernel"].map(of);
            assert_eq!(tree.visibility_hash(), all.visibility_hash(), "{name}");
            let held = |done: &Rendered| figure(done, "patches-in-cones");
            assert!(held(&all) > 1000.0, "{name}: {}", held(&all));
            assert_eq!(held(&tree), held(&all), "{name}");
            let read = |done: &Rendered| {
                let fetches = counters(done, PassRole::LookUp).traffic.tex_fetches;
                fetches[1..].iter().sum::<u64>()
            };
            println!("{name} {form}: {} of {} fetches", read(&tree), read(&all));
            assert!(4 * read(&tree) < read(&all), "{name}");
            // Negative control: another set of patches shows.
            assert_ne!(kernel.visibility_hash(), all.visibility_hash(), "{name}");
            assert_ne!(held(&kernel), held(&all), "{name}");
        }
    }
}

/// T: with more and more points the kernel becomes brute force.
#[test]
fn kernels_become_brute_force_as_points_become_texels() {
    for (name, scene) in [
        ("plate", one_plate()),
        ("cylinder", with_sphere("cylinder")),
    ] {
        let base = ["map-size=64", "patches=rectangles"];
        let of = |set: &[&str]| drawn(&scene, &[&base, set].concat());
        let truth = of(&["method=all"]);
        let off = |samples: &str| rms_between(&of(&[samples]), &truth);
        let [few, paper, many] = ["samples=16", "samples=88", "samples=4096"].map(off);
        println!("{name}: {few} {paper} {many}");
        assert!(paper < 0.7 * few && many < 0.35 * paper, "{name}");
        assert!(many < 0.012, "{name}: {many}");
        // Negative control: towards its own truth, not towards the other patches'.
        let other = rms_between(&of(&["samples=4096", "patches=spheres"]), &truth);
        assert!(other > 4.0 * many, "{name}: {other}");
        // Whatever the density, the weights make up for it.
        let even = rms_between(&of(&["samples=4096", "spread=4"]), &truth);
        assert!(even < 0.03, "{name}: {even}");
    }
}

/// Discs reach to the far corners of texels: on a picture of few texels, where that is most
/// of the disc, nothing that cones hold is missed on the whole.
#[test]
fn discs_miss_no_patch_of_a_coarse_picture() {
    let scene = one_plate();
    let base = ["map-size=16", "patches=rectangles"];
    let mean = |set: &[&str]| {
        let done = drawn(&scene, &[&base, set].concat());
        let seen = done.visibility.iter().filter(|v| !v.is_nan());
        let (sum, count) = seen.fold((0.0, 0u32), |(s, n), v| (s + f64::from(*v), n + 1));
        sum / f64::from(count)
    };
    let all = mean(&["method=all"]);
    let found = mean(&["samples=4096", "spread=4"]);
    println!("{all} {found}");
    assert!(all < 0.97, "{all}");
    assert!((found - all).abs() < 0.1 * (1.0 - all), "{found} {all}");
}

/// T: as many fetches as points for each receiver, and no more.
#[test]
fn each_receiver_looks_up_88_patches() {
    let scene = with_sphere("cylinder");
    for (set, points) in [(&["map-size=64"][..], 88), (&["samples=17"], 17)] {
        let done = drawn(&scene, set);
        let looked = counters(&done, PassRole::LookUp);
        let traffic = &looked.traffic;
        let receivers = done.visibility.iter().filter(|v| !v.is_nan()).count() as u64;
        assert!(receivers > 1000);
        assert_eq!(traffic.tex_fetches[1], points * receivers, "{set:?}");
        // Positions once for each pixel, and nothing else.
        assert_eq!(traffic.tex_fetches[0], u64::from(SIZE[0] * SIZE[1]));
        assert_eq!(traffic.tex_fetches[2..].iter().sum::<u64>(), 0);
    }
}

/// T: spheres round facing patches hide π/2 of what the patches do, so that umbrae are too
/// large by what that adds.
#[test]
fn spheres_hide_half_pi_of_what_facing_patches_hide() {
    let ratios = |scene: &Scene| {
        let of = |form| drawn(scene, &["method=octree", form, "map-size=128"]);
        let [spheres, rectangles] = ["patches=spheres", "patches=rectangles"].map(of);
        let both = spheres.visibility.iter().zip(&rectangles.visibility);
        // Where neither is clamped, and there is something to compare.
        let unclamped = both.filter(|(s, r)| **s > 0.01 && **r < 0.99);
        let ratios: Vec<f64> = unclamped
            .map(|(s, r)| f64::from(1.0 - s) / f64::from(1.0 - r))
            .collect();
        assert!(ratios.len() > 100);
        ratios.iter().sum::<f64>() / ratios.len() as f64
    };
    // From almost straight below a small plate.
    let mut facing = under_plates(&[(DVec3::Y * 2.0, 0.12)], 0.15);
    facing.camera.eye = DVec3::new(0.01, -1.3, 0.0);
    let facing = ratios(&facing);
    println!("{facing}");
    assert!(
        (facing - std::f64::consts::FRAC_PI_2).abs() < 0.03,
        "{facing}"
    );
    // Negative control: patches far off the view's axis are seen aslant and hide less; their
    // spheres do not.
    let aslant = ratios(&under_plates(&[(DVec3::new(1.1, 2.0, 0.0), 0.2)], 0.25));
    println!("{aslant}");
    assert!(aslant > 1.08 * facing, "{aslant}");
}

struct Quality {
    rmse: f64,
    mean: f64,
    umbra: Option<f64>,
}

fn against_truth(scene: &Scene, set: &[&str]) -> Quality {
    let truth = VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap();
    let done = drawn(scene, set);
    let error = VisibilityError::measure(&truth, SIZE, &done.visibility).unwrap();
    let all = error.all.unwrap();
    let umbra = error.of_region(LightRegion::Umbra).map(|u| u.rmse);
    println!("{set:?}: {all:?}, umbra {umbra:?}");
    Quality {
        rmse: all.rmse,
        mean: all.mean,
        umbra,
    }
}

/// T: right where shadows do not overlap, by rectangles; too dark by spheres; and wrong
/// where they overlap.
#[test]
fn shadows_that_do_not_overlap_are_right() {
    let one = one_plate();
    let exact = ["method=octree", "map-size=256"];
    let rectangles = against_truth(&one, &exact);
    assert!(rectangles.rmse < 0.01, "{}", rectangles.rmse);
    let spheres = against_truth(&one, &["map-size=256", "method=octree", "patches=spheres"]);
    assert!(spheres.mean < -0.01 && spheres.rmse > 5.0 * rectangles.rmse);
    // Umbrae too large, none too small.
    assert!(spheres.umbra.unwrap() < 1e-3, "{:?}", spheres.umbra);
    let paper = against_truth(&one, &["map-size=256"]);
    assert!(paper.rmse < 1.5 * spheres.rmse + 0.02, "{}", paper.rmse);
    // One plate behind the other: the light's centre does not see the lower one's middle,
    // and what of it is seen is added to the upper one's.
    let two = [
        (DVec3::new(0.0, 2.2, 0.0), 0.35),
        (DVec3::new(0.25, 1.0, 0.0), 0.35),
    ];
    let overlapping = against_truth(&under_plates(&two, 0.7), &exact);
    let apart = [
        (DVec3::new(-0.9, 2.2, 0.0), 0.35),
        (DVec3::new(1.2, 1.0, 0.0), 0.35),
    ];
    let apart = against_truth(&under_plates(&apart, 0.3), &exact);
    assert!(apart.rmse < 0.012, "{}", apart.rmse);
    assert!(overlapping.rmse > 4.0 * apart.rmse, "{}", overlapping.rmse);
}

/// Patches are four float channels, written once for each texel covered.
#[test]
fn patches_take_sixteen_bytes_a_texel() {
    let done = drawn(&one_plate(), &["map-size=128"]);
    let views = counters(&done, PassRole::LightView);
    let written = views.traffic.color[0];
    assert!(written.write_accesses > 1000);
    assert_eq!(written.write_bytes, 16 * written.write_accesses);
}

/// Lights that are no spheres are taken for some, and it is said; lights without size are
/// refused.
#[test]
fn other_lights_are_spheres_of_their_area() {
    let scene = builtin::build("cylinder").unwrap();
    let set = ["map-size=256", "method=octree"];
    let done = drawn(&scene, &set);
    assert!(done.warnings.iter().any(|w| w.code == "light-as-sphere"));
    let LightShape::Rectangle {
        centre,
        edge_u,
        edge_v,
    } = scene.lights[0].shape
    else {
        panic!("a rectangle");
    };
    let mut ball = scene.clone();
    let area = edge_u.cross(edge_v).length();
    ball.lights[0] = sphere(centre, (area / std::f64::consts::PI).sqrt());
    let ball = drawn(&ball, &set);
    assert!(ball.warnings.iter().all(|w| w.code != "light-as-sphere"));
    let off = rms_between(&done, &ball);
    assert!(off < 0.05, "{off}");
    let mut point = scene.clone();
    point.lights[0].shape = LightShape::Point { position: centre };
    let refused = sized("cone-culling", &point, &[], SIZE).unwrap_err();
    assert!(
        refused.contains("light 0") && refused.contains("no size"),
        "{refused}"
    );
}

/// What is inside the light, or looks at it so steeply that a view need not hold its whole
/// cone, is counted.
#[test]
fn receivers_in_the_light_and_wide_cones_are_counted() {
    let plain = drawn(&one_plate(), &["map-size=64"]);
    assert_eq!(
        figure(&plain, "inside-light") + figure(&plain, "wide-cones"),
        0.0
    );
    let mut low = one_plate();
    low.lights[0] = sphere(DVec3::Y * 0.3, 0.5);
    low.objects.remove(1);
    low.objects.push(solid(
        "ball",
        shape::icosphere(2, 0.2, DVec3::new(1.0, 0.1, 0.0)),
    ));
    let low = drawn(&low, &["map-size=64", "view=planar"]);
    assert!(figure(&low, "inside-light") > 0.0);
    assert!(figure(&low, "wide-cones") > 0.0);
}
