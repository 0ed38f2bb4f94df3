//! What listening to a frame costs, and recording and replaying it: `cargo run --release -p
//! gnomon-traces --example observing_cost -- FILE.gnt [ROUNDS]`. One thread; the best of some
//! rounds taken in turn, also as plain frames: the thread's own time where the system tells
//! it, so that others on the machine count for less.

use std::time::Instant;

use gnomon_raster::{AccessBatch, AccessObserver, Gpu, GpuConfig, Recording, Wants};
use gnomon_traces::{
    Contents, RecordOptions, ReplayDepth, Trace, TraceError, Witness, record, replay,
};

struct Nobody;

impl AccessObserver for Nobody {
    fn batch(&mut self, _: usize, _: &AccessBatch<'_>) {}
}

/// What is done with the frame.
#[derive(Clone, Copy)]
enum Kind {
    Plain,
    Observe(Wants<'static>),
    Record { traffic: bool },
    Replay,
}

/// What is done, by name.
fn kinds() -> Vec<(&'static str, Kind)> {
    let events = Wants::default();
    let ranges = Wants {
        depth_ranges: true,
        ..events
    };
    let texels = Wants {
        texels: true,
        ..ranges
    };
    let witness = Wants {
        witness: Some(&Witness),
        ..texels
    };
    let left = Wants {
        left: Some(&Contents),
        ..witness
    };
    let hashes = Wants {
        left: Some(&Contents),
        ..events
    };
    let pixel = Wants {
        probe: Some([1, 1]),
        ..events
    };
    vec![
        ("plain", Kind::Plain),
        ("events", Kind::Observe(events)),
        ("and depth ranges", Kind::Observe(ranges)),
        ("and texels", Kind::Observe(texels)),
        ("and a witness", Kind::Observe(witness)),
        ("and hashes", Kind::Observe(left)),
        ("events and hashes", Kind::Observe(hashes)),
        ("one pixel", Kind::Observe(pixel)),
        ("record, no traffic", Kind::Record { traffic: false }),
        ("record", Kind::Record { traffic: true }),
        ("replay", Kind::Replay),
    ]
}

const GPU: fn() -> GpuConfig = || GpuConfig {
    threads: 1,
    ..GpuConfig::default()
};

/// Time that passes.
struct Clock(Instant, Option<f64>);

impl Clock {
    fn start() -> Self {
        Self(Instant::now(), own_seconds())
    }

    fn seconds(&self) -> f64 {
        match (self.1, own_seconds()) {
            (Some(start), Some(now)) => now - start,
            _ => self.0.elapsed().as_secs_f64(),
        }
    }
}

/// How long this thread has run, of Linux, which otherwise only knows it to a tick of its
/// clock (4 ms) while the thread goes on running.
fn own_seconds() -> Option<f64> {
    std::thread::yield_now();
    let all = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: u64 = all.split(' ').next()?.parse().ok()?;
    Some(nanoseconds as f64 / 1e9)
}

/// Draws the frame; loading it is not counted.
fn draw(frame: &Recording, wants: Option<Wants<'_>>) -> Result<f64, gnomon_raster::Error> {
    let mut gpu = Gpu::new(GPU())?;
    gpu.load(frame)?;
    let start = Clock::start();
    match wants {
        None => gpu.submit(&frame.list)?,
        Some(wants) => gpu.submit_observed(&frame.list, wants, &mut Nobody)?,
    };
    Ok(start.seconds())
}

fn seconds(trace: &Trace, frame: &Recording, kind: Kind) -> Result<f64, TraceError> {
    let gpu = |e| TraceError::Gpu {
        frame: 0,
        source: e,
    };
    let start = Clock::start();
    match kind {
        Kind::Plain => return draw(frame, None).map_err(gpu),
        Kind::Observe(wants) => return draw(frame, Some(wants)).map_err(gpu),
        Kind::Record { traffic } => {
            let options = RecordOptions {
                gpu: GPU(),
                traffic,
                ..RecordOptions::default()
            };
            drop(record(trace.meta().clone(), frame, options)?);
        }
        Kind::Replay => {
            let table = gnomon_shaders::table();
            replay(trace, 0, &table, GPU(), ReplayDepth::Ends)?;
        }
    }
    Ok(start.seconds())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which trace?")?;
    let rounds: usize = arguments.next().map_or(Ok(5), |n| n.parse())?;
    let only = arguments.next();
    let trace = Trace::open(path)?;
    let frame = trace.recording(0, &gnomon_shaders::table())?;
    let mut kinds = kinds();
    kinds.retain(|(name, _)| *name == "plain" || only.as_ref().is_none_or(|o| o == name));
    let mut best = vec![f64::INFINITY; kinds.len()];
    for _ in 0..rounds {
        for ((_, kind), best) in kinds.iter().zip(&mut best) {
            *best = best.min(seconds(&trace, &frame, *kind)?);
        }
    }
    for ((name, _), time) in kinds.iter().zip(&best) {
        println!("{name:18} {:8.2} ms {:6.2}", time * 1e3, time / best[0]);
    }
    Ok(())
}
