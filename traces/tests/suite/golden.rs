//! Old files always load, and replay to what they were.

use std::fs;
use std::path::Path;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Gpu, GpuConfig, PassReport, SimdLevel, TexelAccess,
    Wants,
};
use gnomon_shaders::table;
use gnomon_traces::{RecordOptions, Recorder, ReplayDepth, Trace, Witness, replay};

/// All files of all versions.
pub(crate) fn goldens() -> Vec<(String, Trace)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/v1");
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    files.sort();
    let open = |path: &Path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(
            fs::metadata(path).unwrap().len() <= 64 << 10,
            "{name} is too large"
        );
        (name, Trace::open(path).unwrap())
    };
    files.iter().map(|path| open(path)).collect()
}

fn configs() -> Vec<GpuConfig> {
    let mut all = Vec::new();
    for (threads, tile) in [(1, 64), (2, 16), (8, 128), (2, 32)] {
        all.extend(SimdLevel::available().into_iter().map(|simd| GpuConfig {
            threads,
            tile,
            simd,
            skip: true,
        }));
    }
    all
}

#[test]
fn events_are_as_many_as_sections_say() {
    for (name, trace) in &goldens() {
        for frame in 0..trace.frames() {
            let said = trace.event_count(frame).unwrap();
            let mut heard = Heard::default();
            let told = trace.events(frame, &mut heard);
            assert_eq!(
                said,
                told.is_ok().then_some(heard.blocks.len() as u64),
                "{name}"
            );
            assert!(said.is_none_or(|n| n > 0), "{name}");
        }
    }
}

#[test]
fn every_golden_replays_everywhere() {
    let goldens = goldens();
    assert!(goldens.len() >= 4, "{}", goldens.len());
    for (name, trace) in &goldens {
        assert!(trace.lost().is_none());
        for config in configs() {
            for frame in 0..trace.frames() {
                let done = replay(trace, frame, &table(), config, ReplayDepth::Draws).unwrap();
                assert_eq!(done.difference, None, "{name} {config:?}");
                assert!(done.draws > 0 && done.attachments > 0);
                let then = trace.counters(frame).unwrap().skipping;
                for (now, then) in done.report.passes.iter().zip(&then.passes) {
                    assert_eq!((&now.label, now.clear), (&then.label, then.clear));
                    for (now, then) in now.draws.iter().zip(&then.draws) {
                        assert_eq!((&now.label, now.counters), (&then.label, then.counters));
                    }
                }
            }
        }
    }
}

/// What a file says was recorded, recorded again: the same file, everywhere.
#[test]
fn recording_depends_on_nothing_but_the_frame() {
    for (name, golden) in goldens() {
        let mut first = None;
        for gpu in configs() {
            let options = RecordOptions {
                gpu,
                traffic: true,
                ..RecordOptions::default()
            };
            let mut recorder = Recorder::new(golden.meta().clone(), options);
            for frame in 0..golden.frames() {
                recorder
                    .add(&golden.recording(frame, &table()).unwrap())
                    .unwrap();
            }
            let again = recorder.finish().unwrap();
            assert_eq!(again.id().unwrap(), golden.id().unwrap(), "{name} {gpu:?}");
            let first = first.get_or_insert_with(|| again.to_bytes().to_vec());
            assert!(first == again.to_bytes(), "{name} {gpu:?}");
        }
    }
}

/// All that an observer is told, batches joined.
#[derive(Default)]
struct Heard {
    blocks: Vec<(usize, BlockAccess)>,
    texels: Vec<(usize, TexelAccess)>,
    ends: Vec<(usize, Vec<gnomon_raster::Counters>)>,
}

impl AccessObserver for Heard {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let before = self.blocks.len() as u32;
        let texels = batch.texels.iter().map(|t| {
            let event = t.event + before;
            (pass, TexelAccess { event, ..*t })
        });
        self.texels.extend(texels);
        // Of the witness only its classes are kept.
        let block = |b: &BlockAccess| {
            let witness = b.witness & 0xff;
            (pass, BlockAccess { witness, ..*b })
        };
        self.blocks.extend(batch.blocks.iter().map(block));
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        let counters = report.draws.iter().map(|d| d.counters);
        self.ends.push((pass, counters.collect()));
    }
}

#[test]
fn what_a_file_tells_is_what_a_live_run_tells() {
    let mut texels = 0;
    for (name, trace) in goldens() {
        for frame in 0..trace.frames() {
            let mut told = Heard::default();
            trace.events(frame, &mut told).unwrap();
            let recording = trace.recording(frame, &table()).unwrap();
            let mut gpu = Gpu::new(GpuConfig {
                skip: false,
                ..GpuConfig::default()
            })
            .unwrap();
            gpu.load(&recording).unwrap();
            let wants = Wants {
                depth_ranges: true,
                texels: true,
                witness: Some(&Witness),
                ..Wants::default()
            };
            let mut live = Heard::default();
            gpu.submit_observed(&recording.list, wants, &mut live)
                .unwrap();
            assert!(told.blocks == live.blocks, "{name}: blocks");
            assert!(told.texels == live.texels, "{name}: texels");
            assert!(told.ends == live.ends, "{name}: counters");
            texels += live.texels.len();
        }
    }
    assert!(texels > 100, "{texels}");
}

/// What needs no code is there without.
#[test]
fn shapes_need_no_shaders() {
    for (name, trace) in goldens() {
        let recording = trace.recording(0, &table()).unwrap();
        let shape = gnomon_traces::FrameShape::of(&recording);
        assert_eq!(trace.shape(0).unwrap(), shape, "{name}");
    }
}

/// A file whose shaders were changed since still tells what it holds; that it cannot be
/// drawn any more is said with shader and versions.
#[test]
fn files_of_older_shaders_tell_what_they_hold() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/retired");
    let mut files = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let trace = Trace::open(&path).unwrap();
        assert!(trace.lost().is_none());
        for frame in 0..trace.frames() {
            let shape = trace.shape(frame).unwrap();
            assert!(shape.passes.iter().any(|p| !p.draws.is_empty()));
            assert!(trace.counters(frame).unwrap().unskipped.is_some());
            let refused = trace.recording(frame, &table()).err().unwrap().to_string();
            assert!(refused.contains("version"), "{refused}");
        }
        files += 1;
    }
    assert!(files > 0);
}
