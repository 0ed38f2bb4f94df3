//! From the command line to files.

use std::path::Path;

use gnomon_pipeline::world::export::{ExportFormat, export};
use serde::Serialize;

use super::args::ExportArgs;
use crate::documents::FileDocument;
use crate::error::CliError;
use crate::flags::DEFAULT_SIZE;
use crate::output::files::{Batch, check_folder};
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
        check_not_the_scene(args, &path)?;
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

/// A file that was read to make the export is not replaced by it.
fn check_not_the_scene(args: &ExportArgs, path: &Path) -> Result<(), CliError> {
    let given = Path::new(&args.scene.scene);
    let (Ok(given), Ok(target)) = (given.canonicalize(), path.canonicalize()) else {
        return Ok(());
    };
    // Models and materials of a scene lie beside it, under names like those of the export.
    let is_beside = given.parent() == target.parent() && given.file_stem() == target.file_stem();
    match given == target || is_beside {
        true => Err(CliError::Flag {
            flag: "--out-dir",
            value: args.out_dir.display().to_string(),
            valid: format!(
                "{} would be replaced, beside the scene that is exported; give another folder",
                path.display()
            ),
        }),
        false => Ok(()),
    }
}
