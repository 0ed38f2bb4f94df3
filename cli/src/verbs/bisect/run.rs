//! Finds the cause and says it.

use gnomon_traces::{Cause, bisect};
use serde::Serialize;

use super::args::BisectArgs;
use crate::error::CliError;
use crate::output;
use crate::verbs::diff::text::{shown, state_line};
use crate::verbs::diff::{Inputs, StateDocument};

/// What `gnomon bisect --json` prints.
#[derive(Serialize)]
struct CauseDocument {
    texture: String,
    aspect: &'static str,
    pixel: [u32; 2],
    format: String,
    /// Raw channels in both.
    values: [[u32; 4]; 2],
    /// What they mean.
    shown: [String; 2],
    cause: Vec<StateDocument>,
    of: usize,
    replays: usize,
}

/// Says which differences make the first pixel that differs differ.
pub(crate) fn run(args: &BisectArgs) -> Result<(), CliError> {
    let inputs = Inputs::open(&args.a, &args.b, args.frame)?;
    let [a, b] = inputs.frames();
    let search = || bisect(a, b, args.by.suspects(), args.gpu.config());
    let cause = inputs.drawn(0, search)??;
    if args.json {
        return output::print_json(&document(&cause));
    }
    output::print(&describe(&inputs, &cause))
}

fn document(cause: &Cause) -> CauseDocument {
    CauseDocument {
        texture: cause.pixel.label.clone(),
        aspect: cause.pixel.aspect,
        pixel: cause.pixel.pixel,
        format: format!("{:?}", cause.pixel.format),
        values: cause.pixel.values,
        shown: (cause.pixel.values).map(|v| shown(cause.pixel.aspect, cause.pixel.format, v)),
        cause: cause.differences.iter().map(StateDocument::new).collect(),
        of: cause.of,
        replays: cause.replays,
    }
}

fn describe(inputs: &Inputs<'_>, cause: &Cause) -> String {
    let at = &cause.pixel;
    let [from, to] = at.values.map(|v| shown(at.aspect, at.format, v));
    let [x, y] = at.pixel;
    let [a, b] = [&inputs.sides[0].name, &inputs.sides[1].name];
    let mut text = format!(
        "pixel ({x}, {y}), {} of `{}`: {from} in {a}, {to} in {b}\n\
         {} of {} differences make it so ({} replays):\n",
        at.aspect,
        at.label,
        cause.differences.len(),
        cause.of,
        cause.replays,
    );
    for difference in &cause.differences {
        text += &format!("  {}\n", state_line(difference));
    }
    text
}
