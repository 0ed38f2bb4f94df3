//! `gnomon render --frames`: an animation, frame after frame.
//!
//! Frame k shows the time `T + k / F` and has the bits of the single picture of that time.
//! The map of an environment is read once, and what a technique keeps from frame to frame
//! is known by what it was drawn from; everything else of a frame is made for it alone.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::render::{Rendered, render_next_supersampled};
use gnomon_pipeline::technique::KeptPictures;
use gnomon_pipeline::techniques::Registry;
use serde::Serialize;

use super::args::RenderArgs;
use super::job::{self, RenderJob, default_out, distinguished};
use super::write::write;
use crate::documents::{FileDocument, RenderDocument, worker_threads};
use crate::error::CliError;
use crate::output;
use crate::output::files::check_folder;
use crate::output::numbers;
use crate::output::progress::Progress;
use crate::output::tables::{self, Table};
use crate::output::warnings;

#[derive(Serialize)]
struct FramesDocument {
    scene: String,
    technique: &'static str,
    fps: f64,
    frames: Vec<FrameDocument>,
}

#[derive(Serialize)]
struct FrameDocument {
    frame: u32,
    /// Seconds.
    time: f64,
    render: RenderDocument,
}

/// Renders `count` frames.
pub(super) fn run(args: &RenderArgs, registry: &Registry, count: u32) -> Result<(), CliError> {
    check(args)?;
    args.frame.check_times(count)?;
    let technique = args.frame.technique.find(registry)?;
    job::check_wedges(args, technique, registry)?;
    let params = args.frame.params(technique)?;
    args.frame.check_light_fps(&params)?;
    let mut source = args.frame.source()?;
    let progress = Progress::new(u64::from(count) * (2 + args.overlay.len() as u64));
    let mut table = Table::new("Frames", &["frame", "time", "took", "bytes", "color"]);
    let (mut frames, mut last) = (Vec::new(), None);
    let mut kept = KeptPictures::default();
    for frame in 0..count {
        progress.doing(format!("frame {frame}"));
        let time = args.frame.time_of(frame);
        let scene = source.at(time)?;
        let folder = choose_folder(args, &scene.name);
        let out = folder.join(format!("frame-{frame:04}.png"));
        let params = args.frame.params_of(&params, frame);
        let job = RenderJob::of(args, technique, params, scene, Some(out))?;
        let ahead = (args.frame).prepare(technique, &job.params, &job.scene, &progress)?;
        let settings = (&job.settings, job.samples);
        let (scene, params) = (&job.scene, &job.params);
        let draw = || render_next_supersampled(scene, technique, params, settings, &mut kept);
        let mut done = progress.of_step(&format!("frame {frame}"), draw)?;
        done.warnings.extend(ahead);
        progress.step();
        let files = write(&job, args, &done, &progress)?;
        table.rows.push(row(frame, time, &done));
        if args.json {
            frames.push(FrameDocument {
                frame,
                time,
                render: job.document(&done, files.clone()),
            });
        }
        last = Some((job, done, files));
    }
    drop(progress);
    let Some((job, done, files)) = last else {
        return Ok(()); // at least one frame is asked for
    };
    if args.json {
        output::print_json(&FramesDocument {
            scene: job.scene.name.clone(),
            technique: technique.name(),
            fps: args.frame.rate(),
            frames,
        })?;
    }
    output::print_summary(&summarise(&job, &done, &files, &table), args.json)
}

/// A frame of an animation has no place for one array, nor a folder for one name.
fn check(args: &RenderArgs) -> Result<(), CliError> {
    if let Some(visibility) = &args.visibility {
        return Err(CliError::Flag {
            flag: "--visibility",
            value: visibility.display().to_string(),
            valid: "it is of one picture; give --time instead of --frames".to_owned(),
        });
    }
    match &args.out {
        Some(out) if output::is_stdout(out) => Err(CliError::Flag {
            flag: "--out",
            value: "-".to_owned(),
            valid: "stdout holds one picture; give a folder for --frames".to_owned(),
        }),
        Some(out) => check_folder("--out", out),
        None => Ok(()),
    }
}

fn choose_folder(args: &RenderArgs, scene: &str) -> PathBuf {
    let by_default = || folder_of(default_out(scene, &distinguished(args)));
    args.out.clone().unwrap_or_else(by_default)
}

/// The folder that is called like a picture, without what makes that one.
fn folder_of(picture: PathBuf) -> PathBuf {
    let name = picture.to_string_lossy();
    PathBuf::from(name.strip_suffix(".png").unwrap_or(&name))
}

fn row(frame: u32, time: f64, done: &Rendered) -> Vec<String> {
    let bytes = numbers::bytes(tables::frame_bytes(&done.report));
    let hash = done.color_hash()[..16].to_owned();
    vec![
        frame.to_string(),
        format!("{time:.3} s"),
        numbers::milliseconds(done.frame_ms),
        bytes,
        hash,
    ]
}

/// Pictures of an earlier, longer animation in the folder: they would be played with this one.
fn leftover(folder: &Path, count: usize) -> Option<String> {
    let number = |name: &str| {
        let digits = name.strip_prefix("frame-")?.strip_suffix(".png")?;
        digits.parse::<usize>().ok().filter(|n| *n >= count)
    };
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let names = entries.map(|e| e.file_name().to_string_lossy().into_owned());
    let mut old: Vec<String> = names.filter(|n| number(n).is_some()).collect();
    old.sort();
    let (first, last) = (old.first()?, old.last()?);
    Some(format!(
        "leftover-frames: {} pictures of an earlier run, {first} to {last}, are still in {}; \
         remove them before the frames are joined",
        old.len(),
        folder.display()
    ))
}

/// The frames, and the warnings of the last one.
fn summarise(job: &RenderJob, done: &Rendered, files: &[FileDocument], table: &Table) -> String {
    let settings = &job.settings;
    let mut text = format!(
        "{}, {}, {}x{}, {} lights: {} threads, {}, skipping {}\n\n{}",
        job.scene.name,
        job.technique.name(),
        done.size[0],
        done.size[1],
        job.scene.lights.len(),
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        if settings.gpu.skip { "on" } else { "off" },
        table.to_text(),
    );
    for line in warnings::lines(&done.warnings) {
        text += &format!(
            "warning: last frame: {line}
"
        );
    }
    let folder = files.first().and_then(|f| Path::new(&f.path).parent());
    if let Some(folder) = folder {
        if let Some(line) = leftover(folder, table.rows.len()) {
            text += &format!("warning: {line}\n");
        }
        let count = table.rows.len() * files.len();
        text += &format!("wrote {count} files to {}\n", folder.display());
    }
    text
}
