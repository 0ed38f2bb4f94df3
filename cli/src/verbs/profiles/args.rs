//! The command line of `gnomon profiles`.

use clap::{Args, Subcommand};

/// Flags of `profiles`.
#[derive(Debug, Args)]
pub(crate) struct ProfilesArgs {
    /// What to do instead of listing them.
    #[command(subcommand)]
    pub(crate) verb: Option<ProfilesVerb>,
    /// Print one JSON document on stdout
    #[arg(long, global = true)]
    pub(crate) json: bool,
}

/// What can be done with a profile.
#[derive(Debug, Subcommand)]
pub(crate) enum ProfilesVerb {
    /// Print every value of a profile and where it is from
    Show {
        /// Its name, or the path of your own (.toml)
        profile: String,
    },
}
