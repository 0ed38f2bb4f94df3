//! From the command line to the comparison.

use gnomon_pipeline::techniques::Registry;

use super::args::CompareArgs;
use super::job::CompareJob;
use super::measure::{self, Comparison, Measured};
use super::{against, csv, environment, picture, table};
use crate::documents::{
    CompareDocument, CompareInputs, FileDocument, ResultDocument, worker_threads,
};
use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::pause::Pause;
use crate::output::png_text::{About, software, with_text};
use crate::output::progress::Progress;
use crate::output::{self, numbers, png};

/// Renders, measures, draws and prints.
pub(crate) fn run(args: &CompareArgs, registry: &Registry) -> Result<(), CliError> {
    if args.against.is_some() {
        return against::run(args, registry);
    }
    if args.environment.env.is_some() {
        return environment::run(args, registry);
    }
    let job = CompareJob::new(args, registry)?;
    let progress = Progress::new(job.steps());
    let mut pause = Pause::default();
    // Where it cannot be written yet the whole picture may be, or says why not.
    let mut grown = |found: &Comparison| pause.unless_too_soon(|| write_picture(&job, found));
    let found = measure::run(&job, &progress, &mut grown)?;
    progress.doing("writing the picture");
    write_picture(&job, &found)?;
    let mut batch = Batch::default();
    let mut files = vec![FileDocument {
        kind: "comparison",
        path: job.out.display().to_string(),
    }];
    let table = job
        .csv
        .as_ref()
        .map(|path| (path, csv::write(&found.measured)));
    if let Some((path, table)) = table.as_ref().filter(|(path, _)| !output::is_stdout(path)) {
        batch.stage(path, table.as_bytes())?;
        files.push(FileDocument {
            kind: "table",
            path: path.display().to_string(),
        });
    }
    batch.commit()?;
    drop(progress);
    let to_stdout = table.filter(|(path, _)| output::is_stdout(path));
    if let Some((_, table)) = &to_stdout {
        output::write_stdout(table.as_bytes())?;
    }
    if args.json {
        output::print_json(&document(&job, &found, files.clone()))?;
    }
    let is_taken = args.json || to_stdout.is_some();
    output::print_summary(&summarise(&job, &found, &files), is_taken)
}

/// Draws what has been compared, in place of an earlier picture.
fn write_picture(job: &CompareJob, found: &Comparison) -> Result<(), CliError> {
    let mut batch = Batch::default();
    let picture = png::encode(&picture::draw(job, found));
    batch.stage(&job.out, &with_text(&picture, &about(job, found)))?;
    batch.commit()
}

fn document<'a>(
    job: &'a CompareJob,
    found: &Comparison,
    files: Vec<FileDocument>,
) -> CompareDocument<'a> {
    let inputs = CompareInputs {
        scene: &job.scene,
        settings: job.settings,
        reference_ms: found.reference_ms,
    };
    let results = job.entries.iter().zip(&found.measured);
    let results =
        results.map(|(e, m)| ResultDocument::new(e.technique, &e.params, &m.done, &m.score));
    CompareDocument::new(inputs, &found.reference, results.collect(), files)
}

/// What the picture says of itself.
fn about(job: &CompareJob, found: &Comparison) -> About {
    let labels: Vec<&str> = found.measured.iter().map(|m| m.label.as_str()).collect();
    vec![
        software(),
        ("Scene", job.scene.name.clone()),
        ("Light", job.light.to_string()),
        ("Reference", job.reference.name().to_owned()),
        ("Techniques", labels.join(", ")),
    ]
}

fn summarise(job: &CompareJob, found: &Comparison, files: &[FileDocument]) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}, light {}, {}x{}: {} threads, {}, skipping {}\n{}\n",
        job.scene.name,
        job.light,
        settings.size[0],
        settings.size[1],
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        if settings.gpu.skip { "on" } else { "off" },
        describe_truth(found),
    );
    for table in table::tabulate(&found.measured) {
        text += &format!("\n{}", table.to_text());
    }
    for line in collect_warnings(job, found) {
        text += &format!("warning: {line}\n");
    }
    for file in files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    text
}

/// One line about the reference.
fn describe_truth(found: &Comparison) -> String {
    let reference = &found.reference;
    let what = match (reference.is_soft, reference.kind.name()) {
        (true, "rays") => "4096 stratified shadow rays a pixel".to_owned(),
        (true, kind) => format!("the {kind} soft shadow"),
        (false, kind) => format!("the hard shadow ({kind}): the light has no area"),
    };
    let how = match found.reference_ms {
        Some(ms) => format!("computed in {}", numbers::milliseconds(ms)),
        None => "read from the cache".to_owned(),
    };
    format!("truth: {what}, {how}")
}

/// Warnings of the cache and of every technique, each once.
fn collect_warnings(job: &CompareJob, found: &Comparison) -> Vec<String> {
    let cache = found.reference.warnings.iter().map(|w| w.to_string());
    let mut lines: Vec<String> = cache.collect();
    if !job.left_out.is_empty() {
        let names = job.left_out.join(", ");
        lines.push(format!("light-not-taken: left out of all: {names}"));
    }
    for (entry, Measured { done, .. }) in job.entries.iter().zip(&found.measured) {
        let of = |w: &gnomon_pipeline::technique::Warning| {
            format!("{}: {}: {}", entry.label, w.code, w.message)
        };
        lines.extend(done.warnings.iter().map(of));
    }
    lines
}
