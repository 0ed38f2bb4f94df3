//! The command line of `gnomon bisect`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gnomon_traces::Suspects;

use crate::flags::GpuArgs;

/// Flags of `bisect`.
#[derive(Debug, Args)]
pub(crate) struct BisectArgs {
    /// The trace to begin with
    #[arg(value_name = "A.gnt")]
    pub(crate) a: PathBuf,
    /// The trace whose state is put into it
    #[arg(value_name = "B.gnt")]
    pub(crate) b: PathBuf,
    /// Which differences may be the cause
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = By::State)]
    pub(crate) by: By,
    /// The frame of both
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Which differences may be the cause.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum By {
    /// All state
    State,
    /// Shaders and their uniforms
    Shader,
}

impl By {
    pub(super) fn suspects(self) -> Suspects {
        match self {
            Self::State => Suspects::State,
            Self::Shader => Suspects::Shaders,
        }
    }
}
