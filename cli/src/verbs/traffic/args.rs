//! The command line of `gnomon traffic`.

use std::path::PathBuf;

use clap::Args;

use crate::documents::By;

/// Flags of `traffic`.
#[derive(Debug, Args)]
#[command(
    after_help = "Logical bytes are what the commands ask for after the profile's HiZ, \
cache bytes go between units and caches, dram bytes between caches and memory. dram and \
cache are modelled. `gnomon profiles` lists the profiles."
)]
pub(crate) struct TrafficArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Profiles by name, or paths of your own (.toml)
    #[arg(long, value_name = "P[,Q...]", value_delimiter = ',', required = true)]
    pub(crate) profile: Vec<String>,
    /// What a row is
    #[arg(long, value_enum, default_value_t = By::Pass)]
    pub(crate) by: By,
    /// The frame, from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) frame: usize,
    /// Judge tilers also with passes merged, as far as their attachments allow
    #[arg(long)]
    pub(crate) per_pass_merged: bool,
    /// Write rows (.csv, or - for stdout), or dram bytes of tiles or pixels of one profile (.npy)
    #[arg(short = 'o', long, alias = "out-dir", value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
