//! Soft shadow volumes against the exact oracle and the closed form, and against
//! themselves where nothing may change a bit.

use crate::drawing::drawn_on;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{GpuConfig, SimdLevel};

const SIZE: [u32; 2] = [120, 80];

fn scene(name: &str) -> Scene {
    builtin::build(name).unwrap()
}

fn with(scene: &Scene, set: &[&str], gpu: GpuConfig) -> Rendered {
    render_by("soft-shadow-volumes", scene, set, gpu)
}

fn optimised(scene: &Scene, set: &[&str]) -> Rendered {
    let name = "soft-shadow-volumes-optimised";
    render_by(name, scene, set, GpuConfig::default())
}

fn render_by(name: &str, scene: &Scene, set: &[&str], gpu: GpuConfig) -> Rendered {
    drawn_on(scene, name, set, SIZE, gpu)
}

fn soft(scene: &Scene, set: &[&str]) -> Rendered {
    with(scene, set, GpuConfig::default())
}

fn truth(scene: &Scene) -> VisibilityImage {
    VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap()
}

fn error(scene: &Scene, truth: &VisibilityImage, set: &[&str]) -> VisibilityError {
    measured(scene, truth, set, &soft(scene, set))
}

fn measured(
    scene: &Scene,
    truth: &VisibilityImage,
    set: &[&str],
    picture: &Rendered,
) -> VisibilityError {
    let error = VisibilityError::measure(truth, SIZE, &picture.visibility).unwrap();
    println!("{} {set:?}: {:?}", scene.name, error.all);
    error
}

fn shaded(picture: &Rendered) -> u64 {
    let wedges = picture.report.passes.iter().filter(|p| p.label == "wedges");
    wedges
        .flat_map(|p| &p.draws)
        .filter(|d| d.label == "penumbra")
        .map(|d| d.counters.fragments.written)
        .sum()
}

#[test]
fn parallel_plates_are_the_closed_form() {
    let scene = scene("parallel-plates");
    let truth = truth(&scene);
    let exact = error(&scene, &truth, &[]);
    assert!(exact.all.unwrap().rmse < 1e-5);
    // Entries have 8 bits for 0..1/2, and their places are rounded: by measure
    // 0.0079 RMS and 0.065 at most for one edge (docs/papers.md, paper III), of which two
    // meet in most places. Filters mix both sides of the light's centre, where the
    // coverage of an edge that ends there jumps: a pixel or two are further off.
    let table = |more: &[&str]| {
        let set = [&["backend=texture4d"], more].concat();
        error(&scene, &truth, &set).all.unwrap()
    };
    let nearest = table(&[]);
    let linear = table(&["texture-filter=quadlinear"]);
    let vertex = table(&["texture-filter=quadlinear", "texture-centred=vertex"]);
    let finer = table(&["texture-size=64"]);
    assert!(
        nearest.rmse < 0.0079 && nearest.max < 2.0 * 0.065,
        "{nearest:?}"
    );
    assert!(
        nearest.rmse > 100.0 * exact.all.unwrap().rmse,
        "a table is not exact"
    );
    assert!(finer.rmse < 0.75 * nearest.rmse, "{finer:?}");
    assert!(linear.p99 < nearest.p99 && vertex.p99 < linear.p99);
    assert!(
        vertex.p99 < 2.0 * 0.5 / 510.0,
        "quantisation alone: {vertex:?}"
    );
    // Four edges, each rounded to 1/63.
    let bytes = error(&scene, &truth, &["buffer=rgba8x2"]).all.unwrap();
    assert!(
        bytes.max <= 4.0 * 0.5 / 63.0 + 1e-4 && bytes.rmse > 1e-4,
        "{bytes:?}"
    );
}

#[test]
fn nothing_that_only_skips_changes_a_bit() {
    for name in ["cylinder", "overlap", "adversarial-eye-in-shadow"] {
        let scene = scene(name);
        let reference = soft(&scene, &[]);
        for set in [
            &["skip=off"][..],
            &["wedge=paper3"],
            &["wedge=paper4"],
            &["wedge=paper3", "skip=off"],
            &["copy-back=on"],
        ] {
            let other = soft(&scene, set);
            let same = other.visibility_hash() == reference.visibility_hash();
            assert!(same, "{name} {set:?}");
            assert_eq!(other.color_hash(), reference.color_hash(), "{name} {set:?}");
        }
        let simd = SimdLevel::available().into_iter().next().unwrap();
        for (threads, tile) in [(1, 16), (3, 64), (4, 128)] {
            let gpu = GpuConfig {
                threads,
                tile,
                simd,
                ..GpuConfig::default()
            };
            let other = with(&scene, &[], gpu);
            assert_eq!(
                other.visibility_hash(),
                reference.visibility_hash(),
                "{name} {tile}"
            );
        }
    }
}

