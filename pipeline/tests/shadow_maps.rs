//! Shadow maps, PCF, PCSS and N shadow maps against rays, closed forms and the
//! exact oracle; and what they read, counted (IMPLEMENTING §1.11).

use gnomon_pipeline::light::{HardLight, Light, LightShape};
use gnomon_pipeline::mesh::Shading;
use gnomon_pipeline::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::oracle::hard::HardOracle;
use gnomon_pipeline::oracle::plates::ParallelPlates;
use gnomon_pipeline::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::shape;
use gnomon_pipeline::technique::{Params, find};

use glam::DVec3;

const SIZE: [u32; 2] = [120, 80];

fn scene(name: &str) -> Scene {
    builtin::build(name).unwrap()
}

fn sized(name: &str, scene: &Scene, set: &[&str], size: [u32; 2]) -> Result<Rendered, String> {
    let technique = find(name).unwrap();
    let params = Params::parse(technique, set).map_err(|e| e.to_string())?;
    let settings = RenderSettings {
        size,
        ..RenderSettings::default()
    };
    render(scene, technique, &params, &settings).map_err(|e| e.to_string())
}

fn by(name: &str, scene: &Scene, set: &[&str]) -> Rendered {
    sized(name, scene, set, SIZE).unwrap()
}

fn truth(scene: &Scene) -> VisibilityImage {
    VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap()
}

fn figure(picture: &Rendered, name: &str) -> f64 {
    let found = picture.figures.iter().find(|f| f.name == name);
    found.unwrap_or_else(|| panic!("no figure {name}")).value
}

/// Whether a shadow map that is right in every texel says so for `point`: whether
/// something is nearer to the light than the point by more than the bias, for each
/// texel that may be the point's. `None` where that depends on the texel.
fn mapped(oracle: &HardOracle, light: DVec3, point: DVec3, bias: f64, texel: f64) -> Option<bool> {
    let below = light.y - point.y;
    let blocked = |i: i32, k: i32| {
        // Half a texel to its centre, and a quarter more for rounding.
        let off = DVec3::new(f64::from(i), 0.0, f64::from(k)) * (0.25 * texel);
        let ray = (point - light) / below + off;
        oracle.shadow_count_at(light + ray * (below - bias)) > 0
    };
    let centre = blocked(0, 0);
    let alike = (-3..=3).all(|i| (-3..=3).all(|k| blocked(i, k) == centre));
    alike.then_some(centre)
}

/// A light below which all of a scene is: a horizontal square's centre.
fn centre_of(scene: &Scene) -> DVec3 {
    let HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("a point");
    };
    centre
}

/// T: one map from the light's centre is the hard shadow, away from edges.
#[test]
fn one_map_is_the_hard_shadow_away_from_edges() {
    for (name, bias) in [
        ("parallel-plates", "bias=0.01"),
        ("cylinder", "bias=0.01"),
        ("creature", "bias=0.01"),
        ("spheres", "bias=0.01"),
        ("columns", "bias=0.02"),
    ] {
        let scene = scene(name);
        let light = centre_of(&scene);
        let oracle = HardOracle::new(&scene, HardLight::Point(light));
        let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
        let plain = ["map-size=1024", "slope-bias=0", bias];
        let hard = by("shadow-map", &scene, &plain);
        let one = [&plain[..], &["maps=1", "pattern=grid"]].concat();
        let one = by("shadow-maps-n", &scene, &one);
        let (bias, texel) = (figure(&hard, "bias"), figure(&hard, "texel"));
        assert_eq!(bias, figure(&one, "bias"));
        let (mut judged, mut as_in_truth, mut surfaces, mut dark) = (0, 0, 0, 0);
        for (k, seen) in hard.visibility.iter().enumerate() {
            let place = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
            let sample = oracle.sample(&rays, place[0], place[1]);
            let Some(hit) = sample.hit.filter(|_| !seen.is_nan()) else {
                continue;
            };
            surfaces += 1;
            let point = rays.origin + rays.direction(place[0], place[1]) * hit.depth;
            let far = figure(&hard, "far");
            let Some(blocked) = mapped(&oracle, light, point, bias, texel / far) else {
                continue;
            };
            judged += 1;
            dark += usize::from(blocked);
            as_in_truth += usize::from(blocked == (sample.shadow_count > 0));
            let expected = if blocked { 0.0 } else { 1.0 };
            assert_eq!(
                (*seen, one.visibility[k]),
                (expected, expected),
                "{name} at {place:?}"
            );
        }
        println!("{name}: {judged} of {surfaces} judged, {dark} dark, {as_in_truth} as in truth");
        assert!(judged * 10 > surfaces * 8 && dark > 100, "{name}");
        // What the bias alone changes: contacts, and the unlit side of casters.
        assert!(as_in_truth * 1000 >= judged * 995, "{name}");
    }
}

