//! Paper III's own buffers and counts: 8 bits in red and green with the umbra in the
//! stencil, quads by depth test, copying back without blending; and what rounds there.

use glam::DVec3;

use crate::drawing::drawn;
use crate::soft_shaders::{COUNT, full_screen, gpu, red as red_of, submit, texture};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, Params, PassRole};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Format, LoadOp, Subresource};
use gnomon_shaders::visibility_buffers::ResolveRedGreen;

const SIZE: [u32; 2] = [120, 80];
const NAME: &str = "soft-shadow-volumes";

fn draw(scene: &Scene, set: &[&str]) -> Rendered {
    drawn(scene, NAME, set, SIZE)
}

fn rmse(scene: &Scene, done: &Rendered) -> f64 {
    let truth = VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap();
    let error = VisibilityError::measure(&truth, SIZE, &done.visibility).unwrap();
    println!("{}: {:?}", scene.name, error.all);
    error.all.unwrap().rmse
}

/// Pixels that differ by more than `most`, of how many.
fn apart(a: &Rendered, b: &Rendered, most: f32) -> (usize, usize) {
    let pairs = a.visibility.iter().zip(&b.visibility);
    let off: Vec<f32> = pairs
        .map(|(a, b)| (a - b).abs())
        .filter(|d| !d.is_nan())
        .collect();
    (off.iter().filter(|d| **d > most).count(), off.len())
}

/// One buffer and the stencil hold what two buffers do, but where a surface is within
/// rounding of a quad; with the eye in shadow too.
#[test]
fn red_green_and_the_stencil_are_the_two_buffers() {
    for name in ["cylinder", "creature", "adversarial-eye-in-shadow"] {
        let scene = builtin::build(name).unwrap();
        let [one, two] = ["buffer=rgba8", "buffer=rgba8x2"].map(|b| draw(&scene, &[b]));
        let (off, all) = apart(&one, &two, 1e-5);
        println!("{name}: {off} of {all}");
        assert!(all > 4000 && 300 * off < all, "{name}: {off} of {all}");
        let [one, two] = [&one, &two].map(|d| rmse(&scene, d));
        assert!(one < two + 0.01, "{name}: {one} {two}");
    }
}

/// The umbra is counted without a shader, by the depth test, and coverage goes to red
/// and green of one texture of 4 bytes.
#[test]
fn the_umbra_is_in_the_stencil_and_coverage_in_one_texture() {
    let scene = builtin::build("cylinder").unwrap();
    let done = draw(&scene, &["buffer=rgba8"]);
    let of = |role: PassRole| {
        let all = done.report.passes.iter().zip(done.roles.passes());
        let passes = all.filter(|(_, r)| **r == role).map(|(p, _)| p.totals());
        passes.collect::<Vec<_>>()
    };
    let (count, wedges) = (of(PassRole::HardCount), of(PassRole::Wedges));
    assert_eq!((count.len(), wedges.len()), (1, 1));
    assert_eq!(count[0].fragment_shader_invocations, 0);
    assert!(count[0].traffic.stencil.write_bytes > 0 && count[0].traffic.z.read_bytes > 0);
    assert!(wedges[0].fragment_shader_invocations > 0);
    let [float, bytes] = [&[][..], &["buffer=rgba8"]].map(|set| {
        let technique = find(NAME).unwrap();
        let published = ["horizon=off"];
        let params = Params::parse(technique, published.iter().chain(set)).unwrap();
        let frame = technique.frame(&scene, SIZE, &params).unwrap();
        frame
            .recording
            .textures()
            .iter()
            .filter(|t| t.descriptor().label == "coverage")
            .count()
    });
    assert_eq!((float, bytes), (0, 1));
}

/// Quads by depth test are those by sides, but within rounding.
#[test]
fn counting_by_depth_is_counting_by_sides() {
    for name in ["cylinder", "creature", "adversarial-eye-in-shadow"] {
        let scene = builtin::build(name).unwrap();
        for copy in ["copy-back=off", "copy-back=on"] {
            let [depth, sides] = ["count=depth", "count=sides"].map(|c| draw(&scene, &[c, copy]));
            let (off, all) = apart(&depth, &sides, 1e-5);
            println!("{name} {copy}: {off} of {all}");
            assert!(300 * off < all, "{name} {copy}: {off} of {all}");
        }
        // The depth test leaves fragments out.
        let shaded = |set: &[&str]| -> u64 {
            let done = draw(&scene, set);
            let all = done.report.passes.iter().zip(done.roles.passes());
            all.filter(|(_, r)| **r == PassRole::HardCount)
                .map(|(p, _)| p.totals().fragment_shader_invocations)
                .sum()
        };
        assert!(shaded(&["count=depth"]) < shaded(&[]), "{name}");
    }
}

