//! Says what is in a trace.

use super::args::InfoArgs;
use crate::documents::TraceDocument;
use crate::error::CliError;
use crate::output::{self, numbers};
use crate::traces_of_frames::TraceFile;

/// Prints what the trace says and holds.
pub(crate) fn run(args: &InfoArgs) -> Result<(), CliError> {
    let file = TraceFile::open(&args.trace)?;
    let document = file.named(TraceDocument::new(&args.trace, file.trace()))?;
    match args.json {
        true => output::print_json(&document),
        false => output::print(&text(&document)),
    }
}

fn text(d: &TraceDocument) -> String {
    let [w, h] = d.meta.size;
    let mut text = format!(
        "{}: {}, {}\nid {}\nby {}: {} {} {w}x{h}\n",
        d.file,
        contents(d),
        numbers::bytes(d.bytes),
        d.id,
        d.meta.producer,
        d.meta.scene,
        d.meta.technique,
    );
    for (key, value) in &d.meta.params {
        text += &format!("  {key}={value}\n");
    }
    for (number, frame) in d.contents.iter().enumerate() {
        text += &format!("frame {number}: {} textures\n", frame.textures);
        for pass in &frame.passes {
            let (draws, attachments) = (pass.draws, pass.attachments);
            text += &format!(
                "  {}: {draws} draws, {attachments} attachments\n",
                pass.name
            );
        }
        text += &format!("  shaders: {}\n", frame.shaders.join(", "));
    }
    if let Some(lost) = &d.lost {
        text += &format!("warning: {lost}\n");
    }
    text
}

/// Numbers of frames, passes, draws and events.
pub(crate) fn contents(document: &TraceDocument) -> String {
    let frames = &document.contents;
    let passes = frames.iter().flat_map(|f| &f.passes);
    let draws: usize = passes.clone().map(|p| p.draws).sum();
    let events: Option<u64> = frames.iter().map(|f| f.events).sum();
    let events = match events {
        Some(n) => format!(", {} events", numbers::count(n)),
        None => ", no traffic".to_owned(),
    };
    format!(
        "{} frame{}, {} passes, {} draws{events}",
        frames.len(),
        if frames.len() == 1 { "" } else { "s" },
        numbers::count(passes.count() as u64),
        numbers::count(draws as u64),
    )
}
