//! Differences for people.

use gnomon_raster::Format;
use gnomon_traces::history::History;
use gnomon_traces::{AttachmentDifference, FirstDifference, Place, StateDifference};

use super::inputs::Inputs;
use super::run::Differences;
use crate::verbs::pixel::{stored, text as history_text};

/// State differences that are told; JSON lists all.
const TOLD: usize = 24;
/// Characters of a value that are told.
const LONG: usize = 60;

pub(super) fn describe(inputs: &Inputs<'_>, found: &Differences) -> String {
    let [a, b] = [&inputs.sides[0].name, &inputs.sides[1].name];
    if found.none() {
        return format!("{a} and {b} are the same frame: state, every draw, counters\n");
    }
    let mut text = String::new();
    if !found.made.is_empty() {
        text += "made\n";
        for (name, [x, y]) in &found.made {
            text += &format!("  {name}: {} -> {}\n", cut(x.as_deref()), cut(y.as_deref()));
        }
    }
    text += &describe_states(&found.states);
    text += &describe_first(inputs, found.first.as_ref());
    if let Some(histories) = &found.histories {
        text += &describe_histories(inputs, histories);
    }
    if !found.counters.is_empty() {
        text += "counters\n";
        for (name, [x, y]) in &found.counters {
            text += &format!(
                "  {name}: {x} -> {y} ({:+})\n",
                i128::from(*y) - i128::from(*x)
            );
        }
    }
    text
}

fn describe_states(states: &[StateDifference]) -> String {
    if states.is_empty() {
        return "state: equal\n".to_owned();
    }
    let mut text = format!("state: {} differences\n", states.len());
    for difference in states.iter().take(TOLD) {
        text += &format!("  {}\n", state_line(difference));
    }
    if states.len() > TOLD {
        text += &format!("  and {} more (--json lists all)\n", states.len() - TOLD);
    }
    text
}

/// A difference in one line.
pub(crate) fn state_line(difference: &StateDifference) -> String {
    let place = place_text(&difference.place);
    let [x, y] = &difference.values;
    if let Some(at) = &difference.at {
        return format!("{place}: {}: {at}", difference.field);
    }
    match (x, y) {
        (Some(_), None) => format!("{place}: only in the first"),
        (None, Some(_)) => format!("{place}: only in the second"),
        _ => format!(
            "{place}: {}: {} -> {}",
            difference.field,
            cut(x.as_deref()),
            cut(y.as_deref())
        ),
    }
}

/// A value, cut where it is long.
fn cut(value: Option<&str>) -> String {
    let value = value.unwrap_or("none");
    if value.chars().count() <= LONG {
        return value.to_owned();
    }
    value.chars().take(LONG).chain("...".chars()).collect()
}

fn place_text(place: &Place) -> String {
    match place {
        Place::Texture { id, label } => format!("texture {id} `{label}`"),
        Place::Pass { numbers, label } => format!("pass {} `{label}`", number(*numbers)),
        Place::Draw {
            pass,
            numbers,
            label,
            ..
        } => {
            format!("pass `{pass}`, draw {} `{label}`", number(*numbers))
        }
    }
}

/// One number where both are equal.
fn number(numbers: [Option<usize>; 2]) -> String {
    match numbers {
        [Some(a), Some(b)] if a != b => format!("{a} (now {b})"),
        [Some(n), _] | [None, Some(n)] => n.to_string(),
        [None, None] => String::new(),
    }
}

fn describe_first(inputs: &Inputs<'_>, first: Option<&FirstDifference>) -> String {
    let Some(first) = first else {
        return "drawn: equal\n".to_owned();
    };
    let [pass, draw] = &first.labels;
    let numbers = first.draws.map(|d| d.map(|[_, draw]| draw));
    let mut text = format!(
        "drawn: first different after pass `{pass}`, draw {} `{draw}`, in the tile of pixels ({}, {}) to ({}, {})\n",
        number(numbers),
        u32::from(first.tile[0]) * 64,
        u32::from(first.tile[1]) * 64,
        u32::from(first.tile[0]) * 64 + 63,
        u32::from(first.tile[1]) * 64 + 63,
    );
    for (side, place) in first.draws.iter().enumerate() {
        if place.is_none() {
            text += &format!("  {} has no such draw\n", inputs.sides[side].name);
        }
    }
    for attachment in &first.attachments {
        text += &format!("  {}\n", attachment_line(attachment));
    }
    text
}

fn attachment_line(of: &AttachmentDifference) -> String {
    let [x, y] = of.first;
    let values = of.values.map(|v| shown(of.aspect, of.format, v));
    format!(
        "{} of `{}`: {} pixels of the tile, first ({x}, {y}): {} -> {}",
        of.aspect, of.label, of.pixels, values[0], values[1]
    )
}

/// What is stored: channels by their format, one number for depth and stencil.
pub(crate) fn shown(aspect: &str, format: Format, value: [u32; 4]) -> String {
    match aspect {
        "color" => stored(format, value),
        _ => value[0].to_string(),
    }
}

/// What happened to a pixel, in one frame and in the other.
fn describe_histories(inputs: &Inputs<'_>, histories: &[History; 2]) -> String {
    let both = inputs.sides.iter().zip(histories);
    both.map(|(side, history)| {
        let table = history_text(history, inputs.number);
        format!("in {}: {table}", side.name)
    })
    .collect()
}
