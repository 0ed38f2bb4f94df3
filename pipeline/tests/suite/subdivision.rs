//! Silhouette edges in m collinear pieces: nothing changes but what each piece is
//! rounded to. How far each back end drifts is plotted by the example `subdivision`.

use crate::drawing::drawn;
use std::sync::Arc;

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_pipeline::world::shape::bevelled_plate_in_pieces;

/// The parallel plates with each edge of the plate in `pieces`.
fn plates(pieces: u32) -> Scene {
    let mut scene = builtin::build("parallel-plates").unwrap();
    let plate = bevelled_plate_in_pieces(0.3, 1.0, 0.01, 1.6, pieces);
    scene.objects[1].mesh = Arc::new(plate.into_mesh(Shading::Flat).unwrap());
    scene
}

fn picture(pieces: u32, technique: &str, set: &[&str]) -> Rendered {
    drawn(&plates(pieces), technique, set, [120, 80])
}

/// The largest change of visibility from whole edges to `pieces`.
fn drift(pieces: u32, technique: &str, set: &[&str]) -> f64 {
    let [whole, cut] = [1, pieces].map(|m| picture(m, technique, set));
    let pairs = whole.visibility.iter().zip(&cut.visibility);
    let pairs = pairs.filter(|(v, _)| !v.is_nan());
    let largest = pairs.fold(0.0, |d: f64, (a, b)| d.max(f64::from((a - b).abs())));
    println!("{technique} {set:?}, {pieces} pieces: {largest:.2e}");
    largest
}

#[test]
fn pieces_drift_by_what_each_is_rounded_to() {
    let (paper3, paper4) = ("soft-shadow-volumes", "soft-shadow-volumes-optimised");
    for m in [4, 16, 32] {
        // Four edges, whole and in pieces, each rounded to half a step.
        let rounded = |steps: f64| 4.0 * (f64::from(m) + 1.0) * 0.5 / steps;
        let exact = drift(m, paper3, &[]);
        let twelve = drift(m, paper4, &[]);
        let ten = drift(m, paper4, &["split-bits=lut"]);
        let six = drift(m, paper3, &["buffer=rgba8x2"]);
        assert!(exact < 1e-5, "{m}: {exact}");
        assert!(
            twelve > exact && twelve < rounded(4095.0) + 1e-5,
            "{m}: {twelve}"
        );
        assert!(ten < rounded(1023.0) + rounded(4095.0), "{m}: {ten}");
        assert!(six > 4.0 * ten && six < rounded(63.0), "{m}: {six}");
    }
    assert!(drift(64, paper3, &[]) < 1e-5);
    // More pieces at a pixel than 8 bits hold for certain, which is said.
    let saturated = |m: u32| {
        let warnings = picture(m, paper4, &[]).warnings;
        warnings.iter().any(|w| w.code == "coverage-saturated")
    };
    assert!(saturated(64) && !saturated(32));
    // 64 pieces are each less than half of 1/63: the penumbra is all but lost.
    assert!(
        drift(64, paper3, &["buffer=rgba8x2"]) > 0.2,
        "negative control"
    );
}
