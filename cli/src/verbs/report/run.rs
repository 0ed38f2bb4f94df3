//! From the command line to the page.

use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::techniques::Registry;
use gnomon_traces::chrome::{ChromeTrace, chrome};
use gnomon_traces::profile::Profile;

use super::args::ReportArgs;
use super::measure::{self, Observe, Subject};
use super::{page, trace};
use crate::error::CliError;
use crate::flags::DEFAULT_SIZE;
use crate::output::files::{self, Batch};
use crate::output::progress::Progress;
use crate::output::{self, png};

/// Draws, observes, and writes the page.
pub(crate) fn run(args: &ReportArgs, registry: &Registry) -> Result<(), CliError> {
    files::check_extension("--out", &args.out, "html")?;
    if let Some(path) = &args.chrome {
        files::check_extension("--chrome", path, "json")?;
    }
    let profiles = measure::profiles(args)?;
    let (scene, subjects) = match trace::is_trace(args) {
        true => of_trace(args, &profiles)?,
        false => of_scene(args, registry, &profiles)?,
    };
    let html = page::make(&scene, &args.gpu.config(), args.repeat, &subjects);
    let mut batch = Batch::default();
    batch.stage(&args.out, html.as_bytes())?;
    let mut told = format!(
        "wrote {} (report, {} bytes)\n",
        args.out.display(),
        html.len()
    );
    if let Some(path) = &args.chrome {
        let trace = timeline(&subjects[0]);
        let text = serde_json::to_vec(&trace).map_err(|e| CliError::Stdout(e.into()))?;
        batch.stage(path, &text)?;
        told += &format!("wrote {} (timeline of bytes)\n", path.display());
    }
    batch.commit()?;
    output::print(&told)
}

/// The name of the recorded scene, and its frame.
fn of_trace(args: &ReportArgs, profiles: &[Profile]) -> Result<(String, Vec<Subject>), CliError> {
    let settings = RenderSettings {
        size: DEFAULT_SIZE,
        gpu: args.gpu.config(),
        repeat: 1,
    };
    let how = Observe {
        settings: &settings,
        profiles,
        pixels: &args.pixels,
    };
    let (name, subject) = trace::subject(args, &how)?;
    Ok((name, vec![subject]))
}

/// The name of the scene, and its frame by each technique.
fn of_scene(
    args: &ReportArgs,
    registry: &Registry,
    profiles: &[Profile],
) -> Result<(String, Vec<Subject>), CliError> {
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
    let how = Observe {
        settings: &settings,
        profiles,
        pixels: &args.pixels,
    };
    let progress = Progress::new(entries.len() as u64 + 1);
    let mut subjects = Vec::new();
    for entry in &entries {
        subjects.push(Subject::of_scene(entry, &scene, &how)?);
        progress.step();
    }
    measure::measure_errors(&scene, &settings, &entries, &mut subjects)?;
    progress.step();
    Ok((scene.name, subjects))
}

/// Along the bytes of the first profile, or else along logical ones.
fn timeline(subject: &Subject) -> ChromeTrace {
    match subject.judged.first() {
        Some(judged) => chrome(&judged.frame, &format!("{} DRAM", judged.profile)),
        None => chrome(&subject.frame, "logical"),
    }
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