/// Plate and floor under a square light, as IMPLEMENTING §5 has them, the floor at
/// distance `d` from the light.
fn plates(d: f64) -> (Scene, ParallelPlates) {
    let plates = ParallelPlates {
        light_half: 0.5,
        plate_half: 0.3,
        plate_distance: 2.0,
        floor_distance: d,
    };
    let matt = Material::matt([0.8; 3]);
    let solid = |name: &str, shape: shape::Shape| {
        Object::new(name, shape.into_mesh(Shading::Flat).unwrap(), matt)
    };
    let plate = shape::bevelled_plate(plates.plate_half, d - plates.plate_distance, 0.01, 1.6);
    let mut objects = vec![
        solid("floor", shape::plane(8.0, 0.0)).receiver_only(),
        solid("plate", plate),
    ];
    // Only the floor is of interest.
    objects[1].receives = false;
    let light = Light::horizontal_square(DVec3::Y * d, 2.0 * plates.light_half);
    // From below, as far away as 45 degrees need to see all of the penumbra.
    let away = (plates.penumbra_half() + 0.2) / 0.414_213_562;
    let mut camera = Camera::look_at([0.02, -away, 0.01], [0.0, 0.0, 0.0]);
    camera.up = DVec3::Z;
    (Scene::new(camera, vec![light], objects), plates)
}

/// Errors on the floor against the closed form, and half the width of the kernel
/// that it asks for, in texels.
fn plate_error(name: &str, d: f64, set: &[&str]) -> (ErrorSummary, f64) {
    let (scene, plates) = plates(d);
    let picture = by(name, &scene, set);
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let mut errors = Vec::new();
    for (k, seen) in picture.visibility.iter().enumerate() {
        let place = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
        let ray = rays.direction(place[0], place[1]);
        let at = rays.origin - ray * (rays.origin.y / ray.y);
        errors.push(f64::from(*seen) - plates.visibility(at.x, at.z));
    }
    let texel = figure(&picture, "texel") / figure(&picture, "far");
    let kernel = plates.light_half * (1.0 / plates.plate_distance - 1.0 / d) / texel;
    let summary = ErrorSummary::of(&errors).unwrap();
    println!("{name} {set:?} d={d}: {summary:?}, kernel {kernel:.1} texels");
    (summary, kernel)
}

const DISTANCES: [f64; 4] = [3.0, 4.9, 5.1, 8.0];

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
    const SEEDS: u32 = 24;
    let size = [40, 28];
    let scene = scene("parallel-plates");
    let truth = VisibilityImage::of_scene(&scene, 0, size, &|| ()).unwrap();
    let variance = |maps: u32| {
        let picture = |seed: u32| {
            let set = ["pattern=stratified", "map-size=128"].map(str::to_owned);
            let more = [format!("maps={maps}"), format!("seed={seed}")];
            let all: Vec<&str> = set.iter().chain(&more).map(String::as_str).collect();
            sized("shadow-maps-n", &scene, &all, size)
                .unwrap()
                .visibility
        };
        let pictures: Vec<Vec<f32>> = (0..SEEDS).map(picture).collect();
        let (mut found, mut binomial) = (0.0, 0.0);
        for (k, v) in truth.values.iter().enumerate() {
            if LightRegion::of(*v) != Some(LightRegion::Penumbra) {
                continue;
            }
            let values = pictures.iter().map(|p| f64::from(p[k]));
            let mean = values.clone().sum::<f64>() / f64::from(SEEDS);
            let squares = values.map(|x| (x - mean) * (x - mean)).sum::<f64>();
            found += squares / f64::from(SEEDS - 1);
            binomial += v * (1.0 - v);
        }
        println!("{maps} maps: variance {:.4} of V(1-V)", found / binomial);
        found / binomial
    };
    let [one, four, sixteen] = [1, 4, 16].map(variance);
    assert!((one - 1.0).abs() < 0.15, "{one}");
    assert!(four < 0.3 && sixteen < 0.08, "{four} {sixteen}");
    let fall = four / sixteen;
    assert!((5.5..11.5).contains(&fall), "8 is predicted: {fall}");
}

