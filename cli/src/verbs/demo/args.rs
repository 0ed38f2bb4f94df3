//! The command line of `gnomon demo`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::{GpuArgs, parse_size};

/// Flags of `demo`.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Folder for pictures and the report
    #[arg(
        short = 'o',
        long,
        alias = "out",
        value_name = "DIR",
        default_value = "out"
    )]
    pub(crate) out_dir: PathBuf,
    /// Image size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x640")]
    pub(crate) size: [u32; 2],
    /// How to execute.
    #[command(flatten)]
    pub(crate) gpu: GpuArgs,
    /// Print one JSON document on stdout, the tables on stderr
    #[arg(long)]
    pub(crate) json: bool,
}
