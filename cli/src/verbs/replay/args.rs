//! The command line of `gnomon replay`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::GpuArgs;

/// Flags of `replay`.
#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Which frame [default: all]
    #[arg(long, value_name = "N")]
    pub(crate) frame: Option<usize>,
    /// Compare what each draw leaves, and not only where passes differ
    #[arg(long)]
    pub(crate) deep: bool,
    /// Write the picture of the frame; of several, say which with --frame
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE.png")]
    pub(crate) out: Option<PathBuf>,
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
}
