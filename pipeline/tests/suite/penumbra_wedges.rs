//! Penumbra wedges of papers I and II on the emulated GPU: hard shadows in the
//! limit, the same buffers whatever is culled and in however many passes, and what
//! culling saves.

use crate::drawing::as_published;
use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::measure::tile_traffic::{Measured, TileTraffic, measure};
use gnomon_pipeline::technique::{Params, VisibilityOutput};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::light::{HardLight, Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;
use gnomon_raster::{Gpu, GpuConfig, SimdLevel, Subresource};

const SIZE: [u32; 2] = [160, 120];
const ORIGINAL: &str = "penumbra-wedges";
const RESTRUCTURED: &str = "penumbra-wedges-restructured";

fn scene(name: &str) -> Scene {
    builtin::build(name).unwrap()
}

/// The scene with its first light as a sphere of the given radius, at its centre.
fn with_sphere(mut scene: Scene, radius: f64) -> Scene {
    let HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("{}: parallel light", scene.name);
    };
    scene.lights[0].shape = LightShape::Sphere { centre, radius };
    scene
}

fn params(technique: &str, set: &[&str]) -> Params {
    let technique = techniques::find(technique).unwrap();
    let set = as_published(technique)
        .into_iter()
        .chain(set.iter().copied());
    Params::parse(technique, set).unwrap()
}

fn picture(scene: &Scene, technique: &str, set: &[&str]) -> Rendered {
    let settings = RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    };
    let found = techniques::find(technique).unwrap();
    render(scene, found, &params(technique, set), &settings).unwrap()
}

/// The light-intensity buffer of the first light, as stored.
fn buffer_with(scene: &Scene, technique: &str, set: &[&str], config: GpuConfig) -> Vec<i16> {
    let mut gpu = Gpu::new(config).unwrap();
    let found = techniques::find(technique).unwrap();
    let params = params(technique, set);
    let frame = found.frame(scene, SIZE, &params).unwrap();
    gpu.load(&frame.recording).unwrap();
    gpu.submit(&frame.recording.list).unwrap();
    let VisibilityOutput::Red { texture, .. } = frame.outputs.visibility else {
        panic!("{:?}", frame.outputs.visibility);
    };
    let texels = gpu.texture(texture).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    texels.iter().map(|t| t.0[0] as i16).collect()
}

fn buffer(scene: &Scene, technique: &str, set: &[&str]) -> Vec<i16> {
    buffer_with(scene, technique, set, GpuConfig::default())
}

fn bits(visibility: &[f32]) -> Vec<u32> {
    visibility.iter().map(|v| v.to_bits()).collect()
}

