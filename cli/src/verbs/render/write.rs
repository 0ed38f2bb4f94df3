//! Writes pictures and arrays of a render.

use std::path::{Path, PathBuf};

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::Recording;

use super::args::RenderArgs;
use super::job::RenderJob;
use super::show::{ShowRequest, check_show, show};
use crate::documents::FileDocument;
use crate::draw::Picture;
use crate::error::CliError;
use crate::output::png_text::{About, software, with_text};
use crate::output::progress::Progress;
use crate::output::sequence::Sequence;
use crate::output::{is_stdout, npy, png, textures, write_stdout};
use crate::overlay::{self, Recorded};

/// Draws what was asked for, and writes each file as it is done: the frame before what
/// explains it. What cannot be drawn is refused before anything is written.
pub(super) fn write(
    job: &RenderJob,
    args: &RenderArgs,
    done: &Rendered,
    progress: &Progress,
) -> Result<Vec<FileDocument>, CliError> {
    progress.doing("writing");
    png::check_room(done.size)?;
    job.check_carries()?;
    let shows = Shows::new(job, args)?;
    let mut files = Files::new(job, args, &shows)?;
    files.write_frame(job, args, done)?;
    progress.step();
    let mut recorded = Recorded::default();
    for (kind, path) in &job.overlays {
        progress.doing(format!("drawing {}", kind.name()));
        recorded.add(*kind, job.explained())?;
        let source = recorded.source(&job.scene, &job.params, done);
        let picture = overlay::draw(*kind, &source);
        let bytes = png_of(&picture, &job.scene, &job.params, (done, job.samples));
        files.put(kind.name(), path, &bytes)?;
        progress.step();
    }
    for (request, path) in &shows.requests {
        progress.doing(format!("showing {}", request.text()));
        let bytes = show(&shows.recording, request, job.settings.gpu)?;
        files.put("show", path, &bytes)?;
    }
    Ok(files.written)
}

/// Files on their way to their places.
struct Files {
    sequence: Sequence,
    written: Vec<FileDocument>,
}

impl Files {
    fn new(job: &RenderJob, args: &RenderArgs, shows: &Shows<'_>) -> Result<Self, CliError> {
        let frame = Some(job.out.as_path()).filter(|out| !is_stdout(out));
        let overlays = job.overlays.iter().map(|(_, path)| path.as_path());
        let shown = shows.requests.iter().map(|(_, path)| path.as_path());
        let all = (frame.into_iter().chain(args.visibility.as_deref()))
            .chain(overlays)
            .chain(shown);
        Ok(Self {
            sequence: Sequence::new(all)?,
            written: Vec::new(),
        })
    }

    fn put(&mut self, kind: &'static str, path: &Path, bytes: &[u8]) -> Result<(), CliError> {
        self.sequence.put(path, bytes)?;
        self.written.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
        Ok(())
    }

    /// The picture and its visibility.
    fn write_frame(
        &mut self,
        job: &RenderJob,
        args: &RenderArgs,
        done: &Rendered,
    ) -> Result<(), CliError> {
        let is_exr = (job.out.extension()).is_some_and(|e| e.eq_ignore_ascii_case("exr"));
        let picture = match is_exr {
            true => linear(done),
            false => {
                let picture = overlay::picture(done);
                png_of(&picture, &job.scene, &job.params, (done, job.samples))
            }
        };
        match is_stdout(&job.out) {
            true => write_stdout(&picture)?,
            false => self.put("render", &job.out, &picture)?,
        }
        if let Some(path) = &args.visibility {
            let array = npy::encode(done.size, &done.visibility);
            self.put("visibility", path, &array)?;
        }
        Ok(())
    }
}

/// Buffers to show, and the frame that they are of.
struct Shows<'a> {
    recording: Recording,
    requests: Vec<(&'a ShowRequest, PathBuf)>,
}

impl<'a> Shows<'a> {
    /// What was asked for, checked.
    fn new(job: &RenderJob, args: &'a RenderArgs) -> Result<Self, CliError> {
        let mut shows = Self {
            recording: Recording::default(),
            requests: Vec::new(),
        };
        if args.show.is_empty() {
            return Ok(shows);
        }
        let frame = (job.technique).frame(&job.scene, job.settings.size, &job.params)?;
        shows.recording = frame.recording;
        for request in &args.show {
            check_show(&shows.recording, request)?;
            shows.requests.push((request, request.path(&job.out)?));
        }
        Ok(shows)
    }
}

/// A picture of a frame, of so many samples along a pixel's side, as `render` writes it.
pub(crate) fn png_of(
    picture: &Picture,
    scene: &Scene,
    params: &Params,
    done: (&Rendered, u32),
) -> Vec<u8> {
    with_text(&png::encode(picture), &about(scene, params, done))
}

/// What pictures say of themselves: nothing of the machine, so that equal ones are equal
/// files.
fn about(scene: &Scene, params: &Params, (done, samples): (&Rendered, u32)) -> About {
    let given = params.iter().map(|(key, value)| format!("{key}={value}"));
    let mut about = vec![
        software(),
        ("Scene", scene.name.clone()),
        ("Technique", params.technique().to_owned()),
        ("Parameters", given.collect::<Vec<_>>().join(" ")),
        ("Color hash", done.color_hash()),
        ("Visibility hash", done.visibility_hash()),
    ];
    if samples > 1 {
        about.push(("Supersample", samples.to_string()));
    }
    about
}

/// Linear light in 32-bit floats.
fn linear(done: &Rendered) -> Vec<u8> {
    textures::exr(&textures::Values {
        size: done.size,
        channels: 3,
        numbers: done.color.iter().flatten().map(|c| f64::from(*c)).collect(),
    })
}
