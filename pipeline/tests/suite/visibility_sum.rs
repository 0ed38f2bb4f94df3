//! The sum of edges at a receiver: against the exact share of the light, against the same
//! sum over triangles, and against what the technique draws.

use glam::DVec3;
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::measure::visibility_sum::{Causes, SumError, VisibilitySum};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::truth::oracle::area::AreaOracle;
use gnomon_pipeline::truth::oracle::surfaces::{Receiver, Surfaces};
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [48, 36];

fn scene(name: &str) -> Scene {
    builtin::build(name).unwrap()
}

/// Receivers under the pixels of a small picture, with their place and facet.
fn receivers(scene: &Scene) -> Vec<(usize, Receiver, [DVec3; 3])> {
    let surfaces = Surfaces::new(scene);
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let pixels = 0..(SIZE[0] * SIZE[1]) as usize;
    let at = |i: usize| {
        let x = (i as u32 % SIZE[0]) as f64 + 0.5;
        let y = (i as u32 / SIZE[0]) as f64 + 0.5;
        let hit = surfaces.hit(&rays, x, y)?;
        let own = surfaces.corners()[surfaces.index_of(&hit) as usize];
        Some((i, surfaces.receiver(&rays, x, y)?, own))
    };
    pixels.filter_map(at).collect()
}

/// One simple loop: the sum is no approximation.
#[test]
fn the_sum_is_the_truth_behind_one_loop() {
    let scene = scene("parallel-plates");
    let sum = VisibilitySum::new(&scene, 0).unwrap();
    let (_, oracle) = AreaOracle::of_scene(&scene, 0).unwrap();
    let mut penumbra = 0;
    for (_, receiver, _) in receivers(&scene) {
        if receiver.caster.is_some() {
            continue;
        }
        let seen = sum.seen_from(receiver.point).unwrap();
        let truth = oracle.visibility(&receiver);
        assert!((seen.sum() - truth).abs() < 1e-9, "{seen:?}, {truth}");
        penumbra += usize::from(truth > 0.01 && truth < 0.99);
    }
    assert!(penumbra > 50, "{penumbra}");
}

/// Edges and triangles are two ways to the same sum, and so is the picture.
#[test]
fn edges_triangles_and_the_picture_agree() {
    for name in ["creature", "spheres", "cylinder"] {
        let scene = scene(name);
        let sum = VisibilitySum::new(&scene, 0).unwrap();
        let causes = Causes::new(&scene, 0).unwrap();
        let technique = find("soft-shadow-volumes").unwrap();
        let settings = RenderSettings {
            size: SIZE,
            ..RenderSettings::default()
        };
        let params = Params::parse(technique, ["horizon=off"]).unwrap();
        let done = render(&scene, technique, &params, &settings).unwrap();
        let (mut compared, mut cut) = (0, 0);
        for (i, receiver, own) in receivers(&scene) {
            // Receivers on casters have their own facet's horizon in one of the sums.
            if receiver.caster.is_some() {
                continue;
            }
            let seen = sum.seen_from(receiver.point).unwrap();
            let by_triangles = causes.summed(&receiver, &own);
            assert!(
                (seen.sum() - by_triangles).abs() < 1e-7,
                "{name} {i}: {} and {by_triangles}",
                seen.sum()
            );
            let drawn = f64::from(done.visibility[i]);
            let clamped = seen.sum() - seen.saturation();
            assert!(
                (clamped - drawn).abs() < 2e-3,
                "{name} {i}: {clamped} and {drawn}"
            );
            let one_by_one = seen.edges.iter().map(|e| e.number);
            let mut numbers: Vec<usize> = one_by_one.collect();
            numbers.dedup();
            let single: f64 = numbers
                .iter()
                .map(|n| sum.contribution(*n, receiver.point))
                .sum();
            let hidden = f64::from(seen.centre_hidden);
            assert!((1.0 - hidden + single - seen.sum()).abs() < 1e-12);
            compared += 1;
            cut += usize::from(!seen.edges.is_empty());
        }
        assert!(compared > 200 && cut > 30, "{name}: {compared}, {cut}");
    }
}

#[test]
fn lights_without_such_a_sum_are_refused_by_name() {
    let mut scene = scene("parallel-plates");
    let refused = VisibilitySum::new(&scene, 3).unwrap_err();
    assert!(matches!(
        refused,
        SumError::NoSuchLight { light: 3, count: 1 }
    ));
    assert_eq!(
        refused.to_string(),
        "light 3: the scene has 1; valid are 0 to 0"
    );
    scene.lights[0].shape = gnomon_pipeline::world::light::LightShape::Point {
        position: DVec3::new(0.0, 4.0, 0.0),
    };
    let refused = VisibilitySum::new(&scene, 0).unwrap_err().to_string();
    assert!(refused.contains("is a point"), "{refused}");
}