/// Fragments of wedges whose coverage changed the buffer.
fn useful(picture: &Rendered) -> u64 {
    let wedges = picture.report.passes.iter().filter(|p| p.label == "wedges");
    let silent: u64 = wedges
        .map(|p| p.totals().events.silent_color_writes[0])
        .sum();
    shaded(picture) - silent
}

#[test]
fn tighter_wedges_shade_less() {
    let scene = scene("cylinder");
    let count = |set: &[&str]| shaded(&soft(&scene, set));
    let [exact, tight, sphere] =
        ["exact", "paper4", "paper3"].map(|w| count(&[&format!("wedge={w}")]));
    let all = count(&["skip=off"]);
    println!("shaded: exact {exact}, paper IV {tight}, paper III {sphere}, no skip {all}");
    assert!(exact <= tight && tight < sphere && sphere < all);
    let useful = useful(&soft(&scene, &["wedge=exact"]));
    println!("shaded over useful: {}", exact as f64 / useful as f64);
    assert!(exact as f64 / (useful as f64) < 1.3);
}

#[test]
fn the_known_errors_are_there_and_the_oracle_has_none() {
    let scene = scene("single-silhouette");
    let truth = truth(&scene);
    let picture = soft(&scene, &[]);
    let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
    let umbra = error.of_region(LightRegion::Umbra).unwrap();
    println!("single-silhouette umbra: {umbra:?}");
    // Below the cube: dark in truth, not so by the silhouette.
    assert!(umbra.max > 0.1);
    let scene = self::scene("overlap");
    let truth = self::truth(&scene);
    let summed = self::error(&scene, &truth, &[]);
    // Where penumbrae overlap the sum is too dark, nowhere too bright.
    let penumbra = summed.of_region(LightRegion::Penumbra).unwrap();
    assert!(
        penumbra.mean < -0.001 && penumbra.max > 0.02,
        "{penumbra:?}"
    );
}

#[test]
fn twelve_bits_are_as_exact_as_they_say() {
    let scene = scene("parallel-plates");
    let truth = truth(&scene);
    let of = |set: &[&str]| {
        let picture = optimised(&scene, set);
        measured(&scene, &truth, set, &picture).all.unwrap()
    };
    // Four edges, each rounded to 1/4095, and floats.
    let exact = of(&[]);
    assert!(
        exact.max <= 4.0 * 0.5 / 4095.0 + 2e-5 && exact.rmse > 1e-6,
        "{exact:?}"
    );
    // The split map leaves 10 bits: 1/1023 and then 1/4095.
    let ten = of(&["split-bits=lut"]);
    assert!(
        ten.max <= 4.0 * (0.5 / 1023.0 + 0.5 / 4095.0) + 2e-5,
        "{ten:?}"
    );
    assert!(ten.rmse > 2.0 * exact.rmse, "10 bits are worse than 12");
    // Angles are rounded to 1/255 of a turn, at both ends of each edge, and areas
    // to 1/510: the square's area grows by at most twice the angle's share.
    let tables = of(&["coverage=lut"]);
    assert!(
        tables.max <= 4.0 * (2.0 * 2.0 * 0.5 / 255.0 + 0.5 / 510.0),
        "{tables:?}"
    );
    assert!(tables.rmse > ten.rmse);
}

#[test]
fn what_only_skips_changes_no_bit_when_split_either() {
    let scene = scene("overlap");
    for set in [&["combine=sum"][..], &["combine=paper"], &["split=2"]] {
        let reference = optimised(&scene, set);
        for more in ["skip=off", "wedge=exact", "wedge=paper3"] {
            let other = optimised(&scene, &[set, &[more]].concat());
            let same = other.visibility_hash() == reference.visibility_hash();
            assert!(same, "{set:?} {more}");
        }
    }
}

/// The RMSE of lights split k x k; shaded pixels grow by less than k².
fn split_errors(name: &str, splits: &[u32]) -> Vec<f64> {
    let scene = scene(name);
    let truth = truth(&scene);
    let one = shaded(&optimised(&scene, &[]));
    let error = |k: &u32| {
        let set = [&*format!("split={k}")];
        let picture = optimised(&scene, &set);
        let rmse = measured(&scene, &truth, &set, &picture).all.unwrap().rmse;
        let shaded = shaded(&picture);
        println!("{name} {k}x{k}: {rmse:.6}, {shaded} shaded of {one}");
        assert!(
            *k == 1 || shaded < u64::from(k * k) * one,
            "{name}: {k}x{k}"
        );
        rmse
    };
    splits.iter().map(error).collect()
}

