//! Smoothies (Chan and Durand 2003): order, umbrae, widths, roughness of edges and cost.

use crate::drawing::as_published;
use std::sync::Arc;

use crate::map_support::{figure, plates, sized};
use glam::{DMat4, DVec3};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{Params, PassRole, VisibilityOutput};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::roughness::roughness;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape::{self, Shape};
use gnomon_raster::state::ColorTargetState;
use gnomon_raster::{Counters, Gpu, GpuConfig, Recording, Subresource, VertexBuffer};

const SIZE: [u32; 2] = [96, 64];

fn by(technique: &str, scene: &Scene, set: &[&str]) -> Rendered {
    sized(technique, scene, set, SIZE).unwrap()
}

fn solid(name: &str, shape: Shape) -> Object {
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    Object::new(name, mesh, Material::matt([0.8; 3]))
}

/// The frame with what is attached drawn in order or the other way round, with that
/// blending or without: the visibility that it leaves.
fn in_order(scene: &Scene, set: &[&str], reversed: bool, blended: bool) -> Vec<f32> {
    let technique = find("smoothies").unwrap();
    let set = as_published(technique)
        .into_iter()
        .chain(set.iter().copied());
    let params = Params::parse(technique, set).unwrap();
    let mut frame = technique.frame(scene, SIZE, &params).unwrap();
    let roles = frame.roles.passes().to_vec();
    let passes = frame.recording.list.passes.iter_mut().zip(roles);
    for (pass, _) in passes.filter(|(_, role)| *role == PassRole::Smoothies) {
        if reversed {
            pass.draws.reverse();
        }
        for draw in &mut pass.draws {
            if reversed {
                let old = draw.vertices.as_ref().unwrap();
                let triangles = old.data.chunks(3 * old.stride).rev();
                draw.vertices = Some(Arc::new(VertexBuffer {
                    data: triangles.flatten().copied().collect(),
                    stride: old.stride,
                }));
            }
            if !blended && pass.depth_stencil.is_none() {
                let mut pipeline = (*draw.pipeline).clone();
                pipeline.color_targets = vec![ColorTargetState::OPAQUE];
                draw.pipeline = Arc::new(pipeline);
            }
        }
    }
    visibility(&frame.recording, frame.outputs.visibility)
}

fn visibility(recording: &Recording, output: VisibilityOutput) -> Vec<f32> {
    let VisibilityOutput::Red { texture, .. } = output else {
        panic!("visibility in a texture");
    };
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(recording).unwrap();
    gpu.submit(&recording.list).unwrap();
    let texels = gpu.texture(texture).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    texels.iter().map(|t| t.0[0]).collect()
}

/// T: minimum blending does not care about order.
#[test]
fn smoothies_may_be_drawn_in_any_order() {
    // Of parts that overlap, with concave outlines.
    let scene = builtin::build("creature").unwrap();
    for construction in ["construction=smoothies", "construction=cones"] {
        let set = [construction, "map-size=256"];
        let as_is = in_order(&scene, &set, false, true);
        let other = in_order(&scene, &set, true, true);
        assert!(as_is == other, "{construction}");
        assert!(as_is.iter().any(|v| *v > 0.1 && *v < 0.9));
        // Negative control: the last one drawn wins, and shows.
        let last = in_order(&scene, &set, false, false);
        assert!(
            last != in_order(&scene, &set, true, false),
            "{construction}"
        );
    }
}

fn count(done: &Rendered, of: impl Fn(f32) -> bool) -> usize {
    done.visibility.iter().filter(|v| of(**v)).count()
}

