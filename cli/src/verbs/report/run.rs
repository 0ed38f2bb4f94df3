//! From the command line to the page.

use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::techniques::Registry;
use gnomon_traces::chrome::chrome;

use super::args::ReportArgs;
use super::measure::{self, Subject};
use super::page;
use crate::error::CliError;
use crate::output::files::{self, Batch};
use crate::output::progress::Progress;
use crate::output::{self, png};

const DEFAULT_SIZE: [u32; 2] = [800, 600];

/// Draws, observes, and writes the page.
pub(crate) fn run(args: &ReportArgs, registry: &Registry) -> Result<(), CliError> {
    files::check_extension("--out", &args.out, "html")?;
    if let Some(path) = &args.chrome {
        files::check_extension("--chrome", path, "json")?;
    }
    let entries = measure::entries(args, registry)?;
    check_chrome(args, entries.len())?;
    let scene = args.scene.open()?.at(args.time)?;
    let settings = RenderSettings {
        size: args.size.or(scene.size).unwrap_or(DEFAULT_SIZE),
        gpu: args.gpu.config(),
        repeat: args.repeat,
    };
    check_pixels(args, settings.size)?;
    png::check_room(settings.size)?;
    let progress = Progress::new(entries.len() as u64 + 1);
    let mut subjects = Vec::new();
    for entry in &entries {
        subjects.push(Subject::new(entry, &scene, &settings, &args.pixels)?);
        progress.step();
    }
    measure::measure_errors(&scene, &settings, &entries, &mut subjects)?;
    progress.step();
    drop(progress);
    let html = page::make(&scene, &settings, &subjects);
    let mut batch = Batch::default();
    batch.stage(&args.out, html.as_bytes())?;
    let mut told = format!(
        "wrote {} (report, {} bytes)\n",
        args.out.display(),
        html.len()
    );
    if let Some(path) = &args.chrome {
        let trace = chrome(&subjects[0].frame, "logical");
        let text = serde_json::to_vec(&trace).map_err(|e| CliError::Stdout(e.into()))?;
        batch.stage(path, &text)?;
        told += &format!("wrote {} (timeline of bytes)\n", path.display());
    }
    batch.commit()?;
    output::print(&told)
}

fn check_chrome(args: &ReportArgs, techniques: usize) -> Result<(), CliError> {
    match &args.chrome {
        Some(path) if techniques > 1 => Err(CliError::Flag {
            flag: "--chrome",
            value: path.display().to_string(),
            valid: "a timeline is of one frame: give one --technique".to_owned(),
        }),
        _ => Ok(()),
    }
}

fn check_pixels(args: &ReportArgs, [width, height]: [u32; 2]) -> Result<(), CliError> {
    let outside = args
        .pixels
        .iter()
        .find(|[x, y]| *x >= width || *y >= height);
    match outside {
        Some([x, y]) => Err(CliError::Flag {
            flag: "--pixel",
            value: format!("{x},{y}"),
            valid: format!(
                "valid are columns 0 to {} and rows 0 to {}",
                width - 1,
                height - 1
            ),
        }),
        None => Ok(()),
    }
}