#[test]
fn splitting_the_light_approaches_the_truth() {
    for name in ["cylinder", "creature", "columns"] {
        let errors = split_errors(name, &[1, 2, 3, 8]);
        assert!(errors.windows(2).all(|w| w[1] < w[0]), "{name}: {errors:?}");
        assert!(errors[3] < 0.5 * errors[0], "{name}: {errors:?}");
    }
    // Where a face's plane cuts a part of the light its silhouette is wrong whatever
    // the size, so symmetric scenes need not fall step by step.
    for name in ["overlap", "single-silhouette"] {
        let errors = split_errors(name, &[1, 8]);
        assert!(errors[1] < 0.25 * errors[0], "{name}: {errors:?}");
    }
    // The planes of the cube's sides cut this light into 3 x 3: no silhouette
    // changes within a part, and nothing is approximated.
    let [thirds] = split_errors("single-silhouette", &[3])[..] else {
        unreachable!()
    };
    assert!(thirds < 1e-4, "{thirds}");
}

#[test]
fn combining_silhouettes_is_between_the_extremes() {
    let scene = scene("overlap");
    let truth = truth(&scene);
    let rmse = |rule: &str| {
        let set = [&*format!("combine={rule}")];
        let picture = optimised(&scene, &set);
        measured(&scene, &truth, &set, &picture).all.unwrap()
    };
    let [sum, paper, bounded] = ["sum", "paper", "bounded"].map(rmse);
    // Both rules hide less than the sum, and are nearer to the truth. They differ
    // where two casters hide more than all: the paper's rule is cut off there.
    assert!(sum.mean < paper.mean && paper.mean < bounded.mean);
    assert!(bounded.rmse < paper.rmse && paper.rmse < 0.7 * sum.rmse);
}

/// Everything that is hard: no NaN, nothing outside 0..=1, surfaces where there are
/// some.
#[test]
fn adversarial_scenes_stay_sane() {
    for entry in builtin::SCENES
        .iter()
        .filter(|s| s.name.starts_with("adversarial"))
    {
        let scene = entry.build();
        let picture = soft(&scene, &[]);
        let sane = |v: &f32| v.is_nan() || (0.0..=1.0).contains(v);
        assert!(picture.visibility.iter().all(sane), "{}", entry.name);
        assert!(
            picture.warnings.iter().all(|w| w.code != "nan"),
            "{}",
            entry.name
        );
        let truth = truth(&scene);
        let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
        println!("{}: {:?}", entry.name, error.all);
        // At outlines a ray and a rasteriser may differ.
        assert!(
            error.mask.surplus + error.mask.missing <= 4,
            "{}",
            entry.name
        );
        assert_eq!(error.mask.out_of_range, 0, "{}", entry.name);
    }
}

/// Figures, for whoever reads the output.
#[test]
fn built_in_scenes_against_the_truth() {
    for name in ["cylinder", "creature", "spheres", "columns", "demo"] {
        let scene = scene(name);
        let truth = truth(&scene);
        let error = error(&scene, &truth, &[]).all.unwrap();
        assert!(error.rmse < 0.1, "{name}: {error:?}");
    }
}

/// A stack of forty plates under one light: their edges overlap in 40 wedges and
/// more than four times what six bits hold, which is said; floats hold it.
#[test]
fn capacity_is_reported_when_it_is_reached() {
    let scene = stack(40);
    let codes = |picture: &Rendered| -> Vec<&'static str> {
        picture.warnings.iter().map(|w| w.code).collect()
    };
    assert!(codes(&soft(&scene, &["buffer=rgba8x2"])).contains(&"coverage-saturated"));
    assert!(codes(&optimised(&scene, &[])).contains(&"coverage-saturated"));
    assert!(!codes(&optimised(&scene, &["combine=bounded"])).contains(&"coverage-saturated"));
    assert!(codes(&soft(&scene, &[])).is_empty());
}

/// Plates whose edges are behind each other as seen from the light's centre.
fn stack(count: u32) -> Scene {
    use gnomon_pipeline::world::light::Light;
    use gnomon_pipeline::world::mesh::Shading;
    use gnomon_pipeline::world::scene::{Camera, Material, Object};
    use gnomon_pipeline::world::shape;
    let solid = |name: String, shape: shape::Shape| {
        let mesh = shape.into_mesh(Shading::Flat).unwrap();
        Object::new(name, mesh, Material::matt([0.7; 3]))
    };
    let top = 6.0;
    let plate = |k: u32| {
        let y = 0.5 + 0.05 * f64::from(k);
        let side = 0.25 * (top - y - 0.005);
        let size = glam::DVec3::new(side, 0.01, side);
        solid(
            format!("plate {k}"),
            shape::cuboid(glam::DVec3::Y * y, size),
        )
    };
    let mut objects = vec![solid("floor".to_owned(), shape::plane(4.0, 0.0)).receiver_only()];
    objects.extend((0..count).map(plate));
    let light = Light::horizontal_square(glam::DVec3::Y * top, 1.0);
    let camera = Camera::look_at([2.0, 1.0, 2.5], [0.0, 0.2, 0.0]);
    Scene::new(camera, vec![light], objects)
}

