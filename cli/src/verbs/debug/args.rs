//! The command line of `gnomon debug`.

use clap::Args;

use crate::verbs::pixel::PlaceArgs;

/// Flags of `debug`.
#[derive(Debug, Args)]
pub(crate) struct DebugArgs {
    /// The pixel.
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Number of the event, as `gnomon pixel` shows it
    #[arg(value_name = "EVENT")]
    pub(crate) event: usize,
}