fn differing<T: PartialEq>(a: &[T], b: &[T]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn radius_zero_is_the_hard_mask_byte_for_byte() {
    for name in [
        "cylinder",
        "columns",
        "creature",
        "demo",
        "adversarial-eye-in-shadow",
        "adversarial-near-plane",
    ] {
        let scene = with_sphere(scene(name), 0.0);
        let hard = picture(&scene, "shadow-volumes", &[]);
        for technique in [ORIGINAL, RESTRUCTURED] {
            let soft = picture(&scene, technique, &[]);
            assert!(
                bits(&soft.visibility) == bits(&hard.visibility),
                "{name}, {technique}"
            );
            assert!(soft.srgb == hard.srgb, "{name}, {technique}");
        }
        let wide = with_sphere(scene, 0.3);
        let soft = picture(&wide, RESTRUCTURED, &[]);
        let other = differing(&bits(&soft.visibility), &bits(&hard.visibility));
        assert!(other > 50, "negative control: {name}, {other}");
    }
}

#[test]
fn what_takes_no_shadow_is_fully_lit() {
    let mut point = with_sphere(scene("cylinder"), 0.0);
    point.objects[0].receives = false;
    let hard = picture(&point, "shadow-volumes", &[]);
    let wide = with_sphere(point.clone(), 0.5);
    for technique in [ORIGINAL, RESTRUCTURED] {
        let soft = picture(&point, technique, &[]);
        assert!(
            bits(&soft.visibility) == bits(&hard.visibility),
            "{technique}"
        );
        let dark = |scene: &Scene| {
            let drawn = picture(scene, technique, &[]).visibility;
            drawn.iter().filter(|v| **v < 1.0).count()
        };
        let mut receiving = wide.clone();
        receiving.objects[0].receives = true;
        let [own, all] = [&wide, &receiving].map(dark);
        assert!(own > 50 && all > own + 200, "{technique}: {own} of {all}");
    }
}

/// Whatever the scene: visibility is a number in 0..=1 at every surface, none is
/// NaN on the way, and sums that saturate are counted.
#[test]
fn every_scene_gives_visibility_within_bounds() {
    for entry in builtin::SCENES.iter() {
        let scene = scene(entry.name);
        for technique in [ORIGINAL, RESTRUCTURED] {
            let drawn = picture(&scene, technique, &[]);
            for (v, depth) in drawn.visibility.iter().zip(&drawn.depth) {
                let fine = if *depth >= 1.0 {
                    v.is_nan()
                } else {
                    (0.0..=1.0).contains(v)
                };
                assert!(fine, "{}, {technique}: {v} at depth {depth}", entry.name);
            }
            let codes: Vec<&str> = drawn.warnings.iter().map(|w| w.code).collect();
            assert!(!codes.contains(&"nan"), "{}: {codes:?}", entry.name);
            // 300 nested umbrae are more than the buffer holds.
            let nested = entry.name.contains("nested") || entry.name == "adversarial";
            let full = codes.iter().any(|c| c.ends_with("-saturated"));
            assert!(nested || !full, "{}: {codes:?}", entry.name);
            assert!(full || !entry.name.contains("nested"), "{codes:?}");
        }
    }
}

/// Every wedge vanishes with the light, and so does every difference.
#[test]
fn small_lights_approach_the_hard_mask() {
    for technique in [ORIGINAL, RESTRUCTURED] {
        let hard = picture(&with_sphere(scene("creature"), 0.0), technique, &[]);
        let count = |radius| {
            let soft = picture(&with_sphere(scene("creature"), radius), technique, &[]);
            differing(&bits(&soft.visibility), &bits(&hard.visibility))
        };
        let counts = [1e-1, 1e-2, 1e-3, 1e-4].map(count);
        eprintln!("{technique}: pixels that differ from the hard mask {counts:?}");
        assert!(
            counts[0] > 4 * counts[1] && counts[1] > counts[2],
            "{counts:?}"
        );
        // Wedges thinner than f32 resolves may be missed here and there.
        assert!(counts[0] > 100 && counts[3] * 1000 <= SIZE[0] as usize * SIZE[1] as usize);
    }
}

/// Under a long straight edge, seen from pixels of the floor: the largest error
/// against the part of the light's disc beyond the edge.
fn error_under_a_straight_edge(technique: &str, interpolation: &str) -> f64 {
    let (radius, centre) = (0.05, DVec3::new(1.0, 6.0, 0.0));
    let roof = shape::cuboid(DVec3::new(-10.0, 2.0, 0.0), DVec3::new(20.0, 0.02, 40.0));
    let floor = shape::plane(6.0, 0.0).into_mesh(Shading::Flat).unwrap();
    let light = Light {
        shape: LightShape::Sphere { centre, radius },
        colour: [1.0; 3],
    };
    let objects = vec![
        Object::new("floor", floor, Material::matt([1.0; 3])).receiver_only(),
        Object::new(
            "roof",
            roof.into_mesh(Shading::Flat).unwrap(),
            Material::matt([1.0; 3]),
        ),
    ];
    let camera = Camera {
        fov_y_degrees: 4.0,
        ..Camera::look_at([0.9, 1.2, 2.0], [-0.496, 0.0, 0.0])
    };
    let scene = Scene::new(camera, vec![light], objects);
    let drawn = picture(
        &scene,
        technique,
        &[&format!("interpolation={interpolation}")],
    );
    let rays = camera.eye_rays(SIZE[0], SIZE[1]);
    let edge = DVec3::new(0.0, 1.99, 0.0);
    let (mut largest, mut partly) = (0.0f64, 0);
    for (i, &visible) in drawn.visibility.iter().enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let d = rays.direction(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let p = camera.eye + d * (-camera.eye.y / d.y);
        if visible.is_nan() || d.y >= 0.0 || p.x.abs() > 3.0 || p.z.abs() > 3.0 {
            continue;
        }
        // Distance of the light's centre beyond the plane of pixel and edge, in radii.
        let normal = (edge - p).cross(DVec3::Z).normalize();
        let h = ((centre - p).dot(normal) * normal.x.signum() / radius).clamp(-1.0, 1.0);
        let hidden = (libm::acos(h) - h * (1.0 - h * h).sqrt()) / std::f64::consts::PI;
        largest = largest.max((f64::from(visible) - (1.0 - hidden)).abs());
        partly += usize::from(h.abs() < 1.0);
    }
    assert!(partly > 300, "{partly} pixels in the penumbra");
    largest
}

#[test]
fn interpolation_errors_are_those_of_a_discs_segment() {
    for technique in [ORIGINAL, RESTRUCTURED] {
        let [linear, smooth] =
            ["linear", "smoothstep"].map(|i| error_under_a_straight_edge(technique, i));
        eprintln!("{technique}: linear {linear:.4}, smoothstep {smooth:.4}");
        // 0.0577 and 0.0394, the buffer's half step, and the light's nearness.
        assert!((linear - 0.0577).abs() < 0.003, "{technique}: {linear}");
        assert!((smooth - 0.0394).abs() < 0.003, "{technique}: {smooth}");
    }
}

/// Scenes where the restructured technique is compared with itself.
fn hard_cases() -> Vec<Scene> {
    let mut cases: Vec<Scene> = ["columns", "creature", "adversarial-eye-in-shadow"]
        .into_iter()
        .map(scene)
        .collect();
    let mut sky = scene("spheres");
    sky.camera = Camera::look_at([4.0, 1.0, 7.0], [0.0, 2.2, 0.0]);
    cases.push(sky);
    cases
}

#[test]
fn the_buffer_does_not_depend_on_culling_passes_tiles_or_axes() {
    for scene in hard_cases() {
        for method in ["auto", "zfail"] {
            let method = format!("method={method}");
            let reference = buffer(&scene, RESTRUCTURED, &[&method, "culling=none"]);
            let dark = reference.iter().filter(|v| (1..255).contains(*v)).count();
            assert!(dark > 100, "{}: {dark} in penumbrae", scene.name);
            let mut ways = vec![vec!["culling=none", "passes=three"]];
            for tile in [
                "tile=2", "tile=4", "tile=8", "tile=16", "tile=32", "tile=64", "tile=128",
                "tile=256",
            ] {
                ways.push(vec!["culling=zminmax", tile]);
            }
            ways.push(vec!["culling=zmax", "tile=8", "passes=three"]);
            for axes in [
                "separating-axis=full",
                "separating-axis=range-faces",
                "separating-axis=range",
            ] {
                ways.push(vec!["culling=zminmax", "tile=4", axes]);
            }
            ways.push(vec![
                "culling=zminmax",
                "tile=16",
                "separating-axis=full",
                "passes=three",
            ]);
            for mut way in ways {
                way.push(&method);
                let other = buffer(&scene, RESTRUCTURED, &way);
                assert!(
                    other == reference,
                    "{}: {way:?}: {} pixels differ",
                    scene.name,
                    differing(&other, &reference)
                );
            }
        }
    }
}

#[test]
fn z_pass_equals_z_fail_where_the_eye_is_outside_and_not_where_it_is_inside() {
    for name in ["cylinder", "columns", "creature"] {
        let scene = scene(name);
        let [zpass, zfail] = ["method=zpass", "method=zfail"]
            .map(|m| picture(&scene, RESTRUCTURED, &[m]).visibility);
        let other = differing(&bits(&zpass), &bits(&zfail));
        eprintln!("{name}: z-pass and z-fail differ in {other} pixels");
        assert!(other <= 4, "{name}: {other}");
    }
    let inside = scene("adversarial-eye-in-shadow");
    let [zpass, zfail] =
        ["method=zpass", "method=zfail"].map(|m| picture(&inside, RESTRUCTURED, &[m]).visibility);
    let other = differing(&bits(&zpass), &bits(&zfail));
    assert!(other > 500, "negative control: {other}");
}

/// The two papers' algorithms add up to the same buffer; where the eye is in
/// shadow too, if the first starts with the eye's own intensity.
#[test]
fn restructuring_changes_no_intensity() {
    for (name, radius) in [
        ("cylinder", 0.5),
        ("columns", 0.1),
        ("spheres", 0.15),
        ("adversarial-eye-in-shadow", 0.3),
        // So large that side planes meet above the floor.
        ("creature", 0.4),
        ("columns", 0.5642),
    ] {
        let scene = with_sphere(scene(name), radius);
        let first = picture(&scene, ORIGINAL, &[]).visibility;
        let second = picture(&scene, RESTRUCTURED, &[]).visibility;
        let apart = |a: &[f32], b: &[f32]| {
            let off = |(a, b): (&f32, &f32)| (a - b).abs() > 1.5 / 255.0;
            a.iter().zip(b).filter(|p| off(*p)).count()
        };
        let count = apart(&first, &second);
        eprintln!("{name}: {count} pixels apart by more than a step");
        assert!(count <= first.len() / 1000, "{name}: {count}");
        if name == "adversarial-eye-in-shadow" {
            let lit = picture(&scene, ORIGINAL, &["start=lit"]).visibility;
            let count = apart(&lit, &second);
            assert!(count > 500, "negative control: {count}");
        }
    }
}

/// The three forms of the first paper agree where side planes do not meet; where they
/// do, evaluating them leaves streaks, and leaving them out does not.
#[test]
fn side_planes_that_cancel_may_be_left_out() {
    let forms = ["cancel", "evaluate", "naive"].map(|f| format!("side-planes={f}"));
    let of = |scene: &Scene| {
        forms
            .each_ref()
            .map(|f| picture(scene, ORIGINAL, &[f]).visibility)
    };
    let apart = |a: &[f32], b: &[f32], steps: f32| {
        let off = |(a, b): &(&f32, &f32)| (*a - *b).abs() > steps / 255.0;
        a.iter().zip(b).filter(off).count()
    };
    let [cancel, evaluate, naive] = of(&with_sphere(scene("cylinder"), 0.5));
    let few = cancel.len() / 1000;
    let [e, n] = [apart(&cancel, &evaluate, 1.5), apart(&cancel, &naive, 2.5)];
    assert!(e <= few && n <= few, "{e}, {n}");
    // Pixels without surface are NaN, which differs from itself.
    assert!(bits(&naive) != bits(&evaluate), "neighbours round apart");
    let large = with_sphere(scene("creature"), 0.4);
    let [cancel, evaluate, _] = of(&large);
    let second = picture(&large, RESTRUCTURED, &[]).visibility;
    let streaks = apart(&evaluate, &second, 1.5);
    assert!(
        streaks > 20 * (apart(&cancel, &second, 1.5) + 1),
        "{streaks}"
    );
}

/// Quads in place of wedges: as many intensities as there are levels and one, and nearer
/// to the continuous ones the more there are; an eye in shadow too.
#[test]
fn levels_of_quads_come_near_to_continuous_intensities() {
    for (name, radius) in [("cylinder", 0.5), ("adversarial-eye-in-shadow", 0.3)] {
        let scene = with_sphere(scene(name), radius);
        let continuous = picture(&scene, ORIGINAL, &[]).visibility;
        let error = |levels: u32| {
            let drawn = picture(&scene, ORIGINAL, &[&format!("levels={levels}")]).visibility;
            let mut shades = std::collections::BTreeSet::new();
            let (mut sum, mut count) = (0.0, 0);
            for (a, b) in drawn.iter().zip(&continuous).filter(|(a, _)| !a.is_nan()) {
                shades.insert((a * levels as f32).round() as u32);
                let step = (a * levels as f32).fract();
                assert!(
                    step.min(1.0 - step) < 1e-3,
                    "{name}: {a} of {levels} levels"
                );
                let off = f64::from(a - b);
                sum += off * off;
                count += 1;
            }
            assert!(shades.len() > levels as usize / 2, "{name}: {shades:?}");
            (sum / f64::from(count)).sqrt()
        };
        let errors = [4, 16, 64].map(error);
        eprintln!("{name}: 4, 16 and 64 levels {errors:.4?}");
        assert!(
            errors[0] > 1.5 * errors[1] && errors[1] < 0.05,
            "{name}: {errors:?}"
        );
        assert!(errors[2] <= errors[1], "{name}: {errors:?}");
    }
}

/// Full light of `shades=k` is k: the buffer holds whole steps of it, penumbrae have as many,
/// and no pixel is off by more than rounding of the wedges that meet in it.
#[test]
fn fewer_shades_are_the_same_shadow_in_larger_steps() {
    for (name, radius) in [
        ("eg-logo", 0.3),
        ("adversarial-eye-in-shadow", 0.3),
        // Side planes meet above the floor: umbra ends without a wedge.
        ("creature", 0.4),
    ] {
        let scene = with_sphere(scene(name), radius);
        for planes in ["cancel", "evaluate", "naive"] {
            let planes = format!("side-planes={planes}");
            let whole = picture(&scene, ORIGINAL, &[&planes]).visibility;
            for shades in [7i16, 31] {
                let set = format!("shades={shades}");
                let held = buffer(&scene, ORIGINAL, &[&planes, &set]);
                let lit = held.iter().filter(|v| **v == shades).count();
                assert!(4 * lit > held.len(), "{name}, {planes}, {set}: {lit} lit");
                let steps: std::collections::BTreeSet<_> =
                    held.iter().map(|v| (*v).clamp(0, shades)).collect();
                assert!(
                    steps.len() > usize::from(shades.unsigned_abs()) / 2,
                    "{steps:?}"
                );
                let drawn = picture(&scene, ORIGINAL, &[&planes, &set]).visibility;
                let step = 1.0 / f32::from(shades);
                let pairs = || drawn.iter().zip(&whole).filter(|(d, _)| !d.is_nan());
                // Of the naive form neighbours round apart, so that a step more is lost.
                let near = if planes.ends_with("naive") {
                    2.01
                } else {
                    1.01
                } * step;
                let off = pairs().filter(|(d, w)| (*d - *w).abs() > near).count();
                println!("{name}, {planes}, {set}: {off} of {}", drawn.len());
                assert!(off * 100 < drawn.len(), "{name}, {planes}, {set}: {off}");
                let mean = pairs().map(|(d, w)| d - w).sum::<f32>() / pairs().count() as f32;
                assert!(mean.abs() < 0.1 * step, "{name}, {planes}, {set}: {mean}");
            }
        }
    }
}

/// Steps of intensity lie half above and half below the ramp that they stand for.
#[test]
fn levels_are_in_the_middle_of_their_steps() {
    let scene = scene("eg-logo");
    let continuous = picture(&scene, ORIGINAL, &[]).visibility;
    for levels in [4u32, 8] {
        let drawn = picture(&scene, ORIGINAL, &[&format!("levels={levels}")]).visibility;
        let pairs = continuous.iter().zip(&drawn);
        let penumbra = pairs.filter(|(c, _)| **c > 0.0 && **c < 1.0);
        let off: Vec<f64> = penumbra.map(|(c, d)| f64::from(d - c)).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64 * f64::from(levels);
        assert!(off.len() > 400, "{}", off.len());
        assert!(mean.abs() < 0.15, "{levels}: {mean} steps");
    }
}

fn matt(name: &str, shape: shape::Shape) -> Object {
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    Object::new(name, mesh, Material::matt([0.7; 3]))
}

fn lit_by_sphere(camera: Camera, centre: DVec3, radius: f64, objects: Vec<Object>) -> Scene {
    let light = Light {
        shape: LightShape::Sphere { centre, radius },
        colour: [1.0; 3],
    };
    Scene::new(camera, vec![light], objects)
}

/// A beam so long that the light is a point for it, and a ball for which it is none: the
/// beam's volume is counted as the ball's is, in the stencil too.
#[test]
fn volumes_of_casters_that_know_a_point_count_with_wedges() {
    let beam = shape::cuboid(DVec3::new(0.3, 0.9, -1500.0), DVec3::new(0.3, 0.3, 3001.0));
    let objects = vec![
        matt("floor", shape::plane(6.0, 0.0)).receiver_only(),
        matt("ball", shape::icosphere(2, 0.4, DVec3::new(-0.8, 0.8, 0.0))),
        matt("beam", beam),
    ];
    let camera = Camera::look_at([0.4, 2.4, 4.0], [0.0, 0.4, -0.5]);
    let scene = lit_by_sphere(camera, DVec3::new(0.6, 3.0, 0.4), 0.02, objects);
    let dark = |b: &[i16]| b.iter().filter(|v| **v < 128).count();
    let reference = buffer(&scene, RESTRUCTURED, &["method=zpass", "passes=single"]);
    assert!(dark(&reference) > 500, "{}", dark(&reference));
    for set in [
        ["method=zpass", "passes=three"],
        ["method=zfail", "passes=three"],
    ] {
        let other = buffer(&scene, RESTRUCTURED, &set);
        let apart = reference.iter().zip(&other);
        let apart = apart.filter(|(a, b)| (**a - **b).abs() > 2).count();
        assert!(apart * 500 < reference.len(), "{set:?}: {apart}");
    }
}

/// A caster round the light, eye and all: counted from infinity, where all of it hides the
/// light, it hides nothing more than counted from the eye.
#[test]
fn a_room_that_casts_is_lit_however_it_is_counted() {
    let objects = vec![
        matt(
            "room",
            shape::cuboid(DVec3::Y * 2.0, DVec3::new(8.0, 4.0, 8.0)),
        ),
        matt("box", shape::cuboid(DVec3::Y * 0.6, DVec3::splat(1.0))),
    ];
    let camera = Camera::look_at([0.6, 2.1, 3.4], [0.0, 0.5, 0.0]);
    let scene = lit_by_sphere(camera, DVec3::new(1.6, 3.2, 1.1), 0.3, objects);
    let [pass, fail] = ["method=zpass", "method=zfail"]
        .map(|method| picture(&scene, RESTRUCTURED, &[method]).visibility);
    let apart = pass
        .iter()
        .zip(&fail)
        .filter(|(a, b)| (**a - **b).abs() > 0.02);
    let count = apart.count();
    assert!(count * 200 < pass.len(), "{count}");
    let dark = |v: &[f32]| v.iter().filter(|v| **v < 0.5).count();
    let [few, other] = [dark(&pass), dark(&fail)];
    assert!(
        few > 300 && few * 3 < pass.len() && other > 300,
        "{few} {other}"
    );
}

/// A square light by its corners is nearer to the truth than by any sphere; the reference
/// is right on parallel plates (their RMSE is 0.003).
#[test]
fn planes_that_touch_a_square_light_are_nearer_to_the_truth_than_spheres() {
    let scene = scene("parallel-plates");
    let truth = picture(&scene, "soft-shadow-volumes", &[]).visibility;
    let error = |technique: &str, light_as: &str| {
        let set = [format!("light-as={light_as}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let drawn = picture(&scene, technique, &set).visibility;
        let pairs = drawn.iter().zip(&truth).filter(|(a, _)| !a.is_nan());
        let squares = pairs.map(|(a, b)| f64::from(a - b) * f64::from(a - b));
        (squares.sum::<f64>() / truth.len() as f64).sqrt()
    };
    for technique in [ORIGINAL, RESTRUCTURED] {
        let errors = ["corners", "equal-area", "bounding-sphere"].map(|l| error(technique, l));
        eprintln!("{technique}: corners, equal area, bounding sphere {errors:.4?}");
        assert!(
            errors[0] < 0.8 * errors[1] && errors[1] < errors[2],
            "{errors:?}"
        );
    }
}

/// zmax throws away blocks, and no bit changes.
#[test]
fn zmax_culls_faces_behind_all_surfaces() {
    for (name, radius) in [("columns", 0.3), ("creature", 0.4), ("spheres", 0.15)] {
        let scene = with_sphere(scene(name), radius);
        let none = buffer(&scene, ORIGINAL, &["culling=none"]);
        assert!(
            none == buffer(&scene, ORIGINAL, &["culling=zmax"]),
            "{name}"
        );
        let of = |set: &[&str]| {
            let drawn = picture(&scene, ORIGINAL, set);
            let pass = drawn.report.passes.iter().find(|p| p.label == "wedges");
            pass.unwrap().totals()
        };
        let [without, with] = [of(&["culling=none"]), of(&["culling=zmax"])];
        assert_eq!(without.tiles.tested, 0, "{name}");
        let [all, left] = [without, with].map(|c| c.fragment_shader_invocations);
        eprintln!(
            "{name}: {left} of {all} invocations, tiles {:?}",
            with.tiles
        );
        assert!(
            with.tiles.culled * 10 > with.tiles.tested,
            "{name}: {:?}",
            with.tiles
        );
        assert!(left * 10 < all * 9, "{name}: {left} of {all}");
    }
}

/// A shadow that ends behind everything is the endless one; one that ends before the
/// floor leaves it lit. Passes, culling and method change nothing of either.
#[test]
fn shadows_may_end() {
    for name in ["columns", "creature", "cylinder"] {
        let scene = scene(name);
        let endless = buffer(&scene, RESTRUCTURED, &[]);
        let long = buffer(&scene, RESTRUCTURED, &["wedge-length=40"]);
        let other = differing(&long, &endless);
        assert!(other <= 4, "{name}: {other} differ");
        let short = ["wedge-length=0.2", "method=zpass"];
        let reference = buffer(&scene, RESTRUCTURED, &short);
        let dark = |b: &[i16]| b.iter().filter(|v| **v < 255).count();
        let [few, all] = [dark(&reference), dark(&endless)];
        assert!(few * 10 < all * 9, "{name}: {few} of {all} dark");
        for way in [
            ["passes=three", "culling=zminmax"],
            ["passes=single", "culling=none"],
            ["passes=single", "culling=zmax"],
            ["tile=4", "separating-axis=full"],
            ["tile=16", "separating-axis=range"],
        ] {
            let other = buffer(&scene, RESTRUCTURED, &[&way[..], &short[..]].concat());
            let count = differing(&other, &reference);
            assert!(count == 0, "{name}: {way:?}: {count} differ");
        }
        let fail = buffer(&scene, RESTRUCTURED, &["wedge-length=0.2", "method=zfail"]);
        let apart = fail.iter().zip(&reference).filter(|(a, b)| {
            let [a, b] = [a, b].map(|v| (**v).clamp(0, 255));
            a != b
        });
        assert!(apart.count() <= 8, "{name}");
    }
}

/// Evaluated or left out, linear or smooth: rays start with what the eye sees of the light.
#[test]
fn every_form_starts_with_the_eyes_own_intensity() {
    for step in [1, 3, 5, 7] {
        let mut scene = with_sphere(scene("cylinder"), 0.5);
        let x = -0.2 - 0.35 * f64::from(step);
        scene.camera = Camera::look_at([x, 0.3, -0.9], [x - 1.0, 0.0, -2.0]);
        for interpolation in ["interpolation=linear", "interpolation=smoothstep"] {
            let form = |sides| picture(&scene, ORIGINAL, &[interpolation, sides]).visibility;
            let cancel = form("side-planes=cancel");
            for (sides, steps) in [("side-planes=evaluate", 2.5), ("side-planes=naive", 3.5)] {
                let other = form(sides);
                let off = |(a, b): (&f32, &f32)| (a - b).abs() > steps / 255.0;
                let count = cancel.iter().zip(&other).filter(|p| off(*p)).count();
                let few = cancel.len() / 200;
                assert!(count <= few, "x = {x}, {interpolation}, {sides}: {count}");
            }
        }
    }
}

/// The eye moves along a line through a penumbra into the umbra: no jump.
#[test]
fn an_eye_may_be_anywhere() {
    for step in 0..8 {
        let mut scene = with_sphere(scene("cylinder"), 0.5);
        let x = -0.2 - 0.35 * f64::from(step);
        scene.camera = Camera::look_at([x, 0.3, -0.9], [x - 1.0, 0.0, -2.0]);
        let first = picture(&scene, ORIGINAL, &[]).visibility;
        let second = picture(&scene, RESTRUCTURED, &[]).visibility;
        let off = |(a, b): (&f32, &f32)| (a - b).abs() > 2.5 / 255.0;
        let count = first.iter().zip(&second).filter(|p| off(*p)).count();
        assert!(count <= first.len() / 500, "eye at x = {x}: {count}");
    }
}

fn measured(scene: &Scene, set: &[&str]) -> Measured {
    let params = params(RESTRUCTURED, set);
    measure(scene, SIZE, &params, GpuConfig::default()).unwrap()
}

#[test]
fn culling_saves_reads_and_no_writes_and_the_model_counts_what_the_gpu_reads() {
    for scene in hard_cases() {
        let name = &scene.name;
        for passes in ["passes=single", "passes=three"] {
            let run = |culling: &str, axes: &str| {
                let m = measured(&scene, &[passes, culling, axes, "tile=8"]);
                // One pass reads depth by the depth test and for the intensity.
                let read = m.gpu.traffic.tex[0].read_accesses;
                let penumbrae = m.traffic.penumbra_depth_reads;
                let three = passes == "passes=three";
                let fine = if three {
                    read == penumbrae
                } else {
                    read >= penumbrae
                };
                assert!(fine, "{name}, {passes}, {culling}: {read} of {penumbrae}");
                assert_eq!(m.traffic.fragments, m.gpu.fragments.generated, "{name}");
                assert_eq!(m.gpu.events.blend_saturated, [0; 4], "{name}");
                m.traffic
            };
            let faces = "separating-axis=faces";
            let none = run("culling=none", faces);
            let zmax = run("culling=zmax", faces);
            let both = run("culling=zminmax", faces);
            let full = run("culling=zminmax", "separating-axis=full");
            let quick = run("culling=zminmax", "separating-axis=range-faces");
            let alone = run("culling=zminmax", "separating-axis=range");
            eprintln!("{name}, {passes}:\n  {none:?}\n  {zmax:?}\n  {both:?}\n  {full:?}");
            eprintln!("  quick {quick:?}\n  alone {alone:?}");
            // The quick test saves tests of planes, and hardly a read; alone, few reads.
            assert_eq!((both.quickly_rejected, quick.tested), (0, both.tested));
            assert!(quick.quickly_rejected > 0, "{name}");
            assert_eq!(quick.quickly_rejected, alone.quickly_rejected, "{name}");
            assert!(quick.culled >= both.culled && quick.culled <= full.culled);
            assert!(both.depth_reads < alone.depth_reads, "{name}");
            assert!(alone.depth_reads < none.depth_reads, "{name}");
            let reads = [none, zmax, both, full].map(|t| t.depth_reads);
            assert!(reads.is_sorted_by(|a, b| a >= b), "{name}: {reads:?}");
            assert!(reads[2] * 10 < reads[0] * 9, "{name}: {reads:?}");
            for other in [zmax, both, full] {
                assert_eq!(other.intensity_writes, none.intensity_writes, "{name}");
                assert_eq!(other.stencil_writes, none.stencil_writes, "{name}");
                assert_eq!(other.fragments, none.fragments, "{name}");
            }
            assert_eq!(none.tested, 0);
            assert_eq!(zmax.tested, both.tested);
            assert!(zmax.culled < both.culled && both.culled <= full.culled);
        }
    }
}

#[test]
fn a_single_pass_reads_and_writes_less_than_three() {
    for name in ["columns", "creature", "cylinder"] {
        let scene = scene(name);
        let [one, three] =
            ["passes=single", "passes=three"].map(|p| measured(&scene, &[p, "tile=8"]).traffic);
        let writes = |t: &TileTraffic| t.intensity_writes + t.stencil_writes;
        eprintln!(
            "{name}: depth reads {} of {}, writes {} of {}",
            one.depth_reads,
            three.depth_reads,
            writes(&one),
            writes(&three)
        );
        assert!(one.depth_reads < three.depth_reads, "{name}");
        assert!(writes(&one) < writes(&three), "{name}");
    }
}

/// Fronts are counted by the depth test alone: no shader runs for them in three passes,
/// and blocks of the emulated GPU are tested and culled.
#[test]
fn the_umbra_is_counted_by_the_depth_test() {
    for name in ["columns", "creature"] {
        let drawn = picture(&scene(name), RESTRUCTURED, &["passes=three"]);
        for label in ["umbra front", "umbra back"] {
            let pass = drawn.report.passes.iter().find(|p| p.label == label);
            let totals = pass.unwrap().totals();
            assert_eq!(totals.fragment_shader_invocations, 0, "{name}, {label}");
            assert!(totals.fragments.written > 100, "{name}, {label}");
            let tiles = totals.tiles;
            assert!(
                tiles.tested > 100 && tiles.culled * 4 > tiles.tested,
                "{name}: {tiles:?}"
            );
        }
        // In one pass, where the depth test decides both, nothing is shaded and thrown away.
        let found = techniques::find(RESTRUCTURED).unwrap();
        let single = params(RESTRUCTURED, &["passes=single"]);
        let frame = found.frame(&scene(name), SIZE, &single).unwrap();
        let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
        gpu.load(&frame.recording).unwrap();
        let report = gpu.submit(&frame.recording.list).unwrap();
        let draws = frame.recording.list.passes.iter().flat_map(|p| &p.draws);
        let counters = report.passes.iter().flat_map(|p| &p.draws);
        let both = draws.zip(counters);
        let both = both.filter(|(d, _)| d.pipeline.label == "umbra and penumbra");
        let mut failed = 0;
        for (_, draw) in both {
            let fragments = draw.counters.fragments;
            assert_eq!(fragments.discarded, 0, "{name}");
            failed += fragments.depth_failed + fragments.hiz_killed;
        }
        assert!(failed > 1000, "{name}: {failed}");
    }
}

/// A tile is tested once for each wedge whose bounds it lies in, not once a pixel.
#[test]
fn tiles_are_tested_once_a_wedge_and_not_once_a_pixel() {
    for name in ["columns", "creature"] {
        let drawn = picture(&scene(name), RESTRUCTURED, &["passes=three", "tile=8"]);
        let counted = |what: &str| {
            let all = drawn.report.shader_counts();
            all.iter().find(|(n, _)| *n == what).map_or(0, |(_, c)| *c)
        };
        let [tested, culled] = ["tiles-tested", "tiles-culled"].map(counted);
        let pixels: u64 = drawn
            .report
            .passes
            .iter()
            .filter(|p| p.label == "penumbra")
            .map(|p| p.totals().fragment_shader_invocations)
            .sum();
        eprintln!("{name}: {tested} tiles tested, {culled} culled, {pixels} pixels");
        assert!(
            culled * 2 > tested && culled < tested,
            "{name}: {culled} of {tested}"
        );
        assert!(
            tested * 4 < pixels,
            "{name}: {tested} tests, {pixels} pixels"
        );
    }
}

#[test]
fn execution_changes_no_bit() {
    for technique in [ORIGINAL, RESTRUCTURED] {
        let scene = scene("creature");
        let reference = buffer(&scene, technique, &[]);
        for (threads, tile, simd) in [
            (1, 16, SimdLevel::scalar()),
            (3, 128, SimdLevel::detect()),
            (2, 32, SimdLevel::scalar()),
        ] {
            let config = GpuConfig {
                threads,
                tile,
                simd,
                skip: false,
            };
            let other = buffer_with(&scene, technique, &[], config);
            assert!(other == reference, "{technique}: {threads} {tile} {simd}");
        }
    }
}

/// Every kind of light, several at once, and one buffer each.
#[test]
fn several_lights_of_all_kinds() {
    let mut scene = scene("cylinder");
    let position = DVec3::new(-2.0, 4.0, 1.0);
    let light = |shape| Light {
        shape,
        colour: [0.4; 3],
    };
    scene.lights.push(light(LightShape::Sphere {
        centre: position,
        radius: 0.4,
    }));
    scene.lights.push(light(LightShape::Point { position }));
    scene.lights.push(light(LightShape::Disc {
        centre: position,
        normal: DVec3::Y,
        radius: 0.5,
    }));
    scene.lights.push(light(LightShape::Directional {
        towards: DVec3::new(0.5, 2.0, 0.3),
    }));
    for technique in [ORIGINAL, RESTRUCTURED] {
        let all = picture(&scene, technique, &[]);
        let alone = picture(&scene, technique, &["light=0"]);
        assert_eq!(bits(&all.visibility), bits(&alone.visibility));
        let labels: Vec<&str> = all.report.passes.iter().map(|p| p.label.as_str()).collect();
        assert!(labels.contains(&"lit 4") && labels.contains(&"lit 0"));
        let spheres = all.warnings.iter().filter(|w| w.code == "light-as-sphere");
        assert_eq!(spheres.count(), 2, "{:?}", all.warnings);
        let hard = picture(&scene, "shadow-volumes", &["light=4"]);
        let parallel = picture(&scene, technique, &["light=4"]);
        assert_eq!(bits(&parallel.visibility), bits(&hard.visibility));
    }
}

/// Lights use one buffer in turn: each finds it cleared, one without casters too.
#[test]
fn lights_leave_nothing_behind_in_the_buffer() {
    let mut all = with_sphere(scene("creature"), 0.4);
    let sun = Light {
        shape: LightShape::Directional {
            towards: DVec3::new(0.2, 1.0, 0.4),
        },
        colour: [0.5; 3],
    };
    all.lights.insert(0, sun); // drawn last
    for technique in [ORIGINAL, RESTRUCTURED] {
        let both = picture(&all, technique, &[]);
        let alone = picture(&all, technique, &["light=0"]);
        let bits = |p: &Rendered| p.visibility.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert!(bits(&both) == bits(&alone), "{technique}");
        let mut bare = all.clone();
        bare.objects.iter_mut().for_each(|o| o.casts = false);
        let lit = picture(&bare, technique, &[]);
        assert!(
            lit.visibility.iter().all(|v| v.is_nan() || *v == 1.0),
            "{technique}"
        );
    }
}
