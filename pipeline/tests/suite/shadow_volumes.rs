//! Shadow volumes on the emulated GPU, against each other and against the f64
//! truth: same bits under z-pass and z-fail, right counts at every pixel that
//! is not near an edge, invisible skipping.

use crate::drawing::drawn_on;
use std::path::PathBuf;

use gnomon_pipeline::geometry::caster::Caster;
use gnomon_pipeline::geometry::silhouette::{Orientation, Silhouette, light_facing};
use gnomon_pipeline::measure::heat;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, VolumeMethod};
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::obj;
use gnomon_pipeline::world::scene::{Scene, builtin, frame_model};
use gnomon_raster::GpuConfig;

const SIZE: [u32; 2] = [160, 128];

/// Scenes in which some caster shadows the eye.
const EYE_IN_SHADOW: [&str; 2] = ["adversarial", "adversarial-eye-in-shadow"];

fn draw_sized(scene: &Scene, name: &str, params: &[&str], size: [u32; 2]) -> Rendered {
    let gpu = GpuConfig {
        threads: 2,
        ..GpuConfig::default()
    };
    drawn_on(scene, name, params, size, gpu)
}

fn draw(scene: &Scene, params: &[&str]) -> Rendered {
    draw_sized(scene, "shadow-volumes", params, SIZE)
}

fn names() -> impl Iterator<Item = &'static str> {
    builtin::SCENES.iter().map(|s| s.name)
}

/// Interior pixels, those of them in shadow, and those whose count differs.
#[derive(Debug, Default)]
struct Compared {
    interior: usize,
    shadowed: usize,
    differing: Vec<(usize, u8, u32)>,
}

