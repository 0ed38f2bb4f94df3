//! From the command line to files.

use gnomon_pipeline::world::export::{ExportFormat, export};
use serde::Serialize;

use super::args::ExportArgs;
use crate::error::CliError;
use crate::flags::DEFAULT_SIZE;
use crate::output::files::{Batch, check_folder};
use crate::output::json::FileDocument;
use crate::output::{self};
use crate::verbs;

/// What was written; `docs/json.md` describes it.
#[derive(Serialize)]
struct ExportDocument<'a> {
    scene: &'a str,
    size: [u32; 2],
    warnings: Vec<NoteDocument<'a>>,
    files: &'a [FileDocument],
}

#[derive(Serialize)]
struct NoteDocument<'a> {
    code: &'static str,
    count: usize,
    message: &'a str,
}

/// Writes all files of a scene, or none.
pub(crate) fn run(args: &ExportArgs) -> Result<(), CliError> {
    check_folder("--out-dir", &args.out_dir)?;
    let scene = args.scene.open()?.at(args.time)?;
    let size = args.size.or(scene.size).unwrap_or(DEFAULT_SIZE);
    let formats: Vec<ExportFormat> = args.format.iter().map(|f| f.of()).collect();
    let exported = export(&scene, size, &verbs::file_stem(&scene.name), &formats);
    let mut batch = Batch::default();
    let mut files = Vec::new();
    for (name, bytes) in &exported.files {
        let path = args.out_dir.join(name);
        batch.stage(&path, bytes)?;
        files.push(FileDocument {
            kind: "export",
            path: path.display().to_string(),
        });
    }
    batch.commit()?;
    let notes = scene.warnings.iter().chain(&exported.warnings);
    let warnings: Vec<_> = notes
        .map(|w| NoteDocument {
            code: w.code,
            count: w.count,
            message: &w.message,
        })
        .collect();
    let mut text = String::new();
    for w in &warnings {
        text += &format!("warning: {}: {}\n", w.code, w.message);
    }
    for file in &files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    if args.json {
        output::print_json(&ExportDocument {
            scene: &scene.name,
            size,
            warnings,
            files: &files,
        })?;
    }
    output::print_summary(&text, args.json)
}