/// Four passes for each wedge, of which none blends: umbra and penumbra, each copied back.
#[test]
fn copying_back_blends_nothing_and_takes_four_passes_a_wedge() {
    let scene = builtin::build("cylinder").unwrap();
    let technique = find(NAME).unwrap();
    let params = Params::parse(technique, ["horizon=off", "copy-back=on", "wedge=paper3"]).unwrap();
    let frame = technique.frame(&scene, SIZE, &params).unwrap();
    let (mut passes, mut wedges) = (0, 0);
    for (number, pass) in frame.recording.list.passes.iter().enumerate() {
        if !frame.roles.of_pass(number).adds_up_coverage() {
            continue;
        }
        passes += usize::from(!pass.draws.is_empty());
        for (k, draw) in pass.draws.iter().enumerate() {
            let targets = &draw.pipeline.color_targets;
            assert!(
                targets.iter().all(|t| *t != ColorTargetState::ADDITIVE),
                "{}",
                draw.label
            );
            wedges += usize::from(frame.roles.of_draw(number, k) == DrawRole::CoverageAside);
        }
    }
    assert!(wedges > 30);
    assert_eq!(passes, 4 * wedges);
}

/// Coverage is the nearest of 63 steps on either side of the hard edge: no bias.
#[test]
fn six_bits_round_to_nearest() {
    let scene = builtin::build("parallel-plates").unwrap();
    let exact = draw(&scene, &[]);
    for buffer in ["buffer=rgba8x2", "buffer=rgba8"] {
        let bytes = draw(&scene, &[buffer]);
        let pairs = exact.visibility.iter().zip(&bytes.visibility);
        let pairs: Vec<(f64, f64)> = pairs
            .map(|(a, b)| (f64::from(*a), f64::from(*b)))
            .filter(|(a, b)| *a > 0.02 && *a < 0.98 && (a - b).abs() < 0.1)
            .collect();
        let mean = |lit: bool| {
            let side = pairs.iter().filter(|(a, _)| (*a > 0.5) == lit);
            let off: Vec<f64> = side.map(|(a, b)| b - a).collect();
            assert!(off.len() > 200);
            off.iter().sum::<f64>() / off.len() as f64
        };
        // Rounding down is off by half a step, 0.008, for each edge, up in the light and
        // down in the shadow.
        let [lit, dark] = [true, false].map(mean);
        println!("{buffer}: {lit} {dark}");
        assert!(
            lit.abs() < 0.003 && dark.abs() < 0.003,
            "{buffer}: {lit} {dark}"
        );
    }
}

/// More umbrae over one another than the stencil counts are said.
#[test]
fn umbrae_beyond_the_stencil_are_warned_of() {
    let plates = |count: u32| {
        let solid = |shape: shape::Shape| {
            let mesh = shape.into_mesh(Shading::Flat).unwrap();
            Object::new("plates", mesh, Material::matt([0.7; 3]))
        };
        let plate = |k: u32| {
            let y = 0.5 + 0.005 * f64::from(k);
            shape::cuboid(DVec3::Y * y, DVec3::new(1.0, 0.002, 1.0))
        };
        let floor = solid(shape::plane(4.0, 0.0)).receiver_only();
        let all = solid(shape::Shape::merged((0..count).map(plate)));
        let light = Light::horizontal_square(DVec3::Y * 4.0, 0.5);
        let camera = Camera::look_at([2.0, 1.5, 2.5], [0.0, 0.2, 0.0]);
        Scene::new(camera, vec![light], vec![floor, all])
    };
    let warned = |count: u32, buffer: &str| {
        let done = drawn(
            &plates(count),
            NAME,
            &[buffer, "open-casters=generalised"],
            [24, 16],
        );
        done.warnings
            .iter()
            .any(|w| w.code == "umbrae-exceed-stencil")
    };
    assert!(warned(130, "buffer=rgba8"));
    assert!(!warned(100, "buffer=rgba8") && !warned(130, "buffer=r32f"));
}

#[test]
fn one_colour_is_all_that_red_and_green_hold() {
    let technique = find(NAME).unwrap();
    let params = Params::parse(technique, ["buffer=rgba8", "light-image=fire"]).unwrap();
    let scene = builtin::build("cylinder").unwrap();
    let refused = technique
        .frame(&scene, SIZE, &params)
        .err()
        .unwrap()
        .to_string();
    assert!(refused.contains("buffer=rgba8") && refused.contains("light-image=fire"));
}

/// A sphere near the caster looks larger than its own radius: `sphere=equator` is the
/// disc of that radius, and not the truth.
#[test]
fn a_sphere_as_its_equator_is_smaller_than_it_looks() {
    let mut scene = builtin::build("parallel-plates").unwrap();
    let LightShape::Rectangle { centre, edge_u, .. } = scene.lights[0].shape else {
        unreachable!()
    };
    let radius = 1.2 * edge_u.length();
    scene.lights[0].shape = LightShape::Sphere { centre, radius };
    let [seen, equator] =
        ["sphere=seen", "sphere=equator"].map(|s| rmse(&scene, &draw(&scene, &[s])));
    assert!(seen < 2e-3 && equator > 5.0 * seen, "{seen} {equator}");
}