/// T: umbrae are those of the light's centre whatever the width, to the pixel, while those
/// of the truth shrink.
#[test]
fn umbrae_do_not_shrink_as_lights_grow() {
    let (mut scene, _) = plates(3.0);
    let base = ["fit=receivers", "map-size=256"];
    let hard = by("shadow-map", &scene, &base);
    let dark = |done: &Rendered| {
        let all = done.visibility.iter();
        all.map(|v| *v == 0.0).collect::<Vec<_>>()
    };
    let (mut soft, mut umbra) = (0, usize::MAX);
    for side in [0.1, 0.3, 0.55] {
        let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape else {
            panic!("a rectangle");
        };
        *edge_u = edge_u.normalize() * side;
        *edge_v = edge_v.normalize() * side;
        let done = by("smoothies", &scene, &base);
        assert!(dark(&done) == dark(&hard), "{side}");
        let wider = count(&done, |v| v > 0.0 && v < 1.0);
        let truth = VisibilityImage::of_scene(&scene, 0, SIZE, &|| ()).unwrap();
        let regions = truth.values.iter().map(|v| LightRegion::of(*v));
        let smaller = regions.filter(|r| *r == Some(LightRegion::Umbra)).count();
        println!("{side}: {wider} soft, umbra {smaller}");
        // Negative control: the rest of the picture does change.
        assert!(wider > soft && smaller < umbra, "{side}");
        (soft, umbra) = (wider, smaller);
    }
    assert!(count(&hard, |v| v == 0.0) > 100);
}

/// A plate above a floor and, on one side, a step; both are looked at from above.
fn over_a_step() -> Scene {
    let mut plate = solid("plate", shape::bevelled_plate(0.5, 3.0, 0.01, 1.6));
    plate.receives = false;
    let floor = solid("floor", shape::plane(6.0, 0.0)).receiver_only();
    let step = shape::cuboid(DVec3::new(0.0, 0.5, 3.0), DVec3::new(8.0, 1.0, 6.0));
    let step = solid("step", step).receiver_only();
    let light = Light::horizontal_square(DVec3::Y * 6.0, 0.3);
    let camera = Camera {
        fov_y_degrees: 25.0,
        ..Camera::look_at([2.9, 5.5, 0.0], [0.95, 0.5, 0.0])
    };
    Scene::new(camera, vec![light], vec![floor, step, plate])
}

/// Width across x of the penumbra on the level at `y`, near z, of a ramp from 0 to 1.
fn width(done: &Rendered, scene: &Scene, y: f64, z: [f64; 2]) -> f64 {
    let size = done.size;
    let rays = scene.camera.eye_rays(size[0], size[1]);
    let mut samples = Vec::new();
    for (k, seen) in done.visibility.iter().enumerate() {
        let place = [k as u32 % size[0], k as u32 / size[0]].map(|c| f64::from(c) + 0.5);
        let ray = rays.direction(place[0], place[1]);
        let at = rays.origin + ray * ((y - rays.origin.y) / ray.y);
        if (z[0]..z[1]).contains(&at.z) && (0.6..2.0).contains(&at.x) {
            samples.push((at.x, f64::from(*seen)));
        }
    }
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let umbra = samples.iter().rev().find(|s| s.1 == 0.0).unwrap().0;
    // Means over columns: the ramp's integral is half its width.
    let outside: Vec<_> = samples.iter().filter(|s| s.0 > umbra).collect();
    let hidden = outside
        .windows(2)
        .map(|w| (w[1].0 - w[0].0) * (1.0 - w[0].1));
    2.0 * hidden.sum::<f64>()
}

/// T: a smoothie of width t makes penumbrae t (r − b) wide on receivers at r.
#[test]
fn penumbrae_are_as_wide_as_distances_ask_for() {
    let scene = over_a_step();
    let widths = |set: &[&str]| {
        let set = [set, &["width=0.12", "map-size=1024", "filter=2x2"]].concat();
        let done = sized("smoothies", &scene, &set, [240, 160]).unwrap();
        let widths = [
            width(&done, &scene, 0.0, [-0.25, -0.1]),
            width(&done, &scene, 1.0, [0.1, 0.25]),
        ];
        println!("{set:?}: {widths:?}");
        widths
    };
    let [floor, step] = widths(&[]);
    assert!((floor - 0.12 * 3.0).abs() < 0.015, "{floor}");
    assert!((step - 0.12 * 2.0).abs() < 0.015, "{step}");
    assert!((floor / step - 1.5).abs() < 0.1, "{floor} {step}");
    // Negative control: without the remapping widths are in the ratio of the receivers'
    // distances, and not what they should be.
    let [floor, step] = widths(&["alpha=linear"]);
    assert!((floor / step - 6.0 / 5.0).abs() < 0.06, "{floor} {step}");
    assert!(floor > 0.6, "{floor}");
}

