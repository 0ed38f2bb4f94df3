//! Prints commands and writes data.

use std::path::Path;

use gnomon_raster::Recording;
use gnomon_traces::FrameShape;

use super::args::DumpArgs;
use super::document::Line;
use super::images;
use crate::error::CliError;
use crate::output;
use crate::output::files::Batch;
use crate::traces_of_frames::TraceFile;

/// Prints a line for each texture, pass and draw of a frame. Only data needs shaders.
pub(crate) fn run(args: &DumpArgs) -> Result<(), CliError> {
    let file = TraceFile::open(&args.trace)?;
    let shape = file.shape(args.frame)?;
    let mut batch = Batch::default();
    if args.images.is_some() || args.buffers.is_some() {
        let recording = file.frame(args.frame)?;
        if let Some(folder) = &args.images {
            let files = file.drawn(args.frame, || images::draw(&recording))??;
            images::stage(&files, folder, &mut batch)?;
        }
        if let Some(folder) = &args.buffers {
            buffers(&recording, folder, &mut batch)?;
        }
    }
    batch.commit()?;
    output::print(&lines(&shape)?)
}

fn lines(shape: &FrameShape) -> Result<String, CliError> {
    let textures = shape.textures.iter().enumerate();
    let mut all: Vec<Line> = textures.map(|(id, d)| Line::texture(id, d)).collect();
    for (number, pass) in shape.passes.iter().enumerate() {
        all.push(Line::pass(number, pass));
        let draws = pass.draws.iter().enumerate();
        all.extend(draws.map(|(i, draw)| Line::draw(number, i, draw)));
    }
    let mut text = String::new();
    for line in &all {
        text += &serde_json::to_string(line).map_err(|e| CliError::Stdout(e.into()))?;
        text.push('\n');
    }
    Ok(text)
}

fn buffers(recording: &Recording, folder: &Path, batch: &mut Batch) -> Result<(), CliError> {
    for (p, pass) in recording.list.passes.iter().enumerate() {
        for (d, draw) in pass.draws.iter().enumerate() {
            let name = |what: &str| folder.join(format!("pass-{p}-draw-{d}-{what}.bin"));
            if let Some(vertices) = &draw.vertices {
                let bytes = vertices.data.iter().flat_map(|f| f.to_le_bytes());
                batch.stage(&name("vertices"), &bytes.collect::<Vec<u8>>())?;
            }
            if let Some(indices) = &draw.indices {
                let bytes = indices.indices().iter().flat_map(|i| i.to_le_bytes());
                batch.stage(&name("indices"), &bytes.collect::<Vec<u8>>())?;
            }
        }
    }
    Ok(())
}
