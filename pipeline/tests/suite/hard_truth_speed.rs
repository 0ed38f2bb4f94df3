//! Times the f64 truth on the large scenes: `cargo test --release -p
//! gnomon-pipeline --test hard_truth_speed -- --ignored --nocapture`.

use std::time::Instant;

use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth};
use gnomon_pipeline::world::scene::builtin;

#[test]
#[ignore = "a measurement, not a check; run in release"]
fn time_the_truth_of_large_scenes() {
    for name in [
        "peer-a",
        "peer-b",
        "peer-c",
        "fractal",
        "adversarial",
        "demo",
    ] {
        let scene = builtin::build(name).unwrap();
        let start = Instant::now();
        let truth = HardTruth::of_scene(&scene, 0, [512; 2], EdgeTolerance::HALF_PIXEL_AND_DEPTH);
        let seconds = start.elapsed().as_secs_f64();
        let interior = truth.pixels.iter().filter(|p| p.interior).count();
        let triangles = scene.triangle_count();
        eprintln!("{name}: {triangles} triangles, {seconds:.2} s, {interior} interior pixels");
    }
}