fn look_up(picture: &Rendered) -> gnomon_raster::Counters {
    let passes = &picture.report.passes;
    let pass = passes.iter().find(|p| p.label == "look-up").unwrap();
    pass.totals()
}

/// T: what is fetched, exactly.
#[test]
fn fetches_are_taps_times_receivers() {
    let scene = scene("cylinder");
    let of = |name: &str, set: &[&str]| look_up(&by(name, &scene, set));
    let picture = by("shadow-map", &scene, &[]);
    // All surfaces are below the light: every pixel that shows one is a receiver.
    let receivers = picture.visibility.iter().filter(|v| !v.is_nan()).count() as u64;
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    assert!(receivers > pixels / 2 && receivers < pixels);
    for (name, set, taps) in [
        ("shadow-map", &[][..], 1),
        ("pcf", &["taps=1"], 1),
        ("pcf", &["taps=4"], 16),
        ("pcf", &["taps=7"], 49),
        ("pcf", &["kernel=bicubic"], 16),
    ] {
        let counted = of(name, set);
        let fetches = counted.traffic.tex_fetches;
        assert_eq!(fetches[..2], [pixels, taps * receivers], "{name} {set:?}");
        assert_eq!(counted.fragments.written, receivers);
        // Outside the picture nothing is read.
        let texels = counted.traffic.tex[1].read_accesses;
        assert!(texels < taps * receivers && texels > 0, "{name} {set:?}");
    }
    let counted = of("pcss", &["search-samples=25", "samples=49"]);
    // Those with a blocker go on to compare, and are the ones that are written.
    let with_blocker = counted.fragments.written;
    assert!(with_blocker > 0 && with_blocker < receivers);
    let expected = 25 * receivers + 49 * with_blocker;
    assert_eq!(counted.traffic.tex_fetches[1], expected);
}

/// All texels of both kernels, counted against their areas in f64.
#[test]
fn whole_kernels_read_every_texel_once() {
    let (scene, _) = plates(4.9);
    let picture = by(
        "pcss",
        &scene,
        &["sampling=all", "map-size=64", "fit=receivers"],
    );
    let texels = look_up(&picture).traffic.tex[1].read_accesses;
    let texel = figure(&picture, "texel") / figure(&picture, "far");
    let half = |z: f64| 0.5 * (1.0 / z - 1.0 / 4.9) / texel;
    // A kernel of width w touches w + 1 texels of a row in the mean.
    let touched = |z: f64| (2.0 * half(z) + 1.0) * (2.0 * half(z) + 1.0);
    let search = touched(figure(&picture, "near")) * f64::from(SIZE[0] * SIZE[1]);
    let compared = touched(2.0) * look_up(&picture).fragments.written as f64;
    let share = texels as f64 / (search + compared);
    assert!((0.97..1.03).contains(&share), "{share}");
}

