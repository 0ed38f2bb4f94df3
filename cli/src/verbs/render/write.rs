//! Writes pictures and arrays of a render.

use std::path::Path;

use gnomon_pipeline::measure::render::Rendered;

use super::args::RenderArgs;
use super::job::RenderJob;
use super::show::show;
use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::json::FileDocument;
use crate::output::progress::Progress;
use crate::output::{npy, png};
use crate::overlay;

/// Draws and writes everything that was asked for, or nothing.
pub(super) fn write(
    job: &RenderJob,
    args: &RenderArgs,
    done: &Rendered,
    progress: &Progress,
) -> Result<Vec<FileDocument>, CliError> {
    let mut batch = Batch::default();
    let mut written = Vec::new();
    let mut stage = |kind, path: &Path, bytes: &[u8]| {
        written.push(FileDocument {
            kind,
            path: path.display().to_string(),
        });
        batch.stage(path, bytes)
    };
    progress.doing("writing");
    png::check_room(done.size)?;
    stage("render", &job.out, &png::encode(&overlay::picture(done)))?;
    if let Some(path) = &args.visibility {
        stage(
            "visibility",
            path,
            &npy::encode(done.size, &done.visibility),
        )?;
    }
    progress.step();
    let heat = job.heat()?;
    let carries = job.carries()?;
    let wedges = job.wedges()?;
    let source = overlay::Source {
        scene: &job.scene,
        params: &job.params,
        done,
        heat: heat.as_ref(),
        carries: carries.as_ref(),
        wedges: wedges.as_ref(),
    };
    for (kind, path) in &job.overlays {
        progress.doing(format!("drawing {}", kind.name()));
        stage(
            kind.name(),
            path,
            &png::encode(&overlay::draw(*kind, &source)),
        )?;
        progress.step();
    }
    if !args.show.is_empty() {
        let frame = (job.technique).frame(&job.scene, job.settings.size, &job.params)?;
        for request in &args.show {
            progress.doing(format!("showing {}", request.text()));
            let bytes = show(&frame.recording, request, job.settings.gpu)?;
            stage("show", &request.path(&job.out)?, &bytes)?;
        }
    }
    batch.commit()?;
    Ok(written)
}
