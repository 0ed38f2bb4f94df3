//! Cutting frames, passes or draws out of a trace.
//!
//! What is kept is recorded again, from textures as they were before the first draw that
//! is kept, and compared with the trace it was cut from: a cut that would show something
//! else is an error, and no trace.

mod compare;
mod cut;

use core::ops::Range;

use cut::Cut;

use gnomon_raster::GpuConfig;
use gnomon_raster::shader::ShaderTable;

use crate::error::TraceError;
use crate::meta::Mode;
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
        compare::compare(cut, (trace, *frame), (&shorter, number))?;
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
