//! Visibility limited to the light before a facet's plane, against the oracle.

use crate::drawing::drawn;
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [120, 80];
const BOTH: [&str; 2] = ["soft-shadow-volumes", "soft-shadow-volumes-optimised"];
const MAPPED: [&str; 3] = ["pcss", "convolution-soft-shadows", "shadow-maps-n"];

fn picture(scene: &Scene, name: &str, set: &[&str]) -> Rendered {
    drawn(scene, name, set, SIZE)
}

fn error_of(scene: &Scene, name: &str, set: &[&str]) -> VisibilityError {
    let done = picture(scene, name, set);
    let truth = Reference::new(scene, 0, SIZE, ReferenceKind::Exact, None, &|| ()).unwrap();
    let under = truth.under(&done.depth).unwrap();
    let pairs = done.visibility.iter().zip(&under.truth.values);
    let seen: Vec<f32> = pairs
        .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
        .collect();
    let error = VisibilityError::measure(&under.truth, SIZE, &seen).unwrap();
    println!("{} {name} {set:?}: {:?}", scene.name, error.all);
    error
}

fn rmse(scene: &Scene, name: &str, set: &[&str]) -> f64 {
    error_of(scene, name, set).all.unwrap().rmse
}

fn umbra_rmse(scene: &Scene, name: &str, set: &[&str]) -> f64 {
    let error = error_of(scene, name, set);
    error.of_region(LightRegion::Umbra).unwrap().rmse
}

#[test]
fn curved_casters_are_several_times_nearer_to_the_truth() {
    let mut scene = builtin::build("peer-a").unwrap();
    for name in BOTH {
        let off = rmse(&scene, name, &["horizon=off"]);
        let on = rmse(&scene, name, &["horizon=on"]);
        assert!(on < off / 5.0, "{name}: {on} of {off}");
    }
    let LightShape::Rectangle { centre, .. } = scene.lights[0].shape else {
        unreachable!()
    };
    let disc = LightShape::Disc {
        centre,
        normal: glam::DVec3::Y,
        radius: 0.6,
    };
    let colour = [1.0; 3];
    scene.lights = vec![Light {
        shape: disc,
        colour,
    }];
    let [off, on] = ["off", "on"].map(|h| rmse(&scene, BOTH[0], &[&format!("horizon={h}")]));
    assert!(on < off / 5.0, "disc: {on} of {off}");
}

/// Of shadow maps: facets turned away from the light, lit for want of bias, are dark.
#[test]
fn facets_turned_away_are_dark_in_shadow_maps() {
    for scene in ["demo", "peer-a", "spheres"].map(|name| builtin::build(name).unwrap()) {
        for name in MAPPED {
            let [off, on] = ["off", "on"].map(|h| {
                let set = format!("horizon={h}");
                umbra_rmse(&scene, name, &[&set])
            });
            assert!(on < off / 2.0, "{} {name}: {on} of {off}", scene.name);
        }
    }
    // A point sees all of a facet or nothing.
    let mut scene = builtin::build("peer-a").unwrap();
    let position = scene.lights[0].hard();
    let gnomon_pipeline::world::light::HardLight::Point(position) = position else {
        unreachable!()
    };
    scene.lights[0].shape = LightShape::Point { position };
    let [off, on] = ["off", "on"].map(|h| {
        let set = format!("horizon={h}");
        umbra_rmse(&scene, "pcss", &[&set])
    });
    assert!(on < off / 2.0, "point: {on} of {off}");
}

/// Nothing gets brighter, and nothing changes on what casts no shadow.
#[test]
fn it_only_limits_and_only_casters() {
    let scenes = ["demo", "creature", "columns", "adversarial-offset"];
    for (k, name) in scenes.into_iter().enumerate() {
        let technique = [BOTH[0], MAPPED[k % MAPPED.len()]][k % 2];
        let scene = builtin::build(name).unwrap();
        let off = picture(&scene, technique, &["horizon=off"]);
        let on = picture(&scene, technique, &["horizon=on"]);
        let pairs = || off.visibility.iter().zip(&on.visibility);
        assert!(pairs().all(|(a, b)| b <= a || a.is_nan()), "{name}");
        assert!(pairs().any(|(a, b)| b < a), "{name}");
        let mut receivers = scene.clone();
        receivers.objects.iter_mut().for_each(|o| o.casts = false);
        let [a, b] =
            ["off", "on"].map(|h| picture(&receivers, technique, &[&format!("horizon={h}")]));
        assert_eq!(a.visibility_hash(), b.visibility_hash(), "{name}");
        let unskipped = picture(&scene, technique, &["horizon=on", "skip=off"]);
        assert_eq!(unskipped.visibility_hash(), on.visibility_hash(), "{name}");
        let [off, on] = ["horizon=off", "horizon=on"].map(|h| rmse(&scene, technique, &[h]));
        assert!(on < off, "{name} {technique}");
    }
}

/// Every technique that could light a facet turned away knows of it, by default, and is
/// nearer to the truth for it; the others draw each facet's own shadow as it is.
#[test]
fn every_technique_knows_the_horizon() {
    const OTHERS: [&str; 8] = [
        "unshadowed",
        "shadow-volumes",
        "sampled-shadow-volumes",
        "mixed-lights",
        "deferred-shadowing",
        "heckbert-herf",
        "ray-traced",
        "line-sampled-shadow-volumes",
    ];
    let scene = builtin::build("peer-a").unwrap();
    for technique in gnomon_pipeline::techniques::all() {
        let name = technique.name();
        let has = technique.params().iter().any(|p| p.name == "horizon");
        assert!(has || OTHERS.contains(&name), "{name}");
        if !has {
            continue;
        }
        let few = technique.params().iter().any(|p| p.name == "map-size");
        let few: &[&str] = if few { &["map-size=256"] } else { &[] };
        let default = Params::defaults(*technique);
        assert_eq!(default.text("horizon"), Some("on"), "{name}");
        let [off, on] =
            ["horizon=off", "horizon=on"].map(|h| rmse(&scene, name, &[few, &[h]].concat()));
        assert!(on <= off, "{name}: {on} of {off}");
    }
}

/// Spheres and lights with an image are left out, which is said.
#[test]
fn lights_that_it_is_not_made_for_are_left_out() {
    let mut scene = builtin::build("cylinder").unwrap();
    let left_out = |scene: &Scene, set: &[&str]| {
        let done = picture(scene, BOTH[0], set);
        let warning = done.warnings.iter().find(|w| w.code == "horizon-left-out");
        warning.map(|w| w.message.clone())
    };
    assert_eq!(left_out(&scene, &["horizon=on"]), None);
    let image = left_out(&scene, &["horizon=on", "light-image=fire"]).unwrap();
    assert!(
        image.contains("light 0") && image.contains("image"),
        "{image}"
    );
    let centre = glam::DVec3::new(1.6, 4.0, 1.0);
    scene.lights[0].shape = LightShape::Sphere {
        centre,
        radius: 0.5,
    };
    let sphere = left_out(&scene, &["horizon=on"]).unwrap();
    assert!(sphere.contains("sphere"), "{sphere}");
    assert_eq!(left_out(&scene, &["horizon=off"]), None);
}
