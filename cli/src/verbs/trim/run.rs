//! Cuts, and writes what is still what it was.

use gnomon_traces::{Keep, trim};

use super::args::TrimArgs;
use crate::documents::TraceDocument;
use crate::error::CliError;
use crate::output;
use crate::output::files::{Batch, check_extension};
use crate::traces_of_frames::TraceFile;
use crate::verbs::info::contents;

/// Writes the trace that is asked for, or nothing.
pub(crate) fn run(args: &TrimArgs) -> Result<(), CliError> {
    check_extension("--out", &args.out, "gnt")?;
    let keep = match (&args.draws, &args.passes, &args.frames) {
        (Some(draws), ..) => Keep::Draws(args.frame, draws.clone()),
        (_, Some(passes), _) => Keep::Passes(args.frame, passes.clone()),
        (.., Some(frames)) => Keep::Frames(frames.clone()),
        _ => {
            return Err(CliError::Flag {
                flag: "--draws",
                value: "not given".to_owned(),
                valid: "say what to keep: --draws A..B, --passes A..B or --frames A..B".to_owned(),
            });
        }
    };
    let file = TraceFile::open(&args.trace)?;
    let table = gnomon_shaders::table();
    let shorter = file.named(trim(file.trace(), &keep, &table, args.gpu.config()))?;
    let mut batch = Batch::default();
    batch.stage(&args.out, shorter.to_bytes())?;
    batch.commit()?;
    let document = TraceDocument::new(&args.out, &shorter)?;
    output::print(&format!(
        "{}: {}, all that is kept is what it was",
        args.out.display(),
        contents(&document)
    ))
}