/// The stencil against the truth's counts modulo 256, or, where ranges took more than
/// it counts, shadow against light.
fn against_truth(scene: &Scene, drawn: &Rendered) -> Compared {
    let truth = HardTruth::of_scene(scene, 0, drawn.size, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
    let mut compared = Compared::default();
    for (i, pixel) in truth.pixels.iter().enumerate() {
        if !pixel.interior {
            continue;
        }
        if pixel.centre.hit.is_none() {
            assert!(drawn.visibility[i].is_nan(), "background at {i}");
            continue;
        }
        compared.interior += 1;
        compared.shadowed += usize::from(pixel.centre.shadow_count > 0);
        let (stencil, count) = (drawn.stencil[i], pixel.centre.shadow_count);
        let right = if in_ranges(drawn) {
            (stencil != 0) == (count != 0)
        } else {
            u32::from(stencil) == count % 256
        };
        if !right {
            compared.differing.push((i, stencil, count));
        }
    }
    compared
}

fn in_ranges(drawn: &Rendered) -> bool {
    let mut overflow = drawn
        .warnings
        .iter()
        .filter(|w| w.code == "stencil-overflow");
    overflow.any(|w| w.message.contains("in ranges"))
}

#[test]
fn z_pass_and_z_fail_agree_where_the_eye_is_outside() {
    for name in names().filter(|n| !EYE_IN_SHADOW.contains(n)) {
        let scene = builtin::build(name).unwrap();
        let [zpass, zfail] = ["method=zpass", "method=zfail"].map(|m| draw(&scene, &[m]));
        assert!(
            zpass.stencil == zfail.stencil,
            "{name}: {} differ",
            differences(&zpass.stencil, &zfail.stencil)
        );
        assert!(zpass.srgb == zfail.srgb, "{name}");
        assert!(zfail.stencil.iter().any(|s| *s != 0), "{name}: no shadow");
    }
}

fn differences(a: &[u8], b: &[u8]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn z_fail_counts_what_the_truth_counts_in_every_scene() {
    for name in names() {
        let scene = builtin::build(name).unwrap();
        let whole = draw(&scene, &["method=zfail"]);
        assert_eq!(
            in_ranges(&whole),
            ["adversarial", "adversarial-nested-300"].contains(&name),
            "{name}"
        );
        let whole = against_truth(&scene, &whole);
        assert!(whole.differing.is_empty(), "{name}: {:?}", whole.differing);
        let wrapped = draw(&scene, &["method=zfail", "overflow=wrap"]);
        let compared = against_truth(&scene, &wrapped);
        eprintln!(
            "{name}: {} interior, {} in shadow",
            compared.interior, compared.shadowed
        );
        assert!(
            compared.differing.is_empty(),
            "{name}: {:?}",
            compared.differing
        );
        // Shadows of tubes are thin: nearly all of their pixels touch an edge.
        let least = if name == "wireframe" { 1 } else { 20 };
        assert!(
            compared.interior > 1000 && compared.shadowed > least,
            "{name}: {compared:?}"
        );
    }
}

#[test]
fn the_automatic_choice_is_right_and_z_pass_is_not_when_the_eye_is_in_shadow() {
    for name in EYE_IN_SHADOW {
        let scene = builtin::build(name).unwrap();
        let [auto, zfail] = ["method=auto", "method=zfail"].map(|m| draw(&scene, &[m]));
        assert!(auto.stencil == zfail.stencil, "{name}");
        let methods: Vec<_> = auto.casters.iter().map(|c| c.method).collect();
        assert!(
            methods.contains(&VolumeMethod::DepthFail)
                && methods.contains(&VolumeMethod::DepthPass),
            "{name}"
        );
        // Negative control.
        let wrong = against_truth(&scene, &draw(&scene, &["method=zpass"]));
        assert!(
            wrong.differing.len() > wrong.interior / 2,
            "{name}: {}",
            wrong.differing.len()
        );
    }
}

#[test]
fn the_automatic_choice_gives_the_bits_of_z_fail() {
    for name in names() {
        let scene = builtin::build(name).unwrap();
        let [auto, zfail] = ["method=auto", "method=zfail"].map(|m| draw(&scene, &[m]));
        assert!(
            auto.stencil == zfail.stencil && auto.srgb == zfail.srgb,
            "{name}"
        );
    }
}

#[test]
fn skipping_is_invisible() {
    let mut skipped = 0;
    for name in names() {
        let mut scene = builtin::build(name).unwrap();
        // Look aside, so that some casters leave the view.
        for turn in [0.0, 1.0] {
            let camera = &mut scene.camera;
            let [right, ..] = camera.basis();
            camera.target += right * (turn * (camera.target - camera.eye).length());
            let on = draw(&scene, &["skip=on"]);
            let off = draw(&scene, &["skip=off"]);
            // Casters left out may be those that need ranges.
            let same = if in_ranges(&on) == in_ranges(&off) {
                on.stencil == off.stencil
            } else {
                let pairs = on.stencil.iter().zip(&off.stencil);
                pairs.into_iter().all(|(a, b)| (*a != 0) == (*b != 0))
            };
            assert!(same && on.srgb == off.srgb, "{name}, turned {turn}");
            assert!(
                off.casters
                    .iter()
                    .all(|c| c.method != VolumeMethod::Skipped)
            );
            skipped += on
                .casters
                .iter()
                .filter(|c| c.method == VolumeMethod::Skipped)
                .count();
        }
    }
    assert!(skipped > 3, "only {skipped} casters were ever skipped");
}

#[test]
fn no_pixel_is_brighter_than_without_shadows() {
    for name in names() {
        let scene = builtin::build(name).unwrap();
        let lit = draw_sized(&scene, "unshadowed", &[], SIZE);
        let shadowed = draw(&scene, &[]);
        let pixels = lit.srgb.iter().zip(&shadowed.srgb);
        assert!(
            pixels
                .clone()
                .all(|(l, s)| l.iter().zip(s).all(|(l, s)| l >= s)),
            "{name}"
        );
        assert!(
            pixels.clone().any(|(l, s)| l != s),
            "{name}: no shadow changes anything"
        );
        for (i, (l, s)) in pixels.enumerate() {
            let visibility = shadowed.visibility[i];
            assert_eq!(visibility.is_nan(), lit.visibility[i].is_nan());
            if visibility != 0.0 {
                assert_eq!(l, s, "{name}: pixel {i} is visible from the light");
            }
        }
    }
}

/// Fragments of the stencil pass, pixels with a count, and the largest count,
/// at 512x512. The triangles are the peers' own numbers.
#[test]
fn peer_scenes_do_the_peers_work() {
    let expected = [
        ("peer-a", 388, 185_528, 22_451, 1),
        ("peer-b", 37_508, 1_324_358, 49_993, 3),
        ("peer-c", 29_512, 3_135_528, 40_116, 22),
    ];
    for (name, triangles, fragments, shadowed, most) in expected {
        let scene = builtin::build(name).unwrap();
        let drawn = draw_sized(
            &scene,
            "shadow-volumes",
            &["method=zfail", "color-format=rgba8"],
            [512; 2],
        );
        let labels: Vec<&str> = drawn
            .report
            .passes
            .iter()
            .map(|p| p.label.as_str())
            .collect();
        assert_eq!(labels, ["ambient", "volumes", "lit"]);
        let counted = drawn.report.passes[1].totals();
        assert_eq!(counted.primitives.input, triangles, "{name}");
        assert_eq!(counted.fragments.generated, fragments, "{name}");
        assert_eq!(
            drawn.stencil.iter().filter(|s| **s != 0).count(),
            shadowed,
            "{name}"
        );
        assert_eq!(drawn.stencil.iter().max(), Some(&most), "{name}");
    }
}

#[test]
fn several_lights_add_up_and_the_first_gives_visibility() {
    let mut scene = builtin::build("columns").unwrap();
    let mut second = scene.lights[0].clone();
    second.shape = gnomon_pipeline::world::light::LightShape::Directional {
        towards: glam::DVec3::new(-0.6, 1.0, 0.4),
    };
    second.colour = [0.3, 0.2, 0.4];
    scene.lights.push(second);
    let both = draw(&scene, &[]);
    let [first, other] = ["light=0", "light=1"].map(|l| draw(&scene, &[l]));
    assert!(both.stencil == first.stencil && both.visibility_hash() == first.visibility_hash());
    assert!(first.stencil != other.stencil);
    for single in [&first, &other] {
        let channels = both.srgb.iter().flatten().zip(single.srgb.iter().flatten());
        assert!(channels.clone().all(|(both, single)| both >= single));
        assert!(channels.clone().any(|(both, single)| both > single));
    }
    scene.lights.remove(0);
    assert!(
        against_truth(&scene, &other).differing.is_empty(),
        "directional light"
    );
}

#[test]
fn objects_that_take_no_shadow_are_lit() {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.objects[0].receives = false;
    let drawn = draw(&scene, &[]);
    let lit = draw_sized(&scene, "unshadowed", &[], SIZE);
    let floor_only = draw_sized(
        &Scene {
            objects: vec![scene.objects[0].clone()],
            ..scene.clone()
        },
        "unshadowed",
        &[],
        SIZE,
    );
    let mut floor = 0;
    for (i, depth) in drawn.depth.iter().enumerate() {
        if *depth == floor_only.depth[i] && *depth < 1.0 {
            floor += 1;
            assert_eq!(
                (drawn.srgb[i], drawn.visibility[i]),
                (lit.srgb[i], 1.0),
                "pixel {i}"
            );
        }
    }
    assert!(floor > 1000);
}

/// A wall through the near plane: its cap keeps the wall's depth, so the lit
/// side stays lit, and nothing nearer than the near plane is seen.
#[test]
fn casters_that_cross_the_near_plane_keep_their_caps_to_the_bit() {
    let mut scene = builtin::build("cylinder").unwrap();
    let [_, _, forward] = scene.camera.basis();
    let eye = scene.camera.eye;
    let slab = gnomon_pipeline::world::shape::cuboid(
        eye + forward * 2.0 - glam::DVec3::Y * 0.4,
        glam::DVec3::new(0.3, 0.3, 6.0),
    );
    let mut object = scene.objects[1].clone();
    object.name = "slab".into();
    object.mesh = std::sync::Arc::new(slab.into_mesh(Shading::Flat).unwrap());
    scene.objects.push(object);
    let zfail = draw(&scene, &["method=zfail"]);
    let compared = against_truth(&scene, &zfail);
    assert!(compared.differing.is_empty(), "{:?}", compared.differing);
    assert!(draw(&scene, &[]).stencil == zfail.stencil);
}

/// The overlay's data and the counters tell the same story.
#[test]
fn heat_adds_up_to_the_counters() {
    let scene = builtin::build("columns").unwrap();
    let technique = techniques::find("shadow-volumes").unwrap();
    let params = Params::defaults(technique);
    let settings = RenderSettings {
        size: [100, 76],
        ..RenderSettings::default()
    };
    let heat = heat::record(&scene, technique, &params, &settings).unwrap();
    let drawn = render(&scene, technique, &params, &settings).unwrap();
    assert_eq!(heat.passes.len(), drawn.report.passes.len());
    for (heat, counted) in heat.passes.iter().zip(&drawn.report.passes) {
        let totals = counted.totals();
        let overdraw: u64 = heat.overdraw.iter().map(|o| u64::from(*o)).sum();
        assert_eq!(overdraw, totals.fragments.generated, "{}", heat.label);
        let of = |client: fn(&heat::BlockBytes) -> u64| heat.bytes.iter().map(client).sum::<u64>();
        let traffic = &totals.traffic;
        let ours = [
            of(|b| b.z),
            of(|b| b.stencil),
            of(|b| b.color),
            of(|b| b.hiz),
        ];
        let theirs = [traffic.z, traffic.stencil, traffic.color[0], traffic.hiz];
        assert_eq!(ours, theirs.map(|t| t.bytes()), "{}", heat.label);
    }
    let volumes = heat.sum(|label| label == "volumes");
    assert!(volumes.overdraw.iter().any(|o| *o > 2) && volumes.bytes.len() == 13 * 10);
}

/// `$GNOMON_DATA`, or `shared/data` beside the workspace.
fn mesh_folder() -> Option<PathBuf> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("GNOMON_DATA")
        .map_or_else(beside, PathBuf::from)
        .join("meshes");
    folder.exists().then_some(folder)
}

/// Whether a pixel's centre is within half a pixel of a silhouette edge that
/// lies on the surface seen there: scanned surfaces fold within a half-pixel,
/// unseen by the truth's lattice, and where the light cap meets a side the two
/// depths differ by less than their rounding.
fn is_near_silhouette(scene: &Scene, drawn: &Rendered, pixel: usize) -> bool {
    let [w, h] = drawn.size;
    let clip = scene
        .camera
        .clip_from_world(f64::from(w) / f64::from(h))
        .map(|r| r.map(f64::from));
    let centre = [pixel as u32 % w, pixel as u32 / w].map(|c| f64::from(c) + 0.5);
    let on_screen = |p: glam::DVec3| {
        let at = |r: [f64; 4]| ((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + r[3];
        let [x, y, z, w_clip] = clip.map(at);
        let (x, y) = (
            (x / w_clip + 1.0) * 0.5 * f64::from(w),
            (1.0 - y / w_clip) * 0.5 * f64::from(h),
        );
        glam::DVec3::new(x, y, z / w_clip)
    };
    scene.casters().any(|object| {
        let mesh = &object.mesh;
        let caster = Caster::new(mesh);
        let orientation = Orientation::closed(&light_facing(mesh, scene.lights[0].hard()));
        let silhouette = Silhouette::new(mesh, caster.adjacency(), &orientation);
        silhouette.edges.iter().any(|edge| {
            let [a, b] = edge.map(|i| on_screen(mesh.position(i)));
            let (d, p) = (b - a, glam::DVec3::new(centre[0], centre[1], 0.0) - a);
            let t = ((d.x * p.x + d.y * p.y) / (d.x * d.x + d.y * d.y)).clamp(0.0, 1.0);
            let nearest = a + d * t;
            let (dx, dy) = (nearest.x - centre[0], nearest.y - centre[1]);
            let depth = (nearest.z - f64::from(drawn.depth[pixel])).abs();
            dx * dx + dy * dy < 0.25 && depth < 1e-4
        })
    })
}

/// Every interior pixel but those next to a silhouette equals the truth. D24 limits the slope
/// of needle-thin triangles seen edge-on, which the counters tell: each may
/// spoil a pixel.
fn check_models(files: &[&str], size: [u32; 2]) {
    let Some(folder) = mesh_folder() else {
        eprintln!("no data folder: nothing checked");
        return;
    };
    for file in files {
        let read = obj::load(&folder.join(file)).unwrap();
        let scene = frame_model(file, read.shape);
        for format in ["depth-format=d32f", "depth-format=d24"] {
            let of = |m: &str| draw_sized(&scene, "shadow-volumes", &[m, format], size);
            let [zfail, zpass] = ["method=zfail", "method=zpass"].map(of);
            let mut compared = against_truth(&scene, &zfail);
            let excused = compared.differing.len();
            compared
                .differing
                .retain(|(i, ..)| !is_near_silhouette(&scene, &zfail, *i));
            let differ = compared.differing.len();
            let excused = excused - differ;
            eprintln!(
                "{file} {format}: {} interior, {} in shadow, {excused} at silhouettes, {:?}",
                compared.interior, compared.shadowed, compared.differing
            );
            assert!(
                excused < 5 && differ == 0,
                "{file}: {:?}",
                compared.differing
            );
            assert!(compared.shadowed > 300, "{file}");
            let methods_differ = differences(&zpass.stencil, &zfail.stencil);
            assert_eq!(methods_differ, 0, "{file}: z-pass and z-fail");
        }
    }
}

#[test]
fn real_meshes_equal_the_truth() {
    check_models(
        &[
            "bunny_5k.obj",
            "buddha_10k.obj",
            "armadillo_10k.obj",
            "dragon_10k.obj",
        ],
        [192, 160],
    );
}

#[test]
#[ignore = "ten seconds on four cores; run in release"]
fn full_meshes_equal_the_truth() {
    check_models(
        &["bunny.obj", "buddha_70k.obj", "armadillo.obj", "dragon.obj"],
        [512, 384],
    );
}