/// A plate turned against the map's axes, whose straight edge is looked at from below.
fn turned_plate() -> Scene {
    let turn = DMat4::from_rotation_y(0.37);
    let plate = shape::bevelled_plate(1.0, 2.0, 0.01, 1.6).transformed(turn);
    let mut plate = solid("plate", plate);
    plate.receives = false;
    let floor = solid("floor", shape::plane(8.0, 0.0)).receiver_only();
    let light = Light::horizontal_square(DVec3::Y * 5.0, 0.3);
    let mut camera = Camera::look_at([1.9, -1.4, 0.01], [1.9, 0.0, 0.0]);
    camera.up = DVec3::Z;
    Scene::new(camera, vec![light], vec![floor, plate])
}

/// Roughness of the plate's edge, of which a strip is as wide as a few pixels.
fn edge_roughness(technique: &str, scene: &Scene, set: &[&str]) -> f64 {
    let done = sized(technique, scene, set, [160, 120]).unwrap();
    let rays = scene.camera.eye_rays(160, 120);
    let edge = DVec3::new(libm::cos(0.37), 0.0, -libm::sin(0.37));
    let mut values = Vec::new();
    for (k, seen) in done.visibility.iter().enumerate() {
        let place = [k as u32 % 160, k as u32 / 160].map(|c| f64::from(c) + 0.5);
        let ray = rays.direction(place[0], place[1]);
        let at = rays.origin - ray * (rays.origin.y / ray.y);
        let distance = at.dot(edge) - 5.0 / 3.0;
        let along = at.dot(edge.cross(DVec3::Y));
        if along.abs() < 0.8 && (-0.16..0.48).contains(&distance) {
            values.push([distance, f64::from(*seen)]);
        }
    }
    assert!(values.len() > 1000, "{}", values.len());
    let found = roughness(values, 0.004);
    println!("{technique} {set:?}: roughness {found}");
    found
}

/// T: texels that shadow maps show at 1024² are masked; at 256² they are less so.
#[test]
fn aliasing_is_masked() {
    let scene = turned_plate();
    let of = |technique: &str, size: &str, more: &[&str]| {
        let set = [more, &["fit=receivers", size]].concat();
        edge_roughness(technique, &scene, &set)
    };
    let [fine, coarse] = ["map-size=1024", "map-size=256"];
    let hard = [fine, coarse].map(|size| of("shadow-map", size, &[]));
    let cubic = [fine, coarse].map(|size| of("pcf", size, &["kernel=bicubic"]));
    let soft = [fine, coarse].map(|size| of("smoothies", size, &[]));
    assert!(
        soft[0] < 0.25 * hard[0] && soft[1] < hard[1],
        "{soft:?} {hard:?}"
    );
    assert!(
        soft[0] < 0.6 * cubic[0] || soft[0] < 0.01,
        "{soft:?} {cubic:?}"
    );
    assert!(soft[1] > 1.5 * soft[0], "{soft:?}");
    let filtered = of("smoothies", coarse, &["filter=2x2"]);
    assert!(filtered < 0.7 * soft[1], "{filtered}");
}

fn fetches(done: &Rendered, of_planes: bool) -> u64 {
    let mut all = Counters::default();
    let passes = done.report.passes.iter().enumerate();
    for (_, pass) in passes.filter(|(k, _)| done.roles.of_pass(*k) == PassRole::LookUp) {
        all.add(&pass.totals());
    }
    // Receivers' planes are no look-ups of shadow.
    let planes = if of_planes { 1 } else { 0 };
    let fetches = &all.traffic.tex_fetches;
    fetches[1..].iter().sum::<u64>() - planes * fetches[2]
}

