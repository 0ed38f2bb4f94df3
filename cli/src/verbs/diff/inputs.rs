//! A frame of each of two traces.

use std::path::Path;

use gnomon_raster::Recording;
use gnomon_raster::shader::ShaderTable;
use gnomon_traces::{Meta, Trace};

use crate::error::CliError;

/// One of the two.
pub(crate) struct Side {
    /// The file's name.
    pub(crate) name: String,
    pub(crate) meta: Meta,
    pub(crate) frame: Recording,
}

impl Side {
    fn open(path: &Path, frame: usize, table: &ShaderTable) -> Result<Self, CliError> {
        let trace = Trace::open(path)?;
        let named = |source| CliError::InTrace {
            path: path.to_owned(),
            source,
        };
        Ok(Self {
            name: path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            meta: trace.meta().clone(),
            frame: trace.recording(frame, table).map_err(named)?,
        })
    }
}

/// Both.
pub(crate) struct Inputs {
    pub(crate) sides: [Side; 2],
}

impl Inputs {
    pub(crate) fn open(a: &Path, b: &Path, frame: usize) -> Result<Self, CliError> {
        let table = gnomon_shaders::table();
        let sides = [Side::open(a, frame, &table)?, Side::open(b, frame, &table)?];
        Ok(Self { sides })
    }

    pub(crate) fn frames(&self) -> [&Recording; 2] {
        [&self.sides[0].frame, &self.sides[1].frame]
    }
}
