//! Every technique of the registry is recorded by name and replays to what it was.

use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::GpuConfig;
use gnomon_traces::{Meta, RecordOptions, ReplayDepth, Trace, record, replay};

const SIZE: [u32; 2] = [56, 40];

/// Settings that keep frames small.
fn small(technique: &dyn Technique) -> Params {
    let wanted = [
        ("map-size", "64"),
        ("samples", "4"),
        ("maps", "4"),
        ("texture-size", "8"),
    ];
    let has = |key: &str| technique.params().iter().any(|p| p.name == key);
    let set = wanted.iter().filter(|(key, _)| has(key));
    Params::parse(technique, set.map(|(key, value)| format!("{key}={value}"))).unwrap()
}

#[test]
fn every_technique_is_recorded_and_replays() {
    let scenes = ["creature", "cylinder", "demo"].map(|name| builtin::build(name).unwrap());
    let table = gnomon_shaders::table();
    let mut recorded = 0;
    for technique in techniques::all() {
        let name = technique.name();
        // Not every technique takes every light.
        let params = small(*technique);
        let mut frames = scenes
            .iter()
            .flat_map(|s| technique.frame(s, SIZE, &params));
        let frame = frames.next();
        let recording = frame
            .unwrap_or_else(|| panic!("{name} takes no scene"))
            .recording;
        let trace = record(Meta::new(name), &recording, RecordOptions::default());
        let trace = trace.unwrap_or_else(|e| panic!("{name}: {e}"));
        let again = Trace::read(trace.to_bytes().to_vec()).unwrap();
        let config = GpuConfig {
            threads: 1,
            tile: 32,
            ..GpuConfig::default()
        };
        let done = replay(&again, 0, &table, config, ReplayDepth::Draws).unwrap();
        assert_eq!(done.difference, None, "{name}");
        let then = again.counters(0).unwrap().skipping;
        for (now, then) in done.report.passes.iter().zip(&then.passes) {
            let counters = |p: &gnomon_raster::PassReport| -> Vec<_> {
                p.draws.iter().map(|d| d.counters).collect()
            };
            assert_eq!(counters(now), counters(then), "{name} {}", now.label);
        }
        recorded += 1;
    }
    assert!(recorded >= 10, "{recorded}");
}
