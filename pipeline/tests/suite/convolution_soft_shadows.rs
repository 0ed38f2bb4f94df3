//! Convolution soft shadows against closed forms and the exact oracle, and against
//! themselves where nothing may change a bit.

use crate::drawing::drawn_on;
use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::truth::oracle::hard::HardOracle;
use gnomon_pipeline::world::light::{HardLight, Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::builtin::PLATES;
use gnomon_pipeline::world::scene::{Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;
use gnomon_raster::{Counters, GpuConfig, SimdLevel};
use gnomon_shaders::convolution::visibility::BELOW_THRESHOLD;

const SIZE: [u32; 2] = [120, 80];

fn soft(scene: &Scene, set: &[&str]) -> Rendered {
    with(scene, set, GpuConfig::default())
}

fn with(scene: &Scene, set: &[&str], gpu: GpuConfig) -> Rendered {
    drawn_on(scene, "convolution-soft-shadows", set, SIZE, gpu)
}

/// Pixels of the floor y = 0 that nothing hides, and where they are.
fn floor_pixels(scene: &Scene, picture: &Rendered) -> Vec<(usize, DVec3)> {
    let [w, h] = picture.size;
    let rays = scene.camera.eye_rays(w, h);
    let [_, _, forward] = scene.camera.basis();
    let mut found = Vec::new();
    for i in 0..picture.visibility.len() {
        let [x, y] = [i as u32 % w, i as u32 / w].map(|c| f64::from(c) + 0.5);
        let direction = rays.direction(x, y);
        let t = -rays.origin.y / direction.y;
        let p = rays.origin + direction * t;
        let distance = (p - rays.origin).dot(forward);
        let depth = 1.0 - scene.camera.near / distance;
        let seen = t > 0.0 && (f64::from(picture.depth[i]) - depth).abs() < 1e-5;
        if seen && p.abs().max_element() < 4.0 {
            found.push((i, p));
        }
    }
    found
}

/// Error against the closed form on the floor: RMS and largest.
fn floor_error(scene: &Scene, set: &[&str]) -> [f64; 2] {
    let picture = soft(scene, set);
    let pixels = floor_pixels(scene, &picture);
    assert!(pixels.len() > 1000);
    let error =
        |&(i, p): &(usize, DVec3)| f64::from(picture.visibility[i]) - PLATES.visibility(p.x, p.z);
    let errors: Vec<f64> = pixels.iter().map(error).collect();
    let square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
    let largest = errors.iter().map(|e| e.abs()).fold(0.0, f64::max);
    println!("{set:?}: rms {:.5}, largest {largest:.4}", square.sqrt());
    [square.sqrt(), largest]
}

fn plates() -> Scene {
    builtin::build("parallel-plates").unwrap()
}

/// The pass called `label`, and its draw's counters.
fn counted(picture: &Rendered, label: &str) -> Counters {
    let mut sum = Counters::default();
    let passes = picture.report.passes.iter().filter(|p| p.label == label);
    passes.for_each(|p| sum.add(&p.totals()));
    sum
}

/// What is left of the closed form is the threshold, and the border texels that the
/// expansion's overshoot hides: two of the 282 of a kernel at 512.
#[test]
fn parallel_plates_are_nearly_the_closed_form() {
    for filter in [
        "filter=mip",
        "filter=sat",
        "filter=sat-mean",
        "filter=sat-u32",
    ] {
        let set = [filter, "a=0"];
        let [rms, largest] = floor_error(&plates(), &set);
        assert!(rms < 0.004 && largest < 0.021, "{filter}");
    }
    // Twice what exceeds 1/2 leaves the ringing of shadows, and adds to it.
    let [rms, largest] = floor_error(&plates(), &["ringing=double", "a=0"]);
    assert!(rms < 0.006 && (0.021..0.04).contains(&largest), "double");
    // One term that rings, of a coarse picture, is off by far more.
    let fixed = [
        "filter=sat",
        "a=0",
        "map-size=64",
        "m=1",
        "ringing=none",
        "offset=0",
    ];
    assert!(floor_error(&plates(), &fixed)[0] > 0.01);
}

/// The plates again, and far below the floor another one that widens the range of
/// depths: what the floor sees of the plate is then at the series' transition.
#[test]
fn the_error_falls_with_the_order() {
    let mut scene = plates();
    let below = shape::plane(40.0, -9.0).into_mesh(Shading::Flat).unwrap();
    let below = Object::new("below", below, Material::matt([0.5; 3]));
    scene.objects.push(below.receiver_only());
    let error = |m: u32| {
        let order = format!("m={m}");
        floor_error(&scene, &["filter=sat-u32", "a=0", "map-size=256", &order])[0]
    };
    let errors = [1, 2, 4, 8].map(error);
    assert!(errors.windows(2).all(|w| w[1] < w[0]), "{errors:?}");
    assert!(errors[3] < 0.05 * errors[0], "{errors:?}");
}

/// §4.1 and §6: at M = 4 two CSM-Z, one depth and twice two CSM look-ups a pixel, the
/// last two not where 1 - s is below the threshold; four times that in tables.
#[test]
fn look_ups_are_counted_exactly() {
    let scene = builtin::build("cylinder").unwrap();
    let texel = "edges=texel";
    for (set, per_image, images) in [
        (&["filter=mip"][..], 1, 2),
        (&["filter=sat"], 4, 2),
        (&["filter=sat", texel], 4, 2),
        (&["filter=sat-mean"], 5, 2),
        (&["filter=sat-u32"], 16, 8),
        (&["filter=sat-u32", texel], 4, 8),
        (&["filter=mip", "m=16"], 1, 8),
        (&["filter=sat", "m=5"], 4, 3),
    ] {
        let done = soft(&scene, set);
        let c = counted(&done, "look-up");
        let fetches = &c.traffic.tex_fetches;
        let (shaded, written) = (c.fragment_shader_invocations, c.fragments.written);
        let reached = fetches[3] / per_image;
        assert!(written > 100 && written < reached && reached <= shaded);
        assert_eq!(c.fragments.discarded, shaded - written);
        let below = done.figures.iter().find(|f| f.name == BELOW_THRESHOLD);
        assert_eq!(below.unwrap().value, (reached - written) as f64, "{set:?}");
        let (first, last) = (per_image * images * reached, per_image * images * written);
        let expected = [shaded, first + last, first, per_image * reached];
        assert_eq!(fetches[..4], expected, "{set:?}");
        // Of a pixel that goes all the way.
        let whole = per_image * (3 * images + 1);
        assert_eq!(
            (expected[1] + expected[2] + expected[3]) - whole * written,
            per_image * (2 * images + 1) * (reached - written)
        );
        if set == ["filter=mip"] {
            assert_eq!(whole, 6 + 1);
        }
    }
    // Iterating looks up the average again.
    let c = counted(&soft(&scene, &["iterate=2"]), "look-up");
    assert!(c.traffic.tex_fetches[3] > 2 * c.fragments.written);
}

/// Under a point light a box is one texel wide, with which bilinear look-ups of the
/// finest level agree, so that images in floats without tables say what tables lose:
/// floats more with each doubling, floats less their mean about half of that (a
/// caster's outline is no noise: sums of what is left still grow), integers hardly any.
#[test]
fn what_tables_lose_is_shown_side_by_side() {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.lights[0].shape = LightShape::Point {
        position: DVec3::new(1.6, 4.0, 1.0),
    };
    let mut floats = Vec::new();
    for size in ["map-size=256", "map-size=512", "map-size=1024"] {
        let of = |set: &[&str]| {
            soft(&scene, &[set, &[size, "a=0", "threshold=0.00001"]].concat()).visibility
        };
        let plain = of(&["filter=mip", "format=float"]);
        let loss = |filter: &str| {
            let table = of(&[filter]);
            let pairs = plain.iter().zip(&table).filter(|(v, _)| !v.is_nan());
            let off = pairs.map(|(a, b)| f64::from((a - b).abs()));
            off.fold(0.0, f64::max)
        };
        let [sat, mean, exact] = ["filter=sat", "filter=sat-mean", "filter=sat-u32"].map(loss);
        println!("{size}: sat {sat:.1e}, sat-mean {mean:.1e}, sat-u32 {exact:.1e}");
        assert!(
            mean < 0.8 * sat && exact < 0.1 * sat,
            "{size}: {sat} {mean} {exact}"
        );
        floats.push(sat);
    }
    assert!(floats.windows(2).all(|w| w[1] > 1.5 * w[0]), "{floats:?}");
}

/// Bytes of a texel over all images of M = 4: two 8-bit and two 16-bit RGBA textures
/// and depth under mip chains, all 32-bit float under tables.
#[test]
fn images_are_as_large_as_the_paper_says() {
    let scene = builtin::build("cylinder").unwrap();
    let written = |set: &[&str]| {
        let picture = soft(&scene, &[set, &["skip=off", "map-size=128"]].concat());
        let c = counted(&picture, "basis").traffic;
        c.color[0].write_bytes + c.color[1].write_bytes
    };
    let texels = 128 * 128;
    assert_eq!(written(&["filter=mip"]), texels * (2 * 4 + 2 * 8 + 4));
    assert_eq!(written(&["filter=sat"]), texels * (4 * 16 + 4));
    assert_eq!(
        written(&["filter=mip", "format=float"]),
        texels * (4 * 16 + 4)
    );
    assert_eq!(written(&["filter=sat-u32"]), texels * (16 * 4 + 4));
}

#[test]
fn what_only_skips_changes_no_bit() {
    for name in ["cylinder", "columns", "adversarial-eye-in-shadow"] {
        let scene = builtin::build(name).unwrap();
        for (filter, fit) in [
            ("filter=mip", "fit=casters"),
            ("filter=mip", "fit=receivers"),
            ("filter=sat", "fit=receivers"),
            ("filter=sat-mean", "fit=receivers"),
            ("filter=sat-u32", "fit=casters"),
        ] {
            let of = |skip: &str| soft(&scene, &["map-size=128", filter, fit, skip]);
            let (lazy, all) = (of("skip=on"), of("skip=off"));
            assert_eq!(
                lazy.visibility_hash(),
                all.visibility_hash(),
                "{name} {filter}"
            );
            assert_eq!(lazy.color_hash(), all.color_hash(), "{name} {filter}");
        }
    }
}

/// The registry's suite covers the default; here the other ways to filter.
#[test]
fn every_filter_gives_the_same_bits_everywhere() {
    let scene = builtin::build("creature").unwrap();
    let mut sun = scene.clone();
    let towards = DVec3::new(0.6, 1.0, 0.3);
    sun.lights[0].shape = LightShape::Directional { towards };
    let sets = [
        &["filter=sat", "m=3"][..],
        &["filter=sat", "edges=texel"],
        &["filter=sat-mean"],
        &["filter=sat-u32"],
        &["filter=sat-u32", "edges=texel", "iterate=1"],
        &["filter=mip", "format=float", "ringing=double"],
    ];
    let suns = sets.iter().take(2).map(|set| (&sun, *set));
    for (scene, set) in sets.iter().map(|set| (&scene, *set)).chain(suns) {
        let set = [set, &["map-size=64"]].concat();
        let of = |gpu| {
            let picture = with(scene, &set, gpu);
            (picture.color_hash(), picture.visibility_hash())
        };
        let expected = of(GpuConfig::default());
        let ways = [(1, 16), (2, 64), (4, 128)];
        for (turn, simd) in SimdLevel::available().into_iter().enumerate() {
            let (threads, tile) = ways[turn % ways.len()];
            let gpu = GpuConfig {
                threads,
                tile,
                simd,
                skip: turn % 2 == 0,
            };
            assert_eq!(of(gpu), expected, "{set:?} {simd} {tile}");
        }
    }
}

/// Everything that is hard: no NaN where there is a surface, nothing outside 0..=1.
#[test]
fn adversarial_scenes_stay_sane() {
    let adversarial = builtin::SCENES.iter();
    for entry in adversarial.filter(|s| s.name.starts_with("adversarial")) {
        let scene = entry.build();
        for filter in ["filter=mip", "filter=sat-u32"] {
            sane(&soft(&scene, &[filter, "map-size=64"]), entry.name);
        }
    }
}

fn sane(picture: &Rendered, name: &str) {
    for (v, depth) in picture.visibility.iter().zip(&picture.depth) {
        let surface = *depth < 1.0;
        assert!(surface == (0.0..=1.0).contains(v), "{name}: {v} at {depth}");
    }
    let codes: Vec<_> = picture.warnings.iter().map(|w| w.code).collect();
    assert!(!codes.contains(&"nan"), "{name}: {codes:?}");
}

/// Nothing in the way, nothing received, light in a caster, light below the floor.
#[test]
fn odd_lights_give_sensible_pictures() {
    let scene = builtin::build("cylinder").unwrap();
    let lit = |scene: &Scene, name: &str| {
        let picture = soft(scene, &["map-size=64"]);
        sane(&picture, name);
        let mut seen = picture.visibility.iter().filter(|v| !v.is_nan());
        seen.all(|v| *v == 1.0)
    };
    assert!(!lit(&scene, "as it is"));
    let mut empty = scene.clone();
    empty.objects[1].casts = false;
    assert!(lit(&empty, "no caster"));
    let mut blind = scene.clone();
    blind.objects.iter_mut().for_each(|o| o.receives = false);
    assert!(lit(&blind, "no receiver"));
    let at = |y: f64| {
        let mut moved = scene.clone();
        moved.lights[0] = Light::horizontal_square(DVec3::new(0.0, y, 0.0), 0.5);
        moved
    };
    // In the cylinder: its sides receive from inside, and the floor is dark below.
    assert!(!lit(&at(0.75), "inside"));
    lit(&at(-3.0), "below");
    lit(&at(0.0), "in the floor");
    let mut far = at(4.0);
    far.lights[0] = Light::horizontal_square(DVec3::new(0.0, 1e9, 0.0), 1.0);
    lit(&far, "far");
}

#[test]
fn what_stands_for_other_lights_is_said() {
    let mut scene = builtin::build("cylinder").unwrap();
    let centre = DVec3::new(1.6, 4.0, 1.0);
    scene.lights[0].shape = LightShape::Disc {
        centre,
        normal: DVec3::Y,
        radius: 0.5,
    };
    let picture = soft(&scene, &["map-size=64"]);
    sane(&picture, "disc");
    assert!(picture.warnings.iter().any(|w| w.code == "light-as-square"));
    // A point is a light without width: at the finest level, nearly hard.
    scene.lights[0].shape = LightShape::Point { position: centre };
    for filter in ["filter=mip", "filter=sat"] {
        let picture = soft(&scene, &["map-size=256", filter]);
        sane(&picture, "point");
        let count = |low: f32, high: f32| {
            let within = |v: &&f32| **v > low && **v < high;
            picture.visibility.iter().filter(within).count()
        };
        let (dark, between) = (count(-1.0, 0.1), count(0.1, 0.9));
        assert!(dark > 200 && between < 150, "{filter}: {dark} {between}");
    }
    // A direction is one, too.
    let towards = DVec3::new(0.4, 1.0, 0.3);
    scene.lights[0].shape = LightShape::Directional { towards };
    let oracle = HardOracle::new(&scene, HardLight::Directional(towards));
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    for filter in ["filter=mip", "filter=sat-u32"] {
        let picture = soft(&scene, &["map-size=256", filter]);
        sane(&picture, "direction");
        let (mut dark, mut wrong) = (0, 0);
        for (i, v) in picture.visibility.iter().enumerate() {
            let [x, y] = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
            let sample = oracle.sample(&rays, x, y);
            let shadow = sample.shadow_count > 0;
            if sample.hit.is_some() && !v.is_nan() {
                dark += usize::from(shadow);
                wrong += usize::from(shadow != (*v < 0.5));
            }
        }
        println!("direction {filter}: {wrong} wrong of {dark} dark");
        assert!(dark > 100 && wrong * 8 < dark, "{filter}: {dark} {wrong}");
    }
}

/// Eq. 9 on plates, where depths are known: what sharpening makes of visibility is the
/// power of what there is without, strength and falloff as they are given.
#[test]
fn sharpening_is_the_power_that_is_asked_for() {
    let scene = plates();
    let plain = ["m=16", "filter=sat-u32"];
    let without = soft(&scene, &[&plain[..], &["a=0"]].concat());
    let range = ["near", "far"].map(|name| {
        let found = without.figures.iter().find(|f| f.name == name);
        found.unwrap().value
    });
    let behind = (PLATES.floor_distance - PLATES.plate_distance) / (range[1] - range[0]);
    let pixels = floor_pixels(&scene, &without);
    for (strength, falloff) in [(30.0, 2.0), (3.0, 2.0), (3.0, 0.5)] {
        let power = 1.0 + strength * libm::exp(-falloff * behind);
        let off = |strength: f64| {
            let [a, b] = [format!("a={strength}"), format!("b={falloff}")];
            let with = soft(&scene, &[&plain[..], &[&a, &b]].concat());
            let (mut worst, mut judged) = (0.0f64, 0);
            for &(i, _) in &pixels {
                let [v, sharp] = [&without, &with].map(|p| f64::from(p.visibility[i]));
                // Where little is hidden the mean depth of blockers is less than exact.
                if (0.05..0.9).contains(&v) {
                    worst = worst.max((sharp - libm::pow(v, power)).abs());
                    judged += 1;
                }
            }
            println!("{a} {b}: power {power:.2}, off by {worst:.4} of {judged}");
            assert!(judged > 100, "{a} {b}: {judged}");
            worst
        };
        assert!(off(strength) < 0.02);
        // Half of it is seen.
        assert!(off(0.5 * strength) > 0.04);
    }
}

/// A parallelogram is no rectangle, which is said; a turned rectangle is one.
#[test]
fn sheared_lights_are_told() {
    let mut scene = plates();
    let told = |scene: &Scene| {
        let picture = soft(scene, &["map-size=64"]);
        let mut warnings = picture.warnings.iter();
        warnings.any(|w| w.code == "light-as-rectangle")
    };
    assert!(!told(&scene));
    let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape else {
        unreachable!()
    };
    let (u, v) = (*edge_u, *edge_v);
    (*edge_u, *edge_v) = (u + v, v - u);
    assert!(!told(&scene), "turned");
    let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape else {
        unreachable!()
    };
    (*edge_u, *edge_v) = (u + v * 0.5, v);
    assert!(told(&scene), "sheared");
}

/// Steep lit faces shadow themselves less where their planes lessen depths, and a level
/// floor stays as it is.
#[test]
fn planes_of_receivers_bring_steep_faces_nearer_to_the_truth() {
    let error = |scene: &Scene, set: &[&str]| {
        let truth = VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap();
        let more = ["horizon=on", "a=0", "m=16", "map-size=256"];
        let picture = soft(scene, &[set, &more].concat());
        let error = VisibilityError::measure(&truth, SIZE, &picture.visibility);
        error.unwrap().all.unwrap().rmse
    };
    for name in ["peer-a", "demo"] {
        let scene = builtin::build(name).unwrap();
        let [off, on] = ["plane-offset=0", "plane-offset=0.5"].map(|s| error(&scene, &[s]));
        println!("{name}: {off:.4} {on:.4}");
        assert!(on < 0.85 * off, "{name}: {on} of {off}");
    }
    let set = ["plane-offset=0.5", "a=0"];
    assert!(floor_error(&plates(), &set)[0] < 0.004);
}

#[test]
fn settings_that_cannot_be_are_refused() {
    let scene = builtin::build("cylinder").unwrap();
    let technique = find("convolution-soft-shadows").unwrap();
    let message = |set: &[&str]| {
        let params = match Params::parse(technique, set) {
            Ok(params) => params,
            Err(error) => return error.to_string(),
        };
        let settings = RenderSettings {
            size: SIZE,
            ..RenderSettings::default()
        };
        render(&scene, technique, &params, &settings)
            .unwrap_err()
            .to_string()
    };
    assert!(message(&["filter=sat-u32", "m=16", "map-size=2048"]).contains("8192"));
    assert!(message(&["threshold=0"]).contains("above 0"));
}

/// A wide light casts wide shadows along its width: squares along it come nearer to
/// the truth than one square of its area.
#[test]
fn rectangles_are_wider_than_high() {
    let mut scene = plates();
    let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape else {
        unreachable!()
    };
    *edge_u *= 2.0;
    *edge_v *= 0.5;
    let truth = VisibilityImage::of_scene(&scene, 0, SIZE, &|| ()).unwrap();
    let error = |set: &[&str]| {
        let picture = soft(&scene, set);
        let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
        println!("{set:?}: {:?}", error.of_region(LightRegion::Penumbra));
        error.of_region(LightRegion::Penumbra).unwrap().rmse
    };
    assert!(error(&["filter=sat", "a=0"]) < 0.02);
    assert!(error(&["filter=mip", "a=0"]) < 0.05);
    // One square of the rectangle's area is off by more, where all of a kernel is in
    // the picture.
    let whole = ["filter=mip", "a=0", "fit=receivers"];
    let probes = |n: &'static str| error(&[&whole[..], &[n]].concat());
    let [one, along] = ["probes=1", "probes=auto"].map(probes);
    assert!(one > 1.5 * along, "{one} {along}");
}

/// Orders of the expansion on scenes that are not parallel, and the ways to filter.
#[test]
fn scenes_come_nearer_to_the_truth_with_the_order() {
    for name in ["spheres", "creature"] {
        let scene = builtin::build(name).unwrap();
        let truth = VisibilityImage::of_scene(&scene, 0, SIZE, &|| ()).unwrap();
        let error = |set: &[&str]| {
            let picture = soft(&scene, &[set, &["a=0", "map-size=256"]].concat());
            let error = VisibilityError::measure(&truth, SIZE, &picture.visibility);
            let all = error.unwrap().all.unwrap();
            println!("{name} {set:?}: {all:?}");
            all.rmse
        };
        let errors = ["m=2", "m=4", "m=8", "m=16"].map(|m| error(&["filter=sat", m]));
        assert!(errors.windows(2).all(|w| w[1] < w[0]), "{name} {errors:?}");
        assert!(errors[0] < 0.15 && errors[3] < 0.08, "{name} {errors:?}");
        let [sat, exact] = [errors[1], error(&["filter=sat-u32"])];
        assert!((sat - exact).abs() < 2e-3, "{name}: {sat} {exact}");
    }
}