/// Wedges of a light of nearly no size are drawn, and change nothing but next to the hard
/// edge: the mask is that of the hard shadow.
#[test]
fn wedges_of_a_tiny_light_leave_the_hard_shadow() {
    let mut scene = builtin::build("cylinder").unwrap();
    let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape else {
        unreachable!()
    };
    (*edge_u, *edge_v) = (*edge_u * 1e-4, *edge_v * 1e-4);
    let soft = draw(&scene, &[]);
    let hard = drawn(&scene, "shadow-volumes", &[], SIZE);
    let wedges: u64 = soft
        .report
        .passes
        .iter()
        .flat_map(|p| &p.draws)
        .filter(|d| d.label == "penumbra")
        .map(|d| d.counters.fragment_shader_invocations)
        .sum();
    assert!(wedges > 20, "{wedges}");
    let (off, all) = apart(&soft, &hard, 0.0);
    println!("{off} of {all}, {wedges} invocations");
    assert!(all > 4000 && off <= 12, "{off} of {all}");
}

/// The resolve of red, green and the stencil, by hand: visibility where positions say that
/// shadow may fall, or may not.
fn resolved(stencil: u8, red_green: [f32; 2], shadowable: f32) -> f32 {
    let mut gpu = gpu();
    let image = Subresource::default();
    let [both, positions] = [Format::Rgba8Unorm, Format::Rgba32Float].map(|f| texture(&mut gpu, f));
    let [depth_stencil, out] =
        [Format::Depth24Stencil8, Format::R32Float].map(|f| texture(&mut gpu, f));
    let [red, green] = red_green.map(|c| c / 255.0);
    let mut fill = |to, texel: [f32; 4]| {
        let target = gpu.texture_mut(to).unwrap();
        target.write_color(image, &[texel; COUNT]).unwrap();
    };
    fill(both, [red, green, 0.0, 0.0]);
    fill(positions, [0.0, 0.0, 0.0, shadowable]);
    let target = gpu.texture_mut(depth_stencil).unwrap();
    let (depths, counts) = (vec![1.0; COUNT], vec![stencil; COUNT]);
    target.write_depth_stencil(image, &depths, &counts).unwrap();
    let sources = [both, positions, depth_stencil];
    let draw = full_screen(ResolveRedGreen.stage(), ColorTargetState::OPAQUE, &sources);
    submit(&mut gpu, out, LoadOp::DontCare, vec![draw]);
    red_of(&gpu, out)[0]
}

/// Quads that meet may round to one leaving more than entered: 255 in the stencil is -1,
/// and not 255 layers.
#[test]
fn counts_below_zero_make_up_for_coverage_that_is_taken() {
    assert_eq!(resolved(0, [0.0, 63.0], 1.0), 0.0);
    assert_eq!(resolved(255, [0.0, 63.0], 1.0), 1.0);
    assert_eq!(resolved(3, [126.0, 0.0], 1.0), 0.0);
    assert_eq!(resolved(127, [0.0, 0.0], 1.0), -126.0);
    assert_eq!(resolved(128, [0.0, 0.0], 1.0), 129.0);
}

#[test]
fn what_takes_no_shadow_is_lit_whatever_was_counted() {
    assert_eq!(resolved(1, [0.0, 0.0], 1.0), 0.0);
    assert_eq!(resolved(1, [0.0, 0.0], 0.0), 1.0);
    assert_eq!(resolved(7, [0.0, 63.0], 0.0), 1.0);
}

/// The eye is in a plate, and the near plane cuts away the lit face above it, by which all
/// rays leave: what is beyond is lit, whatever counts.
#[test]
fn lit_faces_that_the_near_plane_cuts_away_are_left_in_the_stencil_too() {
    let solid = |name: &str, shape: shape::Shape| {
        let mesh = shape.into_mesh(Shading::Flat).unwrap();
        Object::new(name, mesh, Material::matt([0.7; 3]))
    };
    let plate = shape::cuboid(DVec3::new(0.0, 0.6, 0.0), DVec3::new(3.0, 0.1, 3.0));
    let wall = shape::cuboid(DVec3::new(0.0, 2.0, -4.0), DVec3::new(8.0, 6.0, 0.2));
    let light = Light {
        shape: LightShape::Sphere {
            centre: DVec3::new(0.5, 6.0, 1.0),
            radius: 0.4,
        },
        colour: [1.0; 3],
    };
    let mut camera = Camera::look_at([0.0, 0.6, 0.0], [0.0, 2.2, -4.0]);
    camera.near = 0.5;
    let objects = vec![solid("plate", plate), solid("wall", wall).receiver_only()];
    let scene = Scene::new(camera, vec![light], objects);
    for buffer in ["buffer=r32f", "buffer=rgba8x2", "buffer=rgba8"] {
        let done = draw(&scene, &[buffer]);
        let lit = done.visibility.iter().filter(|v| **v > 0.9).count();
        assert!(2 * lit > done.visibility.len(), "{buffer}: {lit}");
        let caps = done.report.passes.iter().flat_map(|p| &p.draws);
        let caps = caps.filter(|d| d.label.starts_with("near caps"));
        assert!(caps.count() > 0, "{buffer}");
    }
}