/// Red is the half of the light along its first edge: its visibility is that of a
/// light of that half alone.
#[test]
fn a_two_colour_light_is_two_half_lights() {
    use gnomon_pipeline::world::light::LightShape;
    let scene = scene("parallel-plates");
    let mut half = scene.clone();
    let LightShape::Rectangle { centre, edge_u, .. } = &mut half.lights[0].shape else {
        unreachable!()
    };
    *centre -= *edge_u / 4.0;
    *edge_u /= 2.0;
    let truth = self::truth(&half);
    let set = [
        "light-image=halves",
        "texture-filter=quadlinear",
        "texture-centred=vertex",
    ];
    let both = error(&scene, &truth, &set).all.unwrap();
    let white = error(&scene, &truth, &[]).all.unwrap();
    // But for the pixels whose edges end at the light's centre, where filters mix.
    assert!(
        both.p99 < 2e-3 && both.rmse < 0.3 * white.rmse,
        "{both:?} {white:?}"
    );
}

/// Of a sphere no more is seen than up to its horizon: a box beside it, within the cone
/// in which it is seen and nearer than its centre, hides nothing from right below. Half
/// way down the same rays it does.
#[test]
fn what_is_behind_a_spheres_horizon_hides_nothing() {
    use glam::DVec3;
    use gnomon_pipeline::world::light::{Light, LightShape};
    use gnomon_pipeline::world::mesh::Shading;
    use gnomon_pipeline::world::scene::{Camera, Material, Object};
    use gnomon_pipeline::world::shape;
    let solid = |shape: shape::Shape| {
        let mesh = shape.into_mesh(Shading::Flat).unwrap();
        Object::new("solid", mesh, Material::matt([0.7; 3]))
    };
    let seen = |nearer: f64, set: &[&str]| {
        let (centre, size) = (DVec3::new(1.01, 1.2, 0.0), DVec3::new(0.06, 0.04, 0.2));
        let the_box = shape::cuboid(centre * nearer, size * nearer);
        let floor = solid(shape::plane(4.0, 0.0)).receiver_only();
        let light = Light {
            shape: LightShape::Sphere {
                centre: DVec3::Y * 1.5,
                radius: 1.0,
            },
            colour: [1.0; 3],
        };
        // Looks at the point below, from under the box.
        let camera = Camera::look_at([-2.0, 0.3, 0.4], [0.0, 0.0, 0.0]);
        let scene = Scene::new(camera, vec![light], vec![floor, solid(the_box)]);
        let done = soft(&scene, set);
        done.visibility[(SIZE[0] * (SIZE[1] / 2) + SIZE[0] / 2) as usize]
    };
    // Depth keeps the shader away from most of what is behind; it has to know without.
    for set in [&[][..], &["skip=off"], &["skip=off", "wedge=paper3"]] {
        let (behind, before) = (seen(1.0, set), seen(0.5, set));
        println!("{set:?}: {behind} {before}");
        assert!(behind > 0.999_99 && before < 0.999_5, "{behind} {before}");
    }
}

/// Next to the hard edge, where ends come near the light's centre, linear look-ups are
/// better than nearest ones, as elsewhere: no speckles.
#[test]
fn quadlinear_look_ups_do_not_speckle() {
    for name in ["cylinder", "creature", "parallel-plates"] {
        let scene = scene(name);
        let exact = soft(&scene, &[]);
        let off = |more: &[&str]| {
            let set = [&["backend=texture4d"], more].concat();
            let table = soft(&scene, &set);
            let pairs = exact.visibility.iter().zip(&table.visibility);
            let off = pairs.map(|(a, b)| f64::from((a - b).abs()));
            let off: Vec<f64> = off.filter(|d| !d.is_nan()).collect();
            let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
            let max = off.iter().copied().fold(0.0, f64::max);
            println!("{name} {set:?}: RMS {rms:.5} max {max:.4}");
            (rms, max)
        };
        let nearest = off(&[]);
        for centred in ["texture-centred=cell", "texture-centred=vertex"] {
            let linear = off(&["texture-filter=quadlinear", centred]);
            assert!(
                linear.0 < nearest.0,
                "{name} {centred}: {linear:?} {nearest:?}"
            );
            // Creature has edges that pass the centre in pieces; the plate's four do not.
            let most = if name == "parallel-plates" {
                0.08
            } else {
                0.25
            };
            assert!(linear.1 < most, "{name} {centred}: {linear:?} {nearest:?}");
        }
    }
}
