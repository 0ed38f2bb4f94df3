//! Wedge halves, each culled by depth and stencil and drawn to one buffer: the
//! same bits as whole wedges and as no culling, for half the colour traffic.

use crate::drawing::drawn;
use glam::DVec3;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::Counters;

const SIZE: [u32; 2] = [120, 80];

fn optimised(scene: &Scene, set: &[&str]) -> Rendered {
    drawn(scene, "soft-shadow-volumes-optimised", set, SIZE)
}

fn wedges(picture: &Rendered) -> Counters {
    let mut sum = Counters::default();
    let passes = picture.report.passes.iter();
    let of_wedges = passes.zip(picture.roles.passes());
    let of_wedges = of_wedges.filter(|(_, role)| **role == PassRole::Wedges);
    of_wedges.for_each(|(p, _)| sum.add(&p.totals()));
    sum
}

fn lit_by(name: &str, shape: LightShape) -> Scene {
    let mut scene = builtin::build(name).unwrap();
    let colour = scene.lights[0].colour;
    scene.lights = vec![Light { shape, colour }];
    scene
}

#[test]
fn halves_change_no_bit() {
    let centre = DVec3::new(1.6, 4.0, 1.0);
    let radius = 0.6;
    let normal = DVec3::new(0.3, -1.0, 0.2).normalize();
    let mut scenes = vec![
        lit_by("cylinder", LightShape::Sphere { centre, radius }),
        lit_by(
            "cylinder",
            LightShape::Disc {
                centre,
                normal,
                radius,
            },
        ),
    ];
    let named = [
        "cylinder",
        "overlap",
        "columns",
        "creature",
        "single-silhouette",
        "parallel-plates",
        "adversarial-eye-in-shadow",
        "adversarial-near-plane",
        "adversarial-offset",
        "adversarial-tiny",
    ];
    scenes.extend(named.map(|name| builtin::build(name).unwrap()));
    for scene in &scenes {
        let reference = optimised(scene, &["skip=off"]);
        let sets = [
            &["halves=off"][..],
            &["halves=off", "skip=off"],
            &["halves=off", "wedge=exact"],
            &["halves=on"],
            &["halves=on", "wedge=exact"],
            &["halves=on", "wedge=paper3"],
        ];
        for set in sets {
            let other = optimised(scene, set);
            let pairs = reference.visibility.iter().zip(&other.visibility);
            let differ = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            assert_eq!(differ, 0, "{} {set:?}", scene.name);
            assert_eq!(other.color_hash(), reference.color_hash());
        }
    }
}

#[test]
fn halves_save_colour_traffic_and_shade_little_more() {
    let scene = builtin::build("cylinder").unwrap();
    let of = |set: &[&str]| {
        let picture = optimised(&scene, set);
        let counters = wedges(&picture);
        let colour: u64 = counters.traffic.color.iter().map(|t| t.bytes()).sum();
        let stencil = counters.traffic.stencil.bytes();
        let work = WedgeWork::of(&picture.report, &picture.roles).unwrap();
        println!("{set:?}: colour {colour} B, stencil {stencil} B, {work:?}");
        (colour, work)
    };
    let (whole, whole_work) = of(&["halves=off"]);
    let (halves, halves_work) = of(&["halves=on"]);
    let (unculled, _) = of(&["halves=on", "skip=off"]);
    assert_eq!(halves_work.covering, whole_work.covering);
    // Two buffers of four bytes against one, and a few pixels in both halves.
    assert!(halves < whole * 6 / 10, "{halves} of {whole}");
    assert!(halves_work.shaded < whole_work.shaded * 11 / 10);
    assert!(halves < unculled / 4, "culling is what keeps halves apart");
}

/// An edge that touches the light has no halves, which is said.
#[test]
fn wedges_that_nothing_splits_are_counted() {
    let scene = lit_by(
        "cylinder",
        // Through the top of the cylinder, so that edges are in the light.
        LightShape::Sphere {
            centre: DVec3::new(0.3, 1.9, 0.2),
            radius: 0.6,
        },
    );
    let reference = optimised(&scene, &["skip=off", "halves=off"]);
    // Skipping is invisible where the light meets geometry, too.
    for set in [
        &["halves=on"][..],
        &["halves=off"],
        &["halves=on", "skip=off"],
    ] {
        let other = optimised(&scene, set);
        assert_eq!(other.visibility_hash(), reference.visibility_hash());
    }
    let picture = optimised(&scene, &["halves=on"]);
    let codes: Vec<_> = picture.warnings.iter().map(|w| w.code).collect();
    assert!(codes.contains(&"wedges-unsplit"), "{codes:?}");
    assert!(
        reference
            .warnings
            .iter()
            .all(|w| w.code != "wedges-unsplit")
    );
}
