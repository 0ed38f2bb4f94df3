//! A recorded frame as the subject of a page.

use std::path::Path;

use gnomon_pipeline::measure::render::{SrgbEncoder, hash};
use gnomon_raster::{Gpu, Recording, Subresource, TextureId};
use gnomon_traces::Meta;

use super::args::ReportArgs;
use super::measure::{Observe, Subject, refuse_gpu};
use crate::draw::Picture;
use crate::error::CliError;
use crate::traces_of_frames::TraceFile;

/// Whether the page is of a recorded frame.
pub(super) fn is_trace(args: &ReportArgs) -> bool {
    let extension = Path::new(&args.scene.scene).extension();
    extension.is_some_and(|e| e.eq_ignore_ascii_case("gnt"))
}

/// What a trace has chosen already cannot be chosen again.
fn check(args: &ReportArgs) -> Result<(), CliError> {
    let chosen = [
        ("--technique", !args.techniques.is_empty()),
        ("--size", args.size.is_some()),
        ("--time", args.time != 0.0),
    ];
    match chosen.into_iter().find(|(_, given)| *given) {
        Some((flag, _)) => Err(CliError::Flag {
            flag,
            value: args.scene.scene.clone(),
            valid: "a trace was recorded with it; leave it out".to_owned(),
        }),
        None => Ok(()),
    }
}

/// The frame that `args` name: its scene's name, and what the page shows of it.
pub(super) fn subject(args: &ReportArgs, how: &Observe<'_>) -> Result<(String, Subject), CliError> {
    check(args)?;
    let file = TraceFile::open(Path::new(&args.scene.scene))?;
    let recording = file.frame(args.frame)?;
    let image = output(&recording)?;
    let (picture, ms) = file.drawn(args.frame, || draw(&recording, image, how))??;
    let meta = file.trace().meta();
    let observe = || Subject::observe(label(meta, args.frame), &recording, image, how);
    let mut subject = file.drawn(args.frame, observe)??;
    let bytes = picture.pixels.iter().flatten().copied();
    subject.hashes = vec![
        ("Picture".to_owned(), hash(picture.size, bytes)),
        ("Trace".to_owned(), file.named(file.trace().id())?),
        ("Recorded settings".to_owned(), recorded_settings(meta)),
    ];
    subject.picture = picture;
    subject.frame_ms = ms;
    Ok((meta.scene.clone(), subject))
}

fn label(meta: &Meta, frame: usize) -> String {
    let name = match meta.technique.is_empty() {
        true => "recorded",
        false => &meta.technique,
    };
    format!("{name}, frame {frame}")
}

fn recorded_settings(meta: &Meta) -> String {
    let settings = meta.params.iter().map(|(k, v)| format!("{k}={v}"));
    settings.collect::<Vec<_>>().join(" ")
}

/// The picture: the result called `color`, or else what the last pass draws to.
fn output(recording: &Recording) -> Result<TextureId, CliError> {
    let last = recording.list.passes.last().and_then(|p| p.color.first());
    let found = recording.output("color").or(last.map(|a| a.texture));
    found.ok_or(CliError::History(
        gnomon_traces::history::HistoryError::NotDrawn,
    ))
}

/// Draws the frame, and reads it back as `render` does.
fn draw(
    recording: &Recording,
    image: TextureId,
    how: &Observe<'_>,
) -> Result<(Picture, f64), CliError> {
    let read = || {
        let mut gpu = Gpu::new(how.settings.gpu)?;
        gpu.load(recording)?;
        let start = std::time::Instant::now();
        gpu.submit(&recording.list)?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let texture = gpu.texture(image)?;
        let [width, height, _] = texture.descriptor().size;
        let texels = texture.read_color(Subresource::default())?;
        Ok(([width, height], texels, ms))
    };
    let (size, texels, ms) = read().map_err(refuse_gpu)?;
    let encoder = SrgbEncoder::new();
    let pixels = texels.iter().map(|t| encoder.encode(t.0)).collect();
    Ok((Picture { size, pixels }, ms))
}
