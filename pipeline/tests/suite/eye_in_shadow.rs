//! An eye in shadow, and everything that is hard, by both techniques on soft shadow volumes
//! against the truth, with thresholds: a hard count that starts from the wrong number is
//! wrong by whole lights, nearly everywhere.

use crate::drawing::drawn;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [120, 80];
const BOTH: [&str; 2] = ["soft-shadow-volumes", "soft-shadow-volumes-optimised"];

fn truth(scene: &Scene) -> VisibilityImage {
    VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap()
}

fn error(scene: &Scene, truth: &VisibilityImage, technique: &str, set: &[&str]) -> ErrorSummary {
    let picture = drawn(scene, technique, set, SIZE);
    let error = VisibilityError::measure(truth, SIZE, &picture.visibility).unwrap();
    let all = error.all.unwrap();
    println!("{} {technique} {set:?}: {all:?}", scene.name);
    all
}

/// The eye's own count, by either way to keep it.
#[test]
fn the_count_starts_from_the_eyes_own() {
    let scene = builtin::build("adversarial-eye-in-shadow").unwrap();
    let truth = truth(&scene);
    let ways: [(&str, &[&str]); 6] = [
        (BOTH[0], &[]),
        (BOTH[0], &["buffer=rgba8x2"]),
        (BOTH[1], &[]),
        (BOTH[1], &["halves=on"]),
        (BOTH[1], &["combine=paper"]),
        (BOTH[1], &["combine=paper", "combine-over=loop"]),
    ];
    for (technique, set) in ways {
        let error = error(&scene, &truth, technique, set);
        assert!(error.rmse < 0.03, "{technique} {set:?}: {error:?}");
    }
}

/// Errors that are the papers' own, of one silhouette and of sums, and no others.
#[test]
fn adversarial_scenes_are_near_the_truth() {
    for (name, limit) in [
        ("adversarial-eye-in-shadow", 0.03),
        ("adversarial-near-plane", 0.05),
        ("adversarial-nested-300", 0.12),
        ("adversarial-tiny", 0.05),
        ("adversarial-huge", 0.05),
        ("adversarial-offset", 0.05),
        ("adversarial-slivers", 0.08),
    ] {
        let scene = builtin::build(name).unwrap();
        let truth = truth(&scene);
        for technique in BOTH {
            let error = error(&scene, &truth, technique, &[]);
            assert!(error.rmse < limit, "{name} {technique}: {error:?}");
        }
    }
}

/// `sphere=equator` is a smaller disc than a near sphere looks, as the papers have it:
/// penumbrae are narrower than they should be.
#[test]
fn a_sphere_as_its_equator_has_narrower_penumbrae() {
    let mut scene = builtin::build("parallel-plates").unwrap();
    let LightShape::Rectangle { centre, .. } = scene.lights[0].shape else {
        unreachable!()
    };
    scene.lights = vec![Light {
        shape: LightShape::Sphere {
            centre,
            radius: 0.9,
        },
        colour: [1.0; 3],
    }];
    let truth = truth(&scene);
    for technique in BOTH {
        let [seen, equator] = ["seen", "equator"]
            .map(|s| error(&scene, &truth, technique, &[&format!("sphere={s}")]));
        assert!(
            equator.rmse > 3.0 * seen.rmse,
            "{technique}: {seen:?} {equator:?}"
        );
        let between = |sphere: &str| {
            let set = [&*format!("sphere={sphere}")];
            let picture = drawn(&scene, technique, &set, SIZE);
            let inner = picture.visibility.iter();
            inner.filter(|v| (0.01..0.99).contains(*v)).count()
        };
        assert!(between("equator") < between("seen"), "{technique}");
    }
}

/// Six bits are rounded to the nearest, not down: darker and lighter halves of penumbrae
/// stay where they are.
#[test]
fn six_bits_are_the_nearest() {
    let scene = builtin::build("parallel-plates").unwrap();
    let exact = drawn(&scene, BOTH[0], &[], SIZE);
    let bytes = drawn(&scene, BOTH[0], &["buffer=rgba8x2"], SIZE);
    for [low, high] in [[0.02, 0.5], [0.5, 0.98]] {
        let pairs = exact.visibility.iter().zip(&bytes.visibility);
        let of_half = pairs.filter(|(v, _)| (low..high).contains(*v));
        let off: Vec<f32> = of_half.map(|(v, b)| b - v).collect();
        let mean = off.iter().sum::<f32>() / off.len() as f32;
        println!("{low} to {high}: {mean} over {}", off.len());
        assert!(off.len() > 100 && mean.abs() < 0.15 / 63.0, "{mean}");
    }
}
