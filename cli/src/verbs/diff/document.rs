//! Differences as JSON.

use gnomon_traces::{FirstDifference, Place, StateDifference};
use serde::Serialize;

use super::inputs::Inputs;
use super::run::Differences;
use super::text::shown;
use crate::documents::PixelDocument;

/// What `gnomon diff --json` prints.
#[derive(Serialize)]
pub(super) struct DiffDocument {
    equal: bool,
    files: [String; 2],
    made: Vec<FieldDocument>,
    states: Vec<StateDocument>,
    first: Option<FirstDocument>,
    counters: Vec<CounterDocument>,
    /// Of the first pixel that differs after the first draw that differs, in both.
    #[serde(skip_serializing_if = "Option::is_none")]
    histories: Option<[PixelDocument; 2]>,
}

#[derive(Serialize)]
struct FieldDocument {
    name: String,
    values: [Option<String>; 2],
}

/// A difference of state.
#[derive(Serialize)]
pub(crate) struct StateDocument {
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pass: Option<[Option<usize>; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    draw: Option<[Option<usize>; 2]>,
    label: String,
    field: String,
    values: [Option<String>; 2],
    at: Option<String>,
}

#[derive(Serialize)]
struct FirstDocument {
    /// Pass and draw in both.
    draws: [Option<[usize; 2]>; 2],
    pass: String,
    draw: String,
    tile: [u16; 2],
    attachments: Vec<AttachmentDocument>,
}

#[derive(Serialize)]
struct AttachmentDocument {
    label: String,
    aspect: &'static str,
    pixels: usize,
    first: [u32; 2],
    format: String,
    /// Raw channels in both.
    values: [[u32; 4]; 2],
    /// What they mean.
    shown: [String; 2],
}

#[derive(Serialize)]
struct CounterDocument {
    name: String,
    values: [u64; 2],
}

impl DiffDocument {
    pub(super) fn new(inputs: &Inputs<'_>, found: &Differences) -> Self {
        let made = found.made.iter().cloned();
        let counters = found.counters.iter().cloned();
        Self {
            equal: found.none(),
            files: [0, 1].map(|side| inputs.sides[side].name.clone()),
            made: made
                .map(|(name, values)| FieldDocument { name, values })
                .collect(),
            states: found.states.iter().map(StateDocument::new).collect(),
            first: found.first.as_ref().map(FirstDocument::new),
            histories: found.histories.as_ref().map(|both| {
                let [a, b] = both;
                [a, b].map(|h| PixelDocument::new(h, inputs.number))
            }),
            counters: counters
                .map(|(name, values)| CounterDocument { name, values })
                .collect(),
        }
    }
}

impl StateDocument {
    pub(crate) fn new(of: &StateDifference) -> Self {
        let (texture, pass, draw, label) = match &of.place {
            Place::Texture { id, label } => (Some(*id), None, None, label),
            Place::Pass { numbers, label } => (None, Some(*numbers), None, label),
            Place::Draw {
                passes,
                numbers,
                label,
                ..
            } => (None, Some(passes.map(Some)), Some(*numbers), label),
        };
        Self {
            texture,
            pass,
            draw,
            label: label.clone(),
            field: of.field.clone(),
            values: of.values.clone(),
            at: of.at.clone(),
        }
    }
}

impl FirstDocument {
    fn new(of: &FirstDifference) -> Self {
        let attachments = of.attachments.iter().map(|a| AttachmentDocument {
            label: a.label.clone(),
            aspect: a.aspect,
            pixels: a.pixels,
            first: a.first,
            format: format!("{:?}", a.format),
            shown: a.values.map(|v| shown(a.aspect, a.format, v)),
            values: a.values,
        });
        Self {
            draws: of.draws,
            pass: of.labels[0].clone(),
            draw: of.labels[1].clone(),
            tile: of.tile,
            attachments: attachments.collect(),
        }
    }
}
