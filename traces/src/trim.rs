//! Cutting frames, passes or draws out of a trace.
//!
//! What is kept is recorded again, from textures as they were before the first draw that
//! is kept, and compared with the trace it was cut from: a cut that would show something
//! else is an error, and no trace.

use core::ops::Range;

use gnomon_raster::shader::ShaderTable;
use gnomon_raster::{
    CommandList, Counters, Gpu, GpuConfig, LoadOp, Recording, RenderPass, StoreOp, SubmitReport,
};

use crate::error::TraceError;
use crate::format::v1::TileHash;
use crate::meta::Mode;
use crate::prefix::until;
use crate::record::{RecordOptions, Recorder};
use crate::run::guarded;
use crate::trace::Trace;

/// What is kept of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Frames, whole.
    Frames(Range<usize>),
    /// Passes of a frame.
    Passes(usize, Range<usize>),
    /// Draws of a frame, counted over all its passes.
    Draws(usize, Range<usize>),
}

/// Cuts `keep` out of `trace`.
///
/// # Errors
/// There is nothing such, its shaders are not in `table`, or what would be kept is not what
/// it was.
pub fn trim(
    trace: &Trace,
    keep: &Keep,
    table: &ShaderTable,
    config: GpuConfig,
) -> Result<Trace, TraceError> {
    let options = RecordOptions {
        gpu: config,
        traffic: trace.meta().traffic,
        frozen: trace.meta().mode == Mode::Frozen,
    };
    let mut recorder = Recorder::new(trace.meta().clone(), options);
    let (frames, cuts) = match keep {
        Keep::Frames(frames) => (frames.clone(), None),
        Keep::Passes(frame, _) | Keep::Draws(frame, _) => {
            (*frame..frame.saturating_add(1), Some(keep))
        }
    };
    check("frames", &frames, trace.frames())?;
    let mut kept = Vec::new();
    for frame in frames.clone() {
        let recording = trace.recording(frame, table)?;
        let cut = match cuts {
            None => Cut::whole(&recording),
            Some(keep) => Cut::of(&recording, keep)?,
        };
        let shorter = guarded(frame, || cut.apply(&recording, config))?;
        guarded(frame, || Ok(recorder.add(&shorter)))??;
        kept.push((frame, cut));
    }
    let shorter = recorder.finish()?;
    for (number, (frame, cut)) in kept.iter().enumerate() {
        cut.compare(trace, *frame, &shorter, number)?;
    }
    Ok(shorter)
}

fn check(what: &'static str, given: &Range<usize>, count: usize) -> Result<(), TraceError> {
    match given.start < given.end && given.end <= count {
        true => Ok(()),
        false => Err(TraceError::Range {
            what,
            given: format!("{}..{}", given.start, given.end),
            count,
        }),
    }
}

/// What is kept of a frame.
struct Cut {
    /// The first pass, and its first draw.
    first: [usize; 2],
    /// The last pass, and the end of its draws.
    last: [usize; 2],
}

impl Cut {
    fn whole(recording: &Recording) -> Self {
        let passes = &recording.list.passes;
        Self {
            first: [0, 0],
            last: [
                passes.len().saturating_sub(1),
                passes.last().map_or(0, |p| p.draws.len()),
            ],
        }
    }

    fn of(recording: &Recording, keep: &Keep) -> Result<Self, TraceError> {
        let passes = &recording.list.passes;
        match keep {
            Keep::Frames(_) => Ok(Self::whole(recording)),
            Keep::Passes(_, kept) => {
                check("passes", kept, passes.len())?;
                let last = kept.end - 1;
                Ok(Self {
                    first: [kept.start, 0],
                    last: [last, passes[last].draws.len()],
                })
            }
            Keep::Draws(_, kept) => {
                check("draws", kept, passes.iter().map(|p| p.draws.len()).sum())?;
                let [pass, draw] = place(passes, kept.end - 1);
                Ok(Self {
                    first: place(passes, kept.start),
                    last: [pass, draw + 1],
                })
            }
        }
    }

    /// The frame that is kept.
    fn apply(
        &self,
        recording: &Recording,
        config: GpuConfig,
    ) -> Result<Recording, gnomon_raster::Error> {
        let mut kept = self.state_before(recording, config)?;
        for (name, id) in recording.outputs() {
            kept.name_output(name, id)?;
        }
        let ([first, draw], [last, end]) = (self.first, self.last);
        let passes = recording.list.passes.get(first..=last).unwrap_or_default();
        kept.list.passes = passes.to_vec();
        if let Some(pass) = kept.list.passes.last_mut()
            && end < pass.draws.len()
        {
            pass.draws.truncate(end);
            keep_results(pass);
        }
        if let Some(pass) = kept.list.passes.first_mut()
            && draw > 0
        {
            pass.draws.drain(..draw);
            load_state(pass);
        }
        Ok(kept)
    }

