//! Writes pictures and arrays of a render.

use std::path::Path;

use gnomon_pipeline::measure::render::Rendered;

use super::args::RenderArgs;
use super::job::RenderJob;
use super::show::show;
use crate::documents::FileDocument;
use crate::error::CliError;
use crate::output::files::Batch;
use crate::output::png_text::{About, software, with_text};
use crate::output::progress::Progress;
use crate::output::{is_stdout, npy, png, textures, write_stdout};
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
    let about = about(job, done);
    let told = |picture| with_text(&png::encode(&picture), &about);
    let to_stdout = is_stdout(&job.out);
    let is_exr = (job.out.extension()).is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    let picture = match is_exr {
        true => linear(done),
        false => told(overlay::picture(done)),
    };
    if !to_stdout {
        stage("render", &job.out, &picture)?;
    }
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
        stage(kind.name(), path, &told(overlay::draw(*kind, &source)))?;
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
    if to_stdout {
        write_stdout(&picture)?;
    }
    Ok(written)
}

/// What pictures say of themselves: nothing of the machine, so that equal ones are equal
/// files.
fn about(job: &RenderJob, done: &Rendered) -> About {
    let params = job
        .params
        .iter()
        .map(|(key, value)| format!("{key}={value}"));
    vec![
        software(),
        ("Scene", job.scene.name.clone()),
        ("Technique", job.technique.name().to_owned()),
        ("Parameters", params.collect::<Vec<_>>().join(" ")),
        ("Color hash", done.color_hash()),
        ("Visibility hash", done.visibility_hash()),
    ]
}

/// Linear light in 32-bit floats.
fn linear(done: &Rendered) -> Vec<u8> {
    textures::exr(&textures::Values {
        size: done.size,
        channels: 3,
        numbers: done.color.iter().flatten().map(|c| f64::from(*c)).collect(),
    })
}
