//! `gnomon compare --against FILE`: somebody else's visibility or picture of the scene.

mod document;
mod picture;
mod read;
mod score;

use gnomon_pipeline::measure::comparison::{Aligned, Reference, shaded};
use gnomon_pipeline::measure::render::{Rendered, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::Registry;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;

use super::args::CompareArgs;
use super::job::CompareJob;
use crate::documents::FileDocument;
use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::progress::Progress;
use crate::output::{self, png};
use read::{Content, Theirs};
use score::Found;

/// What gives the surfaces that a picture shows, without shadows of its own.
const SURFACES: &str = "unshadowed";

/// Reads the file, finds the truth, says what differs and where.
pub(crate) fn run(args: &CompareArgs, registry: &Registry) -> Result<(), CliError> {
    let file = args.against.as_deref().expect("asked for");
    let theirs = read::theirs(file)?;
    let truth = args.truth.as_deref().map(read::truth).transpose()?;
    for (flag, size) in [
        ("--size", args.size),
        ("--truth", truth.as_ref().map(|t| t.size)),
    ] {
        check_size(flag, size, theirs.size)?;
    }
    let job = CompareJob::against(args, theirs.size)?;
    let progress = Progress::new(job.steps());
    let reference = reference(&job, truth, &progress)?;
    progress.doing("comparing");
    let (found, done) = compare(&job, &theirs, &reference, registry)?;
    let mut batch = Batch::default();
    batch.stage(&job.out, &png::encode(&picture::draw(&theirs, &found)))?;
    batch.commit()?;
    progress.step();
    drop(progress);
    let files = [FileDocument {
        kind: "comparison",
        path: job.out.display().to_string(),
    }];
    let warnings = warnings(&done, &reference);
    let mut document = document::Document::new(args, &job, &theirs, &found, &files);
    document.warnings = &warnings;
    if args.json {
        output::print_json(&document)?;
    }
    let told = warnings.iter().map(|w| format!("warning: {w}\n"));
    let text = document.text() + &told.collect::<String>();
    output::print_summary(&text, args.json)
}

/// What was found amiss with the scene, and with the truth that is kept.
fn warnings(done: &Rendered, reference: &Reference) -> Vec<String> {
    let scene = done.warnings.iter();
    let scene = scene.map(|w| format!("{}: {}", w.code, w.message));
    let truth = reference.warnings.iter().map(ToString::to_string);
    scene.chain(truth).collect()
}

fn check_size(flag: &'static str, given: Option<[u32; 2]>, file: [u32; 2]) -> Result<(), CliError> {
    match given {
        Some(size) if size != file => Err(CliError::Flag {
            flag,
            value: format!("{}x{}", size[0], size[1]),
            valid: format!(
                "the file of --against has {}x{} pixels; nothing is scaled",
                file[0], file[1]
            ),
        }),
        _ => Ok(()),
    }
}

/// The truth that was given, or that of an oracle.
fn reference(
    job: &CompareJob,
    given: Option<VisibilityImage>,
    progress: &Progress,
) -> Result<Reference, CliError> {
    if let Some(image) = given {
        return Ok(Reference::given(&job.scene, job.light, image)?);
    }
    progress.doing("computing the truth");
    let size = job.settings.size;
    let cache = Some(&job.cache);
    let step = || progress.step();
    Ok(Reference::new(
        &job.scene,
        job.light,
        size,
        job.reference,
        cache,
        &step,
    )?)
}

fn compare(
    job: &CompareJob,
    theirs: &Theirs,
    reference: &Reference,
    registry: &Registry,
) -> Result<(Found, Rendered), CliError> {
    let technique = registry.find(SURFACES)?;
    let params = Params::parse(technique, [format!("light={}", job.light)])?;
    let done = render(&job.scene, technique, &params, &job.settings)?;
    let under: Aligned = reference.under(&done.depth)?;
    let found = match &theirs.content {
        Content::Visibility(values) => Found::of_visibility(&under, values)?,
        Content::Picture(srgb) => {
            let truth = shaded(&job.scene, reference, &under, &params, &job.settings)?;
            Found::of_picture(&under, &truth, srgb)?
        }
    };
    Ok((found, done))
}
