//! The command line of `gnomon record`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::FrameArgs;

/// Flags of `record`. No byte of the trace depends on how frames are executed, but that
/// `--no-skip` turns off what techniques leave out themselves.
#[derive(Debug, Args)]
pub(crate) struct RecordArgs {
    /// What to draw.
    #[command(flatten)]
    pub(crate) frame: FrameArgs,
    /// The trace to write
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE.gnt")]
    pub(crate) out: PathBuf,
    /// Leave block accesses out: the trace replays, but says nothing of traffic
    #[arg(long)]
    pub(crate) no_traffic: bool,
    /// Keep what shaders gave instead of the shaders: larger, and drawn again without
    /// the code
    #[arg(long)]
    pub(crate) frozen: bool,
    /// Print one JSON document on stdout, the summary on stderr
    #[arg(long)]
    pub(crate) json: bool,
}
