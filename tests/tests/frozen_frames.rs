//! Frozen frames are the live ones: attachments, counters, accesses and histories, without
//! a single shader of theirs.

use gnomon_raster::shader::ShaderTable;
use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Counters, Gpu, GpuConfig, Recording, Wants,
};
use gnomon_tests::check::config_of;
use gnomon_tests::gpu_run;
use gnomon_tests::parallel;
use gnomon_tests::random::{Random, random_case};
use gnomon_traces::frozen::freeze;
use gnomon_traces::history::{self, EventKind, HistoryOptions};
use gnomon_traces::{Meta, RecordOptions, Trace, TraceError, record};

const CASES: u64 = 150;

#[derive(Default)]
struct Accesses(Vec<(usize, BlockAccess)>);

impl AccessObserver for Accesses {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        self.0.extend(batch.blocks.iter().map(|b| (pass, *b)));
    }
}

/// What a run leaves and does.
#[derive(Debug, PartialEq)]
struct Ran {
    textures: Vec<Vec<u8>>,
    counters: Vec<Counters>,
    accesses: Vec<(usize, BlockAccess)>,
}

fn run(recording: &Recording, config: GpuConfig) -> Ran {
    let mut gpu = Gpu::new(config).unwrap();
    gpu.load(recording).unwrap();
    let wants = Wants {
        depth_ranges: true,
        ..Wants::default()
    };
    let mut accesses = Accesses::default();
    let report = gpu
        .submit_observed(&recording.list, wants, &mut accesses)
        .unwrap();
    let ids = gpu.texture_ids();
    let images = ids.flat_map(|id| {
        let texture = gpu.texture(id).unwrap();
        texture.descriptor().images().map(move |s| (id, s))
    });
    Ran {
        textures: images
            .map(|(id, s)| gpu.texture(id).unwrap().read_packed(s).unwrap())
            .collect(),
        counters: report
            .passes
            .iter()
            .flat_map(|p| p.draws.iter().map(|d| d.counters))
            .collect(),
        accesses: accesses.0,
    }
}

/// What frozen shaders do not do again.
fn without_shaders_own(mut ran: Ran) -> Ran {
    for c in &mut ran.counters {
        c.traffic.tex = Default::default();
        c.traffic.tex_fetches = Default::default();
        c.shader_counts = Default::default();
    }
    ran
}

/// A history in words, since clears may have NaN, without varyings, which frozen shaders
/// have none of.
fn told(recording: &Recording, config: GpuConfig, pixel: [u32; 2]) -> String {
    let options = HistoryOptions {
        config,
        image: None,
    };
    let mut history = match history::pixel(recording, &options, pixel) {
        Ok(history) => history,
        Err(e) => return e.to_string(),
    };
    for e in &mut history.events {
        if let EventKind::Fragment(f) = &mut e.kind {
            f.varyings = None;
        }
    }
    format!("{history:?}")
}

fn compare(seed: u64) {
    let case = random_case(seed);
    let recording = gpu_run::recording(&case, config_of(seed)).unwrap();
    let frozen = freeze(&recording, config_of(seed + 1)).unwrap();
    let options = RecordOptions {
        gpu: config_of(seed),
        traffic: false,
        frozen: true,
    };
    let trace = record(Meta::new("case"), &recording, options).unwrap();
    let trace = Trace::read(trace.to_bytes().to_vec()).unwrap();
    let read = trace.recording(0, &ShaderTable::default()).unwrap();
    let mut r = Random::new(seed ^ 0xf02e);
    for skip in [true, false] {
        let config = GpuConfig {
            skip,
            ..config_of(seed + 2)
        };
        let ran = run(&recording, config);
        if skip {
            let kept = trace.counters(0).unwrap().skipping;
            let kept = kept.passes.iter().flat_map(|p| &p.draws);
            let kept: Vec<Counters> = kept.map(|d| d.counters).collect();
            assert_eq!(kept, ran.counters, "seed {seed}: counters of the recording");
        }
        let live = without_shaders_own(ran);
        for (what, again) in [("frozen", &frozen), ("read", &read)] {
            let again = without_shaders_own(run(again, config));
            assert!(again.textures == live.textures, "seed {seed}, {what}");
            assert_eq!(again.counters, live.counters, "seed {seed}, {what}");
            assert!(again.accesses == live.accesses, "seed {seed}, {what}");
        }
        let pixel = [r.below(case.size[0]), r.below(case.size[1])];
        let live = told(&recording, config, pixel);
        assert_eq!(live, told(&read, config, pixel), "seed {seed}, {pixel:?}");
    }
}

#[test]
fn frozen_frames_equal_live_ones() {
    parallel::map(0..CASES, compare);
}

/// A frame of closures cannot be recorded by name, and the error says what can be done.
#[test]
fn closures_are_told_to_be_frozen() {
    let with_closure = |seed: &u64| {
        let case = random_case(*seed);
        let draws = case.passes.iter().flat_map(|p| &p.draws);
        draws.count() > 0
    };
    let seed = (0..).find(with_closure).unwrap();
    let recording = gpu_run::recording(&random_case(seed), config_of(seed)).unwrap();
    let e = record(Meta::new("case"), &recording, RecordOptions::default()).unwrap_err();
    assert!(matches!(e, TraceError::NoIdentity { .. }), "{e}");
    assert!(e.to_string().contains("record frozen"), "{e}");
}

/// Damaged outputs are refused with the place, and take no memory for what is not there.
#[test]
fn damaged_outputs_are_refused() {
    let recording = gpu_run::recording(&random_case(1), config_of(1)).unwrap();
    let frozen = freeze(&recording, config_of(1)).unwrap();
    let draws = frozen.list.passes.iter().flat_map(|p| &p.draws);
    let mut refused = 0;
    for fragment in draws.filter_map(|d| d.pipeline.fragment.as_ref()) {
        let identity = fragment.identity().unwrap();
        let table = gnomon_traces::frozen::table();
        assert!(table.fragment(&identity).is_ok());
        for cut in 0..identity.uniforms.len().min(400) {
            let mut short = identity.clone();
            short.uniforms.truncate(cut);
            assert!(table.fragment(&short).is_err(), "cut at {cut}");
            refused += 1;
        }
        for at in 0..identity.uniforms.len().min(400) {
            let mut wrong = identity.clone();
            wrong.uniforms[at] ^= 0xff;
            // Anything but a crash.
            let _ = table.fragment(&wrong);
        }
    }
    assert!(refused > 100, "{refused}");
}
