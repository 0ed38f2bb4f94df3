//! What the tests of techniques on light views share.
#![allow(dead_code, reason = "each test file uses a part")]

use crate::drawing::as_published;
use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
use gnomon_pipeline::world::light::{HardLight, Light};
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::plates::ParallelPlates;
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape;

pub(crate) const SIZE: [u32; 2] = [120, 80];

pub(crate) fn scene(name: &str) -> Scene {
    builtin::build(name).unwrap()
}

pub(crate) fn sized(
    name: &str,
    scene: &Scene,
    set: &[&str],
    size: [u32; 2],
) -> Result<Rendered, String> {
    let technique = find(name).unwrap();
    let set = as_published(technique)
        .into_iter()
        .chain(set.iter().copied());
    let params = Params::parse(technique, set).map_err(|e| e.to_string())?;
    let settings = RenderSettings {
        size,
        ..RenderSettings::default()
    };
    render(scene, technique, &params, &settings).map_err(|e| e.to_string())
}

pub(crate) fn by(name: &str, scene: &Scene, set: &[&str]) -> Rendered {
    sized(name, scene, set, SIZE).unwrap()
}

pub(crate) fn truth(scene: &Scene) -> VisibilityImage {
    VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap()
}

pub(crate) fn figure(picture: &Rendered, name: &str) -> f64 {
    let found = picture.figures.iter().find(|f| f.name == name);
    found.unwrap_or_else(|| panic!("no figure {name}")).value
}

/// A picture of [`plates`], and its errors on the floor against the closed form.
fn plate_errors(name: &str, d: f64, set: &[&str]) -> (Rendered, ErrorSummary) {
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
    let summary = ErrorSummary::of(&errors).unwrap();
    println!("{name} {set:?} d={d}: {summary:?}");
    (picture, summary)
}

/// Errors on the floor of [`plates`] against the closed form.
pub(crate) fn sampled_plate_error(name: &str, d: f64, set: &[&str]) -> ErrorSummary {
    plate_errors(name, d, set).1
}

/// The same of a technique on light views, and half the width of the kernel that the
/// closed form asks for, in texels.
pub(crate) fn plate_error(name: &str, d: f64, set: &[&str]) -> (ErrorSummary, f64) {
    let (picture, summary) = plate_errors(name, d, set);
    let (_, plates) = plates(d);
    let texel = figure(&picture, "texel") / figure(&picture, "far");
    let kernel = plates.light_half * (1.0 / plates.plate_distance - 1.0 / d) / texel;
    println!("kernel {kernel:.1} texels");
    (summary, kernel)
}

/// A technique's error on a scene, everywhere.
pub(crate) fn error(
    technique: &str,
    scene: &Scene,
    truth: &VisibilityImage,
    set: &[&str],
) -> ErrorSummary {
    let picture = by(technique, scene, set);
    let error = VisibilityError::measure(truth, SIZE, &picture.visibility).unwrap();
    println!("{} {technique} {set:?}: {:?}", scene.name, error.all);
    assert_eq!(error.mask.out_of_range, 0, "{technique} {set:?}");
    error.all.unwrap()
}

/// A light below which all of a scene is: a horizontal square's centre.
pub(crate) fn centre_of(scene: &Scene) -> DVec3 {
    let HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("a point");
    };
    centre
}

/// Plate and floor under a square light, as docs/papers.md, scenes has them, the floor at
/// distance `d` from the light.
pub(crate) fn plates(d: f64) -> (Scene, ParallelPlates) {
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

/// T: variance over seeds, in penumbrae of `parallel-plates`; `count` is the parameter of
/// how many samples there are, `set` the other settings. One point sees the light or not:
/// V(1 - V). N jittered ones, each in its cell, have less, falling as N^-3/2, for only
/// the cells that an edge crosses vary: √N of N.
pub(crate) fn variance_falls_as_predicted(name: &str, count: &str, set: &[&str]) {
    const SEEDS: u32 = 24;
    let size = [40, 28];
    let scene = scene("parallel-plates");
    let truth = VisibilityImage::of_scene(&scene, 0, size, &|| ()).unwrap();
    let variance = |samples: u32| {
        let picture = |seed: u32| {
            let more = [format!("{count}={samples}"), format!("seed={seed}")];
            let all = set.iter().copied().chain(more.iter().map(String::as_str));
            let all: Vec<&str> = all.collect();
            sized(name, &scene, &all, size).unwrap().visibility
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
        println!(
            "{samples} {count}: variance {:.4} of V(1-V)",
            found / binomial
        );
        found / binomial
    };
    let [one, four, sixteen] = [1, 4, 16].map(variance);
    assert!((one - 1.0).abs() < 0.15, "{one}");
    assert!(four < 0.3 && sixteen < 0.08, "{four} {sixteen}");
    let fall = four / sixteen;
    assert!((5.5..11.5).contains(&fall), "8 is predicted: {fall}");
}
