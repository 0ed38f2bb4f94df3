//! The command line of `gnomon diff`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::GpuArgs;

/// Flags of `diff`.
#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// The first trace
    #[arg(value_name = "A.gnt")]
    pub(crate) a: PathBuf,
    /// The second trace
    #[arg(value_name = "B.gnt")]
    pub(crate) b: PathBuf,
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
