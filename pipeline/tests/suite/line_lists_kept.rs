//! Lists of edges that stay from frame to frame: the picture is that of the frame by itself,
//! to the bit, and lists are made of what moved alone.

use gnomon_pipeline::measure::render::{RenderSettings, Rendered, render, render_next};
use gnomon_pipeline::technique::{KeptPictures, Params};
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::scene::Scene;

use crate::deferred_shadowing::{MOVING, at, figure};

/// The moving scene under two lights.
fn moving(time: f64) -> Scene {
    let lights = "[[lights]]\nshape.square = { centre = [1.5, 4.0, 1.0], side = 1.0 }\n\
                  [[lights]]\nshape.sphere = { centre = [-1.0, 4.0, 2.0], radius = 0.3 }\n";
    let lit = MOVING
        .replace(
            "[environment]\nmap = \"sky\"\nside = 16\nlights = 6\n",
            lights,
        )
        .replace(
            "MOTION",
            "motion.spin = [20.0, 70.0, 0.0]\ntranslate = [0.6, 0.9, 0.2]",
        );
    at(&lit, time)
}

/// The next frame, which must be the frame by itself in all but the tests that it needed;
/// theirs, and those of the frame by itself.
fn next(scene: &Scene, set: &[&str], kept: &mut KeptPictures) -> (Rendered, [f64; 2]) {
    let technique = find("line-sampled-shadow-volumes").unwrap();
    let params = Params::parse(technique, set.iter().copied()).unwrap();
    let settings = RenderSettings {
        size: [160, 120],
        ..RenderSettings::default()
    };
    let done = render_next(scene, technique, &params, &settings, kept).unwrap();
    let alone = render(scene, technique, &params, &settings).unwrap();
    assert_eq!(done.color_hash(), alone.color_hash());
    assert_eq!(done.visibility_hash(), alone.visibility_hash());
    for (own, other) in done.report.passes.iter().zip(&alone.report.passes) {
        assert_eq!(own.totals(), other.totals(), "{}", own.label);
    }
    let tests = |done: &Rendered| {
        let tests = [0, 1].map(|n| figure(done, &format!("list-tests {n}")));
        tests[0] + tests[1]
    };
    for (own, other) in done.figures.iter().zip(&alone.figures) {
        assert!(
            own == other || own.name.contains("list-tests"),
            "{own:?} {other:?}"
        );
    }
    let found = [tests(&done), tests(&alone)];
    (done, found)
}

#[test]
fn only_lists_of_what_moved_are_made_again() {
    let mut kept = KeptPictures::default();
    let (_, [tests, all]) = next(&moving(0.0), &[], &mut kept);
    assert!(tests == all && all > 1000.0, "{tests} {all}");
    let (_, [tests, _]) = next(&moving(0.0), &[], &mut kept);
    assert_eq!(tests, 0.0);
    // The knot turns: lists of the block stay where no other receivers are seen.
    let (_, [tests, all]) = next(&moving(0.25), &[], &mut kept);
    assert!(0.0 < tests && tests < all, "{tests} {all}");
    let (_, [tests, _]) = next(&moving(0.25), &["skip=off"], &mut kept);
    assert_eq!(tests, 0.0);
    // One light moves, the other's lists stay.
    let mut lit = moving(0.25);
    let LightShape::Sphere { centre, .. } = &mut lit.lights[1].shape else {
        panic!("the second is a sphere");
    };
    centre.x += 0.1;
    let (_, [tests, all]) = next(&lit, &[], &mut kept);
    assert!(0.0 < tests && tests < 0.8 * all, "{tests} {all}");
    // Another eye sees other receivers.
    lit.camera.eye.x += 0.1;
    let (_, [tests, all]) = next(&lit, &[], &mut kept);
    assert_eq!(tests, all);
}
