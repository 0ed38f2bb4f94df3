//! What a file tells is judged as what a live run tells, to the byte, under every profile;
//! and adds up, passes merged and not.

use std::fs;

use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::scene::builtin;
use gnomon_raster::{
    AccessBatch, AccessObserver, Gpu, GpuConfig, PassReport, Recording, SimdLevel, Wants,
};
use gnomon_shaders::table;
use gnomon_tests::sources::root;
use gnomon_traces::profile::{Judge, JudgeOptions, Levels, PROFILES, Traffic, profile};
use gnomon_traces::{FrameShape, Meta, RecordOptions, Trace, Witness, record};

/// Every way to judge a frame: all profiles, passes merged and not. Hardware that cannot
/// draw the frame is left out.
fn judges(shape: &FrameShape) -> Judges {
    let mut all = Vec::new();
    for (name, _) in PROFILES {
        for merged in [false, true] {
            let options = JudgeOptions {
                pixels: true,
                merged,
            };
            let judge = Judge::with_options(&profile(name).unwrap(), shape, options);
            all.extend(judge.ok());
        }
    }
    Judges(all)
}

/// Each of them hears everything.
struct Judges(Vec<Judge>);

impl AccessObserver for Judges {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        self.0.iter_mut().for_each(|j| j.batch(pass, batch));
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        self.0.iter_mut().for_each(|j| j.end(pass, report));
    }
}

impl Judges {
    fn finish(self) -> Vec<Traffic> {
        self.0.into_iter().map(Judge::finish).collect()
    }
}

/// Of the file's shape and accesses alone: no shader is at hand.
fn told(trace: &Trace, frame: usize) -> Vec<Traffic> {
    let mut judges = judges(&trace.shape(frame).unwrap());
    trace.events(frame, &mut judges).unwrap();
    judges.finish()
}

fn live(recording: &Recording, config: GpuConfig) -> Vec<Traffic> {
    let mut judges = judges(&FrameShape::of(recording));
    let mut gpu = Gpu::new(config).unwrap();
    gpu.load(recording).unwrap();
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        witness: Some(&Witness),
        ..Wants::default()
    };
    gpu.submit_observed(&recording.list, wants, &mut judges)
        .unwrap();
    judges.finish()
}

/// Other threads, tiles and levels than those that recorded.
fn configs() -> [GpuConfig; 2] {
    let levels = SimdLevel::available();
    [(1, 16, levels[0]), (8, 128, levels[levels.len() - 1])].map(|(threads, tile, simd)| {
        GpuConfig {
            threads,
            tile,
            simd,
            skip: false,
        }
    })
}

fn goldens() -> Vec<(String, Trace)> {
    let folder = root().join("traces/tests/golden/v1");
    let files = fs::read_dir(folder).unwrap();
    let mut files: Vec<_> = files.map(|e| e.unwrap().path()).collect();
    files.sort();
    let open = |path: &std::path::PathBuf| (path.display().to_string(), Trace::open(path).unwrap());
    files.iter().map(open).collect()
}

/// How many judgements were compared.
fn compare(name: &str, told: &[Traffic], live: &[Traffic]) -> usize {
    assert_eq!(told.len(), live.len(), "{name}");
    for (told, live) in told.iter().zip(live) {
        // Rows first: they say where the difference is.
        assert_eq!(told.rows, live.rows, "{name} {}", live.profile);
        assert!(told == live, "{name} {}", live.profile);
        assert!(live.total().dram.bytes() > 0, "{name} {}", live.profile);
        adds_up(name, live);
    }
    live.len()
}

fn adds_up(name: &str, traffic: &Traffic) {
    let mut rows = Levels::default();
    traffic.rows.iter().for_each(|r| rows.add(&r.total()));
    let (pixels, mut all) = traffic.pixels().unwrap();
    pixels.iter().for_each(|l| all.add(l));
    let total = traffic.total();
    assert_eq!([rows, all], [total; 2], "{name} {}", traffic.profile);
    for counts in traffic.caches {
        let d = counts.dirty;
        assert_eq!(d.dirtied, d.written_back + d.flushed, "{name}");
    }
}

#[test]
fn recorded_traffic_of_old_files_is_live_traffic() {
    let mut compared = 0;
    for (name, trace) in goldens() {
        for frame in 0..trace.frames() {
            let told = told(&trace, frame);
            let recording = trace.recording(frame, &table()).unwrap();
            for config in configs() {
                compared += compare(&name, &told, &live(&recording, config));
            }
        }
    }
    assert!(compared >= 7 * 2 * 12, "{compared}");
}

/// Settings that keep frames small.
fn small(technique: &dyn Technique) -> Params {
    let wanted = ["map-size=64", "samples=4", "maps=4", "texture-size=8"];
    let has = |set: &&&str| {
        let key = set.split('=').next();
        technique.params().iter().any(|p| Some(p.name) == key)
    };
    let set: Vec<String> = wanted.iter().filter(has).map(|s| (*s).to_owned()).collect();
    Params::parse(technique, &set).unwrap()
}

/// The first of some scenes that the technique takes.
fn frame_of(technique: &dyn Technique) -> Recording {
    let params = small(technique);
    let scenes = ["creature", "cylinder", "demo"].map(|name| builtin::build(name).unwrap());
    let mut frames = scenes
        .iter()
        .flat_map(|s| technique.frame(s, [56, 40], &params));
    let frame = frames.next();
    frame
        .unwrap_or_else(|| panic!("{} takes no scene", technique.name()))
        .recording
}

/// Of a file with shaders by name, and of one without them.
#[test]
fn recorded_traffic_of_every_technique_is_live_traffic() {
    let (mut compared, mut merged) = (0, 0);
    for technique in techniques::all() {
        let name = technique.name();
        let recording = frame_of(*technique);
        let live = live(&recording, configs()[1]);
        for frozen in [false, true] {
            let options = RecordOptions {
                frozen,
                ..RecordOptions::default()
            };
            let trace = record(Meta::new(name), &recording, options).unwrap();
            let trace = Trace::read(trace.to_bytes().to_vec()).unwrap();
            let told = told(&trace, 0);
            let goes_on = |t: &Traffic| t.merges.iter().any(|m| m.refused.is_none());
            merged += usize::from(told.iter().any(goes_on));
            compared += compare(name, &told, &live);
        }
    }
    assert!(compared > 10 * 12 && merged > 3, "{compared} {merged}");
}

/// A run that skips is not what was recorded: what zmin/zmax threw away is missing.
#[test]
fn negative_control_a_skipping_run_is_judged_differently() {
    let mut differ = 0;
    for (_, trace) in goldens() {
        let recording = trace.recording(0, &table()).unwrap();
        let skipping = live(&recording, GpuConfig::default());
        let told = told(&trace, 0);
        differ += told.iter().zip(&skipping).filter(|(a, b)| a != b).count();
    }
    assert!(differ > 0);
}
