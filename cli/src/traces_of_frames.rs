//! Traces that the command line names: opened, and drawn with the shaders that this program
//! has. Every error says which file it is of.

use std::path::Path;

use gnomon_raster::Recording;
use gnomon_traces::{FrameShape, Trace, TraceError, guarded};

use crate::error::CliError;

/// A trace, and the file that it is in.
pub(crate) struct TraceFile<'a> {
    path: &'a Path,
    trace: Trace,
}

impl<'a> TraceFile<'a> {
    pub(crate) fn open(path: &'a Path) -> Result<Self, CliError> {
        let trace = Trace::open(path)?;
        Ok(Self { path, trace })
    }

    pub(crate) fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Frame number `frame`, ready to be drawn.
    pub(crate) fn frame(&self, frame: usize) -> Result<Recording, CliError> {
        let table = gnomon_shaders::table();
        self.named(self.trace.recording(frame, &table))
    }

    /// What a frame does, without its data.
    pub(crate) fn shape(&self, frame: usize) -> Result<FrameShape, CliError> {
        self.named(self.trace.shape(frame))
    }

    /// What `run` gives, which draws frame `frame`; a shader that panics is an error of the
    /// file.
    pub(crate) fn drawn<T>(&self, frame: usize, run: impl FnOnce() -> T) -> Result<T, CliError> {
        self.named(guarded(frame, run))
    }

    /// `result`, with the file's name where it is an error.
    pub(crate) fn named<T>(&self, result: Result<T, TraceError>) -> Result<T, CliError> {
        result.map_err(|source| CliError::InTrace {
            path: self.path.to_owned(),
            source,
        })
    }
}
