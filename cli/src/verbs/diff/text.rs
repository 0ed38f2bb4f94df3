//! Differences for people.

use gnomon_traces::{AttachmentDifference, FirstDifference, Place, StateDifference};

use super::inputs::Inputs;
use super::run::Differences;

/// State differences that are told; JSON lists all.
const TOLD: usize = 24;
/// Characters of a value that are told.
const LONG: usize = 60;

pub(super) fn describe(inputs: &Inputs, found: &Differences) -> String {
    let [a, b] = [&inputs.sides[0].name, &inputs.sides[1].name];
    if found.none() {
        return format!("{a} and {b} are the same frame: state, every draw, counters\n");
    }
    let mut text = String::new();
    if !found.made.is_empty() {
        text += "made\n";
        for (name, [x, y]) in &found.made {
            text += &format!(
                "  {name}: {} -> {}\n",
                shown(x.as_deref()),
                shown(y.as_deref())
            );
        }
    }
    text += &describe_states(&found.states);
    text += &describe_first(inputs, found.first.as_ref());
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
            shown(x.as_deref()),
            shown(y.as_deref())
        ),
    }
}

/// A value, cut where it is long.
fn shown(value: Option<&str>) -> String {
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

fn describe_first(inputs: &Inputs, first: Option<&FirstDifference>) -> String {
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
    let values = of.values.map(|v| raw(of.aspect, v));
    format!(
        "{} of `{}`: {} pixels of the tile, first ({x}, {y}): {} -> {}",
        of.aspect, of.label, of.pixels, values[0], values[1]
    )
}

/// Raw channels: one number for depth and stencil.
pub(crate) fn raw(aspect: &str, value: [u32; 4]) -> String {
    match aspect {
        "color" => format!("{value:?}"),
        _ => value[0].to_string(),
    }
}