#[test]
fn one_tap_is_the_shadow_map_to_the_bit() {
    for name in ["creature", "columns"] {
        let scene = scene(name);
        let hard = by("shadow-map", &scene, &["bias=0.01"]);
        let one = by("pcf", &scene, &["taps=1", "bias=0.01"]);
        assert_eq!(hard.visibility_hash(), one.visibility_hash(), "{name}");
        let soft = by("pcf", &scene, &["kernel=bicubic", "bias=0.01"]);
        assert_ne!(hard.visibility_hash(), soft.visibility_hash(), "{name}");
    }
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

/// Whatever the scene: no NaN, nothing outside 0..=1, surfaces where there are some.
#[test]
fn odd_scenes_stay_sane() {
    let adversarial = builtin::SCENES
        .iter()
        .filter(|s| s.name.starts_with("adversarial"));
    for entry in adversarial {
        let scene = entry.build();
        for technique in ["shadow-map", "pcf", "pcss", "shadow-maps-n"] {
            let set: &[&str] = if technique == "shadow-maps-n" {
                &["maps=4"]
            } else {
                &[]
            };
            let picture = by(technique, &scene, set);
            let sane = |v: &f32| v.is_nan() || (0.0..=1.0).contains(v);
            assert!(
                picture.visibility.iter().all(sane),
                "{} {technique}",
                entry.name
            );
            let codes: Vec<&str> = picture.warnings.iter().map(|w| w.code).collect();
            assert!(
                !codes.contains(&"nan"),
                "{} {technique}: {codes:?}",
                entry.name
            );
        }
    }
}

/// A light in a closed room with a ball: walls round the light, no view can be
/// planar; and lit where nothing casts.
#[test]
fn a_light_inside_a_room_is_shadowed_all_round() {
    let mut scene = scene("cylinder");
    let room = shape::cuboid(DVec3::Y * 2.0, DVec3::new(9.0, 6.0, 14.0));
    let room = room.into_mesh(Shading::Flat).unwrap();
    let walls = Object::new("walls", room, Material::matt([0.6; 3]));
    scene.objects.push(walls);
    scene.lights[0].shape = LightShape::Point {
        position: DVec3::new(1.0, 1.2, 0.6),
    };
    let truth = truth(&scene);
    let picture = by("shadow-map", &scene, &["map-size=1024"]);
    let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
    println!("room: {:?}", error.all);
    assert!(figure(&picture, "views") >= 3.0);
    assert!(error.all.unwrap().rmse < 0.15);
    // Without any caster there is no view, and all is lit.
    scene.objects.iter_mut().for_each(|o| o.casts = false);
    let lit = by("pcss", &scene, &[]);
    assert_eq!(figure(&lit, "views"), 0.0);
    assert!(lit.visibility.iter().all(|v| v.is_nan() || *v == 1.0));
}

#[test]
fn bad_parameters_and_lights_are_refused() {
    let scene = scene("cylinder");
    let message = |name: &str, set: &str| sized(name, &scene, &[set], SIZE).unwrap_err();
    assert!(message("pcf", "taps=0").contains("1 to 64"));
    assert!(message("pcf", "taps=65").contains("1 to 64"));
    assert!(message("shadow-map", "map-size=100").contains("64|128"));
    assert!(message("shadow-map", "near=0").contains("above 0"));
    for bias in ["bias=-1", "bias=nan", "bias=inf", "bias=x"] {
        assert!(message("shadow-map", bias).contains("auto|X"), "{bias}");
    }
    assert!(message("pcss", "samples=15").contains("square numbers"));
    assert!(message("shadow-maps-n", "maps=2000").contains("square numbers"));
    let mut sun = scene.clone();
    let towards = DVec3::Y;
    sun.lights[0].shape = LightShape::Directional { towards };
    for name in ["shadow-map", "pcf", "pcss", "shadow-maps-n"] {
        let message = sized(name, &sun, &[], SIZE).unwrap_err();
        assert!(message.contains("directional"), "{message}");
    }
}

/// A bias in world units does what it says: blockers nearer than it do not count.
#[test]
fn the_bias_is_in_world_units() {
    let (scene, _) = plates(3.0);
    // The plate is 1 nearer to the light than the floor.
    let dark = |bias: &str| {
        let picture = by("shadow-map", &scene, &[bias]);
        picture.visibility.iter().filter(|v| **v == 0.0).count()
    };
    assert_eq!(dark("bias=0.99"), dark("bias=0"));
    assert!(dark("bias=0") > 100);
    assert_eq!(dark("bias=1.02"), 0);
}