/// T: three look-ups a receiver, or four times as many, where bicubic filtering has 16.
#[test]
fn look_ups_are_fewer_than_those_of_bicubic_filtering() {
    let scene = builtin::build("cylinder").unwrap();
    let receivers = |done: &Rendered| count(done, |v| !v.is_nan()) as u64;
    for (technique, set, expected) in [
        ("smoothies", &[][..], 3),
        ("smoothies", &["filter=2x2"], 12),
        ("pcf", &["kernel=bicubic"], 16),
    ] {
        let done = by(technique, &scene, set);
        let found = fetches(&done, technique == "pcf");
        assert_eq!(found, expected * receivers(&done), "{technique}");
    }
}

fn rmse(scene: &Scene, truth: &VisibilityImage, set: &[&str]) -> f64 {
    let done = by("smoothies", scene, set);
    let error = VisibilityError::measure(truth, SIZE, &done.visibility).unwrap();
    println!("{} {set:?}: {:?}", scene.name, error.all);
    error.all.unwrap().rmse
}

/// Near enough to the truth under small lights, nearer than hard shadows are; and both
/// constructions agree.
#[test]
fn small_lights_have_plausible_shadows() {
    for name in ["two-box", "cylinder"] {
        let mut scene = builtin::build(name).unwrap();
        if let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape {
            (*edge_u, *edge_v) = (*edge_u * 0.5, *edge_v * 0.5);
        }
        let truth = VisibilityImage::of_scene(&scene, 0, SIZE, &|| ()).unwrap();
        let smoothies = rmse(&scene, &truth, &["map-size=512"]);
        let cones = rmse(&scene, &truth, &["map-size=512", "construction=cones"]);
        let linear = rmse(&scene, &truth, &["map-size=512", "alpha=linear"]);
        assert!(smoothies < 0.12 && cones < 0.12, "{name}");
        // Negative control: without the remapping shadows come off their casters.
        assert!(linear > 1.1 * smoothies, "{name}: {linear} {smoothies}");
    }
}

/// Widths follow lights; lights without size have hard shadows, those without place are
/// refused.
#[test]
fn widths_follow_from_lights() {
    let mut scene = builtin::build("two-box").unwrap();
    let width = |scene: &Scene| figure(&by("smoothies", scene, &["map-size=64"]), "smoothie-width");
    let one = width(&scene);
    assert!(one > 0.05 && one < 0.12, "{one}");
    if let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape {
        (*edge_u, *edge_v) = (*edge_u * 2.0, *edge_v * 2.0);
    }
    assert!((width(&scene) - 2.0 * one).abs() < 1e-9);
    // A ball as wide as the square was: between the square's sides and its corners.
    let LightShape::Rectangle { centre, .. } = scene.lights[0].shape else {
        unreachable!("the scene's light is a square");
    };
    scene.lights[0].shape = LightShape::Sphere {
        centre,
        radius: 0.25,
    };
    let ball = width(&scene) / one;
    assert!((0.7..1.35).contains(&ball), "{ball}");
    let position = DVec3::new(1.0, 5.0, 0.8);
    scene.lights[0].shape = LightShape::Point { position };
    assert_eq!(width(&scene), 0.0);
    let set = ["map-size=256", "fit=receivers"];
    let point = by("smoothies", &scene, &set);
    assert_eq!(
        point.visibility_hash(),
        by("shadow-map", &scene, &set).visibility_hash()
    );
    let wide = by("smoothies", &scene, &["map-size=256", "width=0.15"]);
    assert!(count(&wide, |v| v > 0.0 && v < 1.0) > 100);
    scene.lights[0].shape = LightShape::Directional { towards: position };
    let refused = sized("smoothies", &scene, &[], SIZE).unwrap_err();
    assert!(refused.contains("directional"), "{refused}");
}