    /// Textures before the first draw that is kept.
    fn state_before(
        &self,
        recording: &Recording,
        config: GpuConfig,
    ) -> Result<Recording, gnomon_raster::Error> {
        let [pass, draw] = self.first;
        let list = match (pass, draw) {
            (pass, 0) => CommandList {
                passes: recording.list.passes[..pass].to_vec(),
            },
            (pass, draw) => until(&recording.list, [pass, draw - 1]),
        };
        let mut gpu = Gpu::new(config)?;
        gpu.load(recording)?;
        gpu.submit(&list)?;
        gpu.save()
    }

    /// Whether every kept draw and pass left and counted what it did.
    fn compare(
        &self,
        trace: &Trace,
        frame: usize,
        shorter: &Trace,
        number: usize,
    ) -> Result<(), TraceError> {
        let (then, now) = (trace.hashes(frame)?, shorter.hashes(number)?);
        let (counted, counts) = (trace.counters(frame)?, shorter.counters(number)?);
        let differs = |pass: usize, what: &str| TraceError::Trimmed {
            frame,
            pass: pass + self.first[0],
            what: what.to_owned(),
        };
        let reports = [
            (Some(&counted.skipping), Some(&counts.skipping)),
            (counted.unskipped.as_ref(), counts.unskipped.as_ref()),
        ];
        for (pass, end) in now.ends.iter().enumerate() {
            let old = pass + self.first[0];
            let count = counted
                .skipping
                .passes
                .get(old)
                .map_or(0, |p| p.draws.len());
            let draws = self.draws_of(old, count);
            if draws.end == usize::MAX && then.ends.get(old) != Some(end) {
                return Err(differs(pass, "what it leaves"));
            }
            let old_tiles = then.draws.get(old).map(|t| tiles(t, &draws));
            if old_tiles != now.draws.get(pass).cloned() {
                return Err(differs(pass, "what its draws leave"));
            }
            let changed = |(a, b): &(Option<&SubmitReport>, Option<&SubmitReport>)| {
                a.map(|a| counters(a, old, &draws))
                    != b.map(|b| counters(b, pass, &(0..usize::MAX)))
            };
            if reports.iter().any(changed) {
                return Err(differs(pass, "what its draws count"));
            }
        }
        Ok(())
    }

    /// Which draws are kept of a pass; without end where all behind the first are.
    fn draws_of(&self, pass: usize, count: usize) -> Range<usize> {
        let start = if pass == self.first[0] {
            self.first[1]
        } else {
            0
        };
        let is_cut = pass == self.last[0] && self.last[1] < count;
        let end = if is_cut { self.last[1] } else { usize::MAX };
        start..end
    }
}

/// Pass and draw of a draw that is counted over all passes.
fn place(passes: &[RenderPass], mut draw: usize) -> [usize; 2] {
    for (number, pass) in passes.iter().enumerate() {
        if draw < pass.draws.len() {
            return [number, draw];
        }
        draw -= pass.draws.len();
    }
    unreachable!("the range was checked")
}

fn keep_results(pass: &mut RenderPass) {
    pass.color.iter_mut().for_each(|a| a.store = StoreOp::Store);
    if let Some(a) = &mut pass.depth_stencil {
        (a.depth_store, a.stencil_store) = (StoreOp::Store, StoreOp::Store);
    }
}

fn load_state(pass: &mut RenderPass) {
    pass.color.iter_mut().for_each(|a| a.load = LoadOp::Load);
    if let Some(a) = &mut pass.depth_stencil {
        (a.depth_load, a.stencil_load) = (LoadOp::Load, LoadOp::Load);
    }
}

/// Hashes of some draws, numbered as if they were the first.
fn tiles(all: &[TileHash], draws: &Range<usize>) -> Vec<TileHash> {
    let kept = all.iter().filter(|t| draws.contains(&(t.draw as usize)));
    let moved = kept.map(|t| TileHash {
        draw: t.draw - draws.start as u32,
        ..*t
    });
    moved.collect()
}

fn counters(report: &SubmitReport, pass: usize, draws: &Range<usize>) -> Vec<Counters> {
    let all = report.passes.get(pass).map_or(&[][..], |p| &p.draws);
    let draws = all.iter().enumerate().filter(|(i, _)| draws.contains(i));
    draws.map(|(_, d)| d.counters).collect()
}
