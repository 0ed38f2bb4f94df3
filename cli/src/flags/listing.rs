//! Flags of verbs that list.

use clap::Args;

/// Flags of the verbs that list.
#[derive(Debug, Args)]
pub(crate) struct ListArgs {
    /// Print one JSON document on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
