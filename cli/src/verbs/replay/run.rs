//! Replays and says what differs.

use gnomon_traces::{ReplayDepth, Replayed, replay};

use super::args::ReplayArgs;
use super::picture::picture;
use crate::error::CliError;
use crate::output::files::{Batch, check_extension};
use crate::output::{self, numbers, png};
use crate::traces_of_frames::TraceFile;

/// Replays one frame or all; a difference is an error of its own.
pub(crate) fn run(args: &ReplayArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        check_extension("--out", out, "png")?;
    }
    let file = TraceFile::open(&args.trace)?;
    let trace = file.trace();
    let frames = match args.frame {
        Some(frame) => frame..frame.saturating_add(1),
        None => 0..trace.frames(),
    };
    if args.out.is_some() && frames.len() > 1 {
        return Err(CliError::Flag {
            flag: "--out",
            value: "one file".to_owned(),
            valid: format!(
                "the trace has {} frames: say which with --frame",
                frames.len()
            ),
        });
    }
    let table = gnomon_shaders::table();
    let depth = match args.deep {
        true => ReplayDepth::Draws,
        false => ReplayDepth::Ends,
    };
    let mut text = String::new();
    for frame in frames.clone() {
        let replayed = replay(trace, frame, &table, args.gpu.config(), depth);
        let replayed = file.named(replayed)?;
        write(args, &replayed, frame)?;
        let name = match frames.len() {
            1 => String::new(),
            _ => format!("frame {frame}: "),
        };
        if let Some(difference) = &replayed.difference {
            return Err(CliError::ReplayDiffers(format!("{name}{difference}")));
        }
        text += &format!("{name}{}\n", equal(&replayed));
    }
    if let Some(lost) = trace.lost() {
        text += &format!("warning: {lost}\n");
    }
    output::print(&text)
}

fn equal(replayed: &Replayed) -> String {
    let passes = &replayed.recording.list.passes;
    let draws: usize = passes.iter().map(|p| p.draws.len()).sum();
    let compared = match replayed.draws {
        0 => String::new(),
        n => format!(" and what {} draws left", numbers::count(n as u64)),
    };
    format!(
        "{} passes, {} draws: all {} attachments{compared} equal",
        passes.len(),
        numbers::count(draws as u64),
        replayed.attachments,
    )
}

/// The picture is written whether it differs or not: one wants to see how.
fn write(args: &ReplayArgs, replayed: &Replayed, frame: usize) -> Result<(), CliError> {
    let Some(out) = &args.out else {
        return Ok(());
    };
    let mut batch = Batch::default();
    batch.stage(out, &png::encode(&picture(replayed, frame)?))?;
    batch.commit()
}
