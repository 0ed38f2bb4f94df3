//! Look-ups that are left out in tiles of the screen to which a light adds nothing:
//! the same bits, less work.

use crate::drawing;
use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::world::environment::FitSettings;
use gnomon_pipeline::world::light::{HardLight, Light, LightShape};
use gnomon_pipeline::world::scene::environment::EnvironmentRequest;
use gnomon_pipeline::world::scene::{Scene, SceneSource, builtin};

const TECHNIQUES: [(&str, &[&str]); 5] = [
    ("shadow-map", &[]),
    ("pcf", &["taps=3"]),
    ("pcss", &["search-samples=4", "samples=4"]),
    ("shadow-maps-n", &["maps=4"]),
    ("convolution-soft-shadows", &[]),
];

fn drawn(scene: &Scene, technique: &str, set: &[&str]) -> Rendered {
    let set = [set, &["map-size=64"]].concat();
    drawing::drawn(scene, technique, &set, [100, 72])
}

/// Fragments shaded by passes of light `light` that look shadows up.
fn looked_up(picture: &Rendered, light: usize) -> u64 {
    let label = format!("look-up {light}");
    let passes = picture.report.passes.iter();
    let own = passes.filter(|p| p.label == label);
    own.map(|p| p.totals().fragment_shader_invocations).sum()
}

fn skipped(picture: &Rendered, light: usize) -> Option<f64> {
    let name = format!("skipped-tiles {light}");
    let found = picture.figures.iter().find(|f| f.name == name);
    found.map(|f| f.value)
}

/// Light 0 from above; 1 is black; 2 is below the floor; 3 just above the floor and far
/// away, so that only one side of what stands there faces it; 4 from above.
fn lights() -> Vec<Light> {
    let square = |at: DVec3| Light::horizontal_square(at, 0.6);
    let black = Light {
        colour: [0.0; 3],
        ..square(DVec3::new(0.5, 4.0, 1.0))
    };
    let point = |position| Light {
        shape: LightShape::Point { position },
        colour: [0.5; 3],
    };
    vec![
        square(DVec3::new(1.0, 4.0, 1.5)),
        black,
        point(DVec3::new(0.0, -5.0, 0.0)),
        point(DVec3::new(-30.0, -1.0, -30.0)),
        square(DVec3::new(-1.0, 4.0, 0.5)),
    ]
}

#[test]
fn tiles_that_a_light_cannot_light_are_left_out() {
    for name in ["cylinder", "creature"] {
        let mut scene = builtin::build(name).unwrap();
        scene.lights = lights();
        for (technique, set) in TECHNIQUES {
            let of = |skip: &str| drawn(&scene, technique, &[set, &[skip]].concat());
            let (lazy, all) = (of("skip=on"), of("skip=off"));
            assert_eq!(lazy.color_hash(), all.color_hash(), "{name} {technique}");
            assert_eq!(
                lazy.visibility_hash(),
                all.visibility_hash(),
                "{name} {technique}"
            );
            let work = |p: &Rendered| [0, 1, 2, 3, 4].map(|l| looked_up(p, l));
            let (some, whole) = (work(&lazy), work(&all));
            println!("{name} {technique}: {some:?} of {whole:?}");
            // The first light's visibility is an output; the last one lights all but
            // the sky.
            assert_eq!(some[0], whole[0]);
            assert!(2 * some[4] > whole[4]);
            assert_eq!((some[1], some[1] < whole[1]), (0, true));
            assert!(some[3] < whole[3], "{name} {technique}");
            let tiles = 7.0 * 5.0;
            assert_eq!((skipped(&lazy, 0), skipped(&all, 1)), (None, None));
            assert_eq!(skipped(&lazy, 1), Some(tiles));
            let part = skipped(&lazy, 3).unwrap();
            assert!(part > 0.0 && part < tiles, "{name}: {part}");
        }
    }
}

/// Tens of lights from all sides, and every adversarial scene with several lights.
#[test]
fn skipping_is_invisible_in_hard_scenes() {
    let mut request = EnvironmentRequest::new("sky");
    request.settings.side = 32;
    request.fit = FitSettings {
        lights: 10,
        ..FitSettings::default()
    };
    let source = SceneSource::open("creature").unwrap();
    let mut scenes = vec![source.with_environment(Some(request)).at(0.0).unwrap()];
    for entry in builtin::SCENES {
        if entry.name.starts_with("adversarial") {
            let mut scene = entry.build();
            let (first, target) = (scene.lights[0].clone(), scene.camera.target);
            let centre = place(&first);
            // Mirrored about what is looked at: from the other sides.
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let from = centre - target;
                let position = target + from - axis * (2.0 * axis.dot(from));
                scene.lights.push(Light {
                    shape: LightShape::Point { position },
                    colour: [0.7; 3],
                });
            }
            scenes.push(scene);
        }
    }
    let mut left_out = 0.0;
    for scene in &scenes {
        for (technique, set) in [TECHNIQUES[0], TECHNIQUES[4]] {
            let of = |skip: &str| drawn(scene, technique, &[set, &[skip]].concat());
            let (lazy, all) = (of("skip=on"), of("skip=off"));
            assert!(lazy.color_hash() == all.color_hash(), "{}", scene.name);
            assert!(
                lazy.visibility_hash() == all.visibility_hash(),
                "{}",
                scene.name
            );
            let lights = 0..scene.lights.len();
            left_out += lights.filter_map(|l| skipped(&lazy, l)).sum::<f64>();
        }
    }
    println!("{left_out} tiles left out in {} scenes", scenes.len());
    assert!(left_out > 100.0);
}

fn place(light: &Light) -> DVec3 {
    match light.hard() {
        HardLight::Point(p) => p,
        HardLight::Directional(towards) => towards * 10.0,
    }
}
