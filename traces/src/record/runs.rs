//! The two runs of a frame that is recorded: as it is, for hashes and counters, and without
//! skipping, observed, for its traffic.

use std::panic::resume_unwind;
use std::thread;

use gnomon_raster::{
    AccessBatch, AccessObserver, Error, Gpu, GpuConfig, PassReport, Recording, SubmitReport, Wants,
};

use crate::format::events::{EventWriter, TexelWriter};
use crate::hashes::{DrawHashes, Hashing};
use crate::run;
use crate::witness::{Contents, Witness};

/// Stack of a thread that draws: what the GPU's own workers have.
const STACK: usize = 4 << 20;

/// What was found.
pub(super) struct Runs {
    pub(super) drawn: Drawn,
    /// `None` where no traffic was asked for.
    pub(super) observed: Option<Observed>,
}

/// Of the frame as it is.
pub(super) struct Drawn {
    pub(super) report: SubmitReport,
    /// What passes leave, by pass and attachment.
    pub(super) ends: Vec<Vec<u128>>,
}

/// Of the frame without skipping.
pub(super) struct Observed {
    pub(super) report: SubmitReport,
    pub(super) hashes: DrawHashes,
    pub(super) passes: Vec<PassTraffic>,
}

/// Draws `recording` once, or twice for its traffic: side by side, where there may be
/// several threads.
pub(super) fn run(recording: &Recording, config: GpuConfig, traffic: bool) -> Result<Runs, Error> {
    let draw = || draw(recording, config);
    if !traffic {
        let (drawn, observed) = (draw()?, None);
        return Ok(Runs { drawn, observed });
    }
    thread::scope(|scope| {
        let builder = (config.threads != 1).then(|| thread::Builder::new().stack_size(STACK));
        // Where no thread can be had, this one does both.
        let beside = builder.and_then(|b| b.spawn_scoped(scope, draw).ok());
        let Some(beside) = beside else {
            let (drawn, observed) = (draw()?, Some(observe(recording, config)?));
            return Ok(Runs { drawn, observed });
        };
        let observed = observe(recording, config);
        let drawn = beside.join().unwrap_or_else(|p| resume_unwind(p))?;
        let observed = Some(observed?);
        Ok(Runs { drawn, observed })
    })
}

fn gpu(config: GpuConfig, skip: bool) -> Result<Gpu, Error> {
    Gpu::new(GpuConfig { skip, ..config })
}

/// The frame as it is.
fn draw(recording: &Recording, config: GpuConfig) -> Result<Drawn, Error> {
    let (mut last, mut ends) = (run::EndHashes::default(), Vec::new());
    let report = run::draw_passes(&mut gpu(config, true)?, recording, |gpu, _, pass| {
        ends.push(last.of(gpu, pass)?);
        Ok(())
    })?;
    Ok(Drawn { report, ends })
}

/// The frame without skipping, and its traffic.
fn observe(recording: &Recording, config: GpuConfig) -> Result<Observed, Error> {
    let mut traffic = TrafficWriter::new(recording);
    let wants = Wants {
        depth_ranges: true,
        texels: true,
        witness: Some(&Witness),
        left: Some(&Contents),
        ..Wants::default()
    };
    let mut gpu = gpu(config, false)?;
    gpu.load(recording)?;
    let report = gpu.submit_observed(&recording.list, wants, &mut traffic)?;
    Ok(Observed {
        report,
        hashes: traffic.hashes.done(),
        passes: traffic.passes,
    })
}

/// What was heard of a pass.
pub(super) struct PassTraffic {
    pub(super) events: Vec<u8>,
    pub(super) texels: Vec<u8>,
}

/// Writes down what it hears.
struct TrafficWriter {
    hashes: Hashing,
    passes: Vec<PassTraffic>,
    /// Of the pass that is under way.
    open: Open,
}

struct Open {
    events: EventWriter,
    texels: TexelWriter,
    heard: u64,
}

impl Default for Open {
    fn default() -> Self {
        Self {
            events: EventWriter::new(),
            texels: TexelWriter::new(),
            heard: 0,
        }
    }
}

impl TrafficWriter {
    fn new(recording: &Recording) -> Self {
        let passes = recording.list.passes.iter();
        Self {
            hashes: Hashing::new(passes.map(|p| p.draws.len())),
            passes: Vec::new(),
            open: Open::default(),
        }
    }
}

impl AccessObserver for TrafficWriter {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        self.hashes.batch(pass, batch);
        let open = &mut self.open;
        batch.blocks.iter().for_each(|b| open.events.push(b));
        for texel in batch.texels {
            open.texels.push(open.heard + u64::from(texel.event), texel);
        }
        open.heard += batch.blocks.len() as u64;
    }

    fn end(&mut self, _: usize, _: &PassReport) {
        let open = core::mem::take(&mut self.open);
        self.passes.push(PassTraffic {
            events: open.events.finish(),
            texels: open.texels.finish(),
        });
    }
}
