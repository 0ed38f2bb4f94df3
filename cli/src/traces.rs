//! Frames of traces, with the shaders that this program has.

use std::path::Path;

use gnomon_raster::Recording;
use gnomon_traces::Trace;

use crate::error::CliError;

/// Frame number `frame` of the trace at `path`, ready to be drawn.
pub(crate) fn frame(path: &Path, frame: usize) -> Result<Recording, CliError> {
    let trace = Trace::open(path)?;
    Ok(trace.recording(frame, &gnomon_shaders::table())?)
}
