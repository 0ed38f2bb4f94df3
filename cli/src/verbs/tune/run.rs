//! From the command line to the winner.

use gnomon_pipeline::techniques::Registry;

use super::args::TuneArgs;
use super::document::TuneDocument;
use super::job::TuneJob;
use super::search::search;
use super::text;
use crate::error::CliError;
use crate::output;

/// Searches, and prints what was found.
pub(crate) fn run(args: &TuneArgs, registry: &Registry) -> Result<(), CliError> {
    let job = TuneJob::new(args, registry)?;
    let found = search(&job)?;
    if args.json {
        output::print_json(&TuneDocument::new(&job, &found))?;
    }
    output::print_summary(&text::summarise(&job, &found), args.json)
}
