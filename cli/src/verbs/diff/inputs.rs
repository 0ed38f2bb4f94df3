//! A frame of each of two traces.

use std::path::Path;

use gnomon_raster::Recording;
use gnomon_traces::Meta;

use crate::error::CliError;
use crate::traces_of_frames::TraceFile;

/// One of the two.
pub(crate) struct Side<'a> {
    /// The file's name.
    pub(crate) name: String,
    pub(crate) meta: Meta,
    pub(crate) frame: Recording,
    file: TraceFile<'a>,
}

impl<'a> Side<'a> {
    fn open(path: &'a Path, frame: usize) -> Result<Self, CliError> {
        let file = TraceFile::open(path)?;
        let name = path.file_name().unwrap_or_default();
        Ok(Self {
            name: name.to_string_lossy().into_owned(),
            meta: file.trace().meta().clone(),
            frame: file.frame(frame)?,
            file,
        })
    }
}

/// Both.
pub(crate) struct Inputs<'a> {
    pub(crate) sides: [Side<'a>; 2],
    pub(super) number: usize,
}

impl<'a> Inputs<'a> {
    pub(crate) fn open(a: &'a Path, b: &'a Path, frame: usize) -> Result<Self, CliError> {
        let sides = [Side::open(a, frame)?, Side::open(b, frame)?];
        let number = frame;
        Ok(Self { sides, number })
    }

    pub(crate) fn frames(&self) -> [&Recording; 2] {
        [&self.sides[0].frame, &self.sides[1].frame]
    }

    /// What `run` gives, which draws the frame of one side; see [`TraceFile::drawn`].
    pub(crate) fn drawn<T>(&self, side: usize, run: impl FnOnce() -> T) -> Result<T, CliError> {
        self.sides[side].file.drawn(self.number, run)
    }
}
