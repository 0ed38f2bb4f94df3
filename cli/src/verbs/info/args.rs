//! The command line of `gnomon info`.

use std::path::PathBuf;

use clap::Args;

/// Flags of `info`.
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The trace
    #[arg(value_name = "FILE.gnt")]
    pub(crate) trace: PathBuf,
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
