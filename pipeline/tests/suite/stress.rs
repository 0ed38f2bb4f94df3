//! What each technique bears, held to what the record says (`gnomon stress`): the walk along
//! every axis, on small pictures.

use gnomon_pipeline::measure::stress::{Axis, Candidate, Curve, Outcome, Point, Stress, Verdict};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::GpuConfig;

const SIZE: [u32; 2] = [48, 32];

fn candidates(names: &[&str]) -> Vec<Candidate> {
    let candidate = |name: &&str| {
        let mut parts = name.split(':');
        let technique = techniques::find(parts.next().unwrap()).unwrap();
        let settings: Vec<String> = parts.map(str::to_owned).collect();
        Candidate::new(technique, &settings).unwrap()
    };
    names.iter().map(candidate).collect()
}

fn curve(scene: &str, axis: &Axis, candidates: &[Candidate]) -> Curve {
    let scene = builtin::build(scene).unwrap();
    let stress = Stress {
        scene: &scene,
        light: 0,
        size: SIZE,
        gpu: GpuConfig::default(),
    };
    stress.curve(axis, candidates, &mut |_, _| ())
}

/// Soft shadows by volumes are exact on plates, and stay so.
const EXACT: [&str; 3] = [
    "soft-shadow-volumes",
    "soft-shadow-volumes-optimised",
    "shadow-volumes",
];

/// The least range over which the error must stay what it is at rest.
fn holds(axis: &str, range: [f64; 2]) {
    let found = Axis::find(axis).unwrap();
    let curve = curve("parallel-plates", &found, &candidates(&EXACT));
    for (k, name) in EXACT.iter().enumerate() {
        let verdict = Verdict::new(&curve, k);
        println!("{axis}, {name}: {verdict}");
        let [least, most] = verdict.holds;
        let is_wide = least <= range[0] * 1.001 && most * 1.001 >= range[1];
        assert!(is_wide, "{axis}, {name}: {verdict}");
        assert_eq!(verdict.insane, 0, "{axis}, {name}");
    }
}

#[test]
fn units_from_tiny_to_huge() {
    holds("scale", [1e-15, 1e11]);
}

#[test]
fn far_from_the_origin() {
    holds("offset", [0.1, 1e4]);
}

#[test]
fn slivers_down_to_no_area() {
    holds("slivers", [2.0, 1e8]);
}

#[test]
fn edges_in_pieces() {
    holds("pieces", [1.0, 8.0]);
}

#[test]
fn near_planes_close_to_the_eye() {
    holds("near", [1.0, 100.0]);
    holds("near-d32f", [1.0, 1e4]);
}

/// Every technique of the registry at the ends of every axis: nothing that is no visibility.
#[test]
fn nothing_is_insane_anywhere() {
    let all: Vec<Candidate> = techniques::all()
        .iter()
        .map(|t| Candidate::new(*t, &[]).unwrap())
        .collect();
    for mut axis in Axis::all() {
        let ends = [axis.values[0], *axis.values.last().unwrap()];
        axis.keep(|v| ends.contains(&v));
        let curve = curve("parallel-plates", &axis, &all);
        for point in curve.points.iter() {
            for (outcome, name) in point.outcomes.iter().flatten().zip(&curve.candidates) {
                if let Outcome::Measured(m) = outcome {
                    assert_eq!(m.insane, 0, "{name}, {} {:e}", axis.name, point.value);
                }
            }
        }
    }
}

/// Were depth formats not what is drawn with, or near planes not moved, both curves would be
/// the same, and flat.
#[test]
fn near_planes_and_depth_formats_are_what_is_drawn_with() {
    let hard = candidates(&["shadow-volumes"]);
    let errors = ["near", "near-d32f"].map(|name| {
        let curve = curve("cylinder", &Axis::find(name).unwrap(), &hard);
        let rmse = |p: &Point| match &p.outcomes.as_ref().unwrap()[0] {
            Outcome::Measured(m) => m.rmse.to_bits(),
            other => panic!("{other:?}"),
        };
        curve.points.iter().map(rmse).collect::<Vec<_>>()
    });
    let flat = |e: &Vec<u64>| e.iter().all(|v| *v == e[0]);
    assert!(!errors.iter().any(flat), "{errors:?}");
    assert_ne!(errors[0], errors[1]);
}
