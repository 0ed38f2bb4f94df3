//! Shadow maps and what is looked up in them: against rays, counted, and with odd
//! scenes and parameters (docs/papers.md, baselines).

use crate::map_support::{SIZE, by, centre_of, figure, plates, scene, sized, truth};
use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::hard::HardOracle;
use gnomon_pipeline::world::light::{HardLight, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::{Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;

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

fn look_up(picture: &Rendered) -> gnomon_raster::Counters {
    let passes = &picture.report.passes;
    let pass = passes.iter().find(|p| p.label == "look-up").unwrap();
    pass.totals()
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

/// Kernels lie about the receiver, not beside it: the centroid of a shadow of a plate
/// right below the light is below it too, to a quarter of a texel; what is left is the
/// picture's pixels.
#[test]
fn kernels_do_not_move_shadows() {
    const D: f64 = 4.0;
    let (scene, _) = plates(D);
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    for kernel in [
        &["kernel=bicubic"][..],
        &["kernel=box", "taps=4"],
        &["kernel=box", "taps=5"],
    ] {
        let set = [kernel, &["map-size=64", "fit=receivers"]].concat();
        let picture = by("pcf", &scene, &set);
        let (mut sum, mut dark) = (DVec3::ZERO, 0.0);
        for (k, seen) in picture.visibility.iter().enumerate() {
            let place = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
            let ray = rays.direction(place[0], place[1]);
            let t = -rays.origin.y / ray.y;
            // What a pixel covers of the floor grows with the cube of its distance.
            let hidden = (1.0 - f64::from(*seen)) * t * t * t;
            sum += (rays.origin + ray * t) * hidden;
            dark += hidden;
        }
        let texel = figure(&picture, "texel");
        let off = sum / dark / texel;
        println!("{kernel:?}: texel {texel:.4}, off by {off:.3}");
        assert!(
            dark > 0.0 && off.x.abs() < 0.25 && off.z.abs() < 0.25,
            "{kernel:?}: {off}"
        );
    }
}

/// Whether a shadow map of parallel rays that is right in every texel says so; as
/// [`mapped`].
fn mapped_along(
    oracle: &HardOracle,
    towards: DVec3,
    point: DVec3,
    bias: f64,
    texel: f64,
) -> Option<bool> {
    let towards = towards.normalize();
    let right = towards.any_orthonormal_vector();
    let down = towards.cross(right);
    let blocked = |i: i32, k: i32| {
        let off = right * f64::from(i) + down * f64::from(k);
        oracle.shadow_count_at(point + off * (0.25 * texel) + towards * bias) > 0
    };
    let centre = blocked(0, 0);
    let alike = (-3..=3).all(|i| (-3..=3).all(|k| blocked(i, k) == centre));
    alike.then_some(centre)
}

/// Directional lights have orthographic views: the hard shadow of the oracle, from
/// above, at a slant, and near the horizon; of one map, of taps, and of N maps.
#[test]
fn maps_of_directional_lights_are_the_hard_shadow() {
    for (name, towards, far) in [
        ("cylinder", DVec3::new(0.5, 1.0, -0.7), 0.0),
        ("creature", DVec3::new(0.6, 1.0, 0.3), 0.0),
        ("columns", DVec3::new(-0.5, 1.5, 0.8), 0.0),
        ("spheres", DVec3::new(2.0, 0.7, -1.0), 0.0),
        ("creature", DVec3::new(0.6, 1.0, 0.3), 4096.0),
    ] {
        let mut scene = scene(name);
        if far > 0.0 {
            scene = moved(&scene, DVec3::new(far, -far, far));
        }
        scene.lights[0].shape = LightShape::Directional { towards };
        let oracle = HardOracle::new(&scene, HardLight::Directional(towards));
        let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
        let plain = ["map-size=1024", "slope-bias=0", "bias=0.02"];
        let hard = by("shadow-map", &scene, &plain);
        let many = by("shadow-maps-n", &scene, &[&plain[..], &["maps=4"]].concat());
        assert_eq!(figure(&hard, "views"), 1.0);
        // A light without width: kernels of a texel.
        let soft = by("pcss", &scene, &[&plain[..], &["sampling=all"]].concat());
        let taps = by("pcf", &scene, &[&plain[..], &["taps=2"]].concat());
        let texel = figure(&hard, "texel");
        let (mut judged, mut surfaces, mut dark, mut as_in_truth) = (0, 0, 0, 0);
        for (k, seen) in hard.visibility.iter().enumerate() {
            let place = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
            let sample = oracle.sample(&rays, place[0], place[1]);
            let Some(hit) = sample.hit.filter(|_| !seen.is_nan()) else {
                continue;
            };
            surfaces += 1;
            let point = rays.origin + rays.direction(place[0], place[1]) * hit.depth;
            let Some(blocked) = mapped_along(&oracle, towards, point, 0.02, texel) else {
                continue;
            };
            judged += 1;
            dark += usize::from(blocked);
            as_in_truth += usize::from(blocked == (sample.shadow_count > 0));
            let expected = if blocked { 0.0 } else { 1.0 };
            assert_eq!(*seen, expected, "{name} at {place:?}");
            assert_eq!(many.visibility[k], expected, "{name} at {place:?}");
            for picture in [&soft, &taps] {
                assert!(
                    (picture.visibility[k] - expected).abs() < 0.8,
                    "{name} at {place:?}"
                );
            }
        }
        println!("{name}: {judged} of {surfaces} judged, {dark} dark, {as_in_truth} as in truth");
        assert!(judged * 10 > surfaces * 8 && dark > 100, "{name}");
        assert!(as_in_truth * 1000 >= judged * 990, "{name}");
    }
}

/// The scene elsewhere.
fn moved(scene: &Scene, by: DVec3) -> Scene {
    let mut moved = scene.clone();
    moved.camera.eye += by;
    moved.camera.target += by;
    for object in &mut moved.objects {
        let mesh = &object.mesh;
        let place = |i: u32| (mesh.position(i) + by).to_array().map(|c| c as f32);
        let positions = (0..mesh.positions().len() as u32).map(place).collect();
        let mesh = Mesh::new(positions, mesh.triangles().to_vec(), Shading::Flat);
        object.mesh = std::sync::Arc::new(mesh.unwrap());
    }
    moved
}

/// What is left out of an orthographic view covers no texel, and no view is where no
/// shadow can fall.
#[test]
fn directional_views_skip_and_end() {
    let mut scene = scene("columns");
    let towards = DVec3::new(-0.5, 1.5, 0.8);
    scene.lights[0].shape = LightShape::Directional { towards };
    for technique in ["shadow-map", "pcf", "pcss"] {
        let of = |set: &str| by(technique, &scene, &[set]).visibility_hash();
        assert_eq!(of("skip=on"), of("skip=off"), "{technique}");
        assert_ne!(of("fit=receivers"), of("map-size=64"));
    }
    // From below nothing is between the light and what is seen but the floor.
    let mut below = scene.clone();
    let towards = DVec3::NEG_Y;
    below.lights[0].shape = LightShape::Directional { towards };
    below.objects.retain(|o| !o.casts);
    let picture = by("shadow-map", &below, &[]);
    assert_eq!(figure(&picture, "views"), 0.0);
    assert!(picture.visibility.iter().all(|v| v.is_nan() || *v == 1.0));
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

/// A smooth kernel blurs a shadow and does not move it: its centroid is that of single
/// texels, to a tenth of a pixel, where half a texel is half a pixel and more.
#[test]
fn bicubic_kernels_are_centred_on_the_receiver() {
    let scene = scene("parallel-plates");
    let centroid = |set: &[&str]| {
        let picture = by("pcf", &scene, set);
        let (mut sum, mut moments) = (0.0, [0.0; 2]);
        for (i, v) in picture.visibility.iter().enumerate() {
            let dark = if v.is_nan() { 0.0 } else { 1.0 - f64::from(*v) };
            let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
            sum += dark;
            moments = [
                moments[0] + dark * f64::from(x),
                moments[1] + dark * f64::from(y),
            ];
        }
        moments.map(|m| m / sum)
    };
    let [bicubic, single] =
        ["kernel=bicubic", "taps=1"].map(|kernel| centroid(&[kernel, "map-size=16", "bias=0.01"]));
    for k in 0..2 {
        let off = bicubic[k] - single[k];
        assert!(off.abs() < 0.25, "{bicubic:?} {single:?}");
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

/// A light in a closed room: walls round the light, no view can be planar; and lit
/// where nothing casts.
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
    // Of the walls alone there is no view: those of a convex room shadow nothing.
    assert!(figure(&picture, "views") >= 1.0);
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
    assert!(message("shadow-map", "map-size=100").contains("a power of two, 16 to 4096"));
    assert!(message("shadow-map", "near=0").contains("above 0"));
    for bias in ["bias=-1", "bias=nan", "bias=inf", "bias=x"] {
        assert!(
            message("shadow-map", bias).contains("auto, or a number from 0"),
            "{bias}"
        );
    }
    assert!(message("pcss", "samples=15").contains("square numbers"));
    assert!(message("shadow-maps-n", "maps=2000").contains("square numbers"));
    let mut sun = scene.clone();
    let towards = DVec3::ZERO;
    sun.lights[0].shape = LightShape::Directional { towards };
    for name in ["shadow-map", "pcf", "pcss", "shadow-maps-n"] {
        let message = sized(name, &sun, &[], SIZE).unwrap_err();
        assert!(message.contains("direction is"), "{message}");
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

/// Casters nearer than `near` are not looked at.
#[test]
fn casters_nearer_than_near_cast_nothing() {
    let (scene, _) = plates(3.0);
    let dark = |near: &str| {
        let picture = by("shadow-map", &scene, &[near]);
        picture.visibility.iter().filter(|v| **v == 0.0).count()
    };
    assert!(dark("near=1.9") == dark("near=auto") && dark("near=0.5") > 100);
    assert_eq!(dark("near=2.1"), 0);
}
