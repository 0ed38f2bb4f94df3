//! Compares two frames: how they were made, as data, in what they draw, in what they count.

use gnomon_raster::{GpuConfig, SubmitReport};
use gnomon_traces::history::{self, History};
use gnomon_traces::{
    DrawHashes, FirstDifference, StateDifference, compare_states, first_difference,
};

use super::args::DiffArgs;
use super::document::DiffDocument;
use super::inputs::Inputs;
use super::text;
use crate::error::CliError;
use crate::output;

/// All that two frames differ in.
pub(super) struct Differences {
    /// Settings: name, and the value in both.
    pub(super) made: Vec<(String, [Option<String>; 2])>,
    pub(super) states: Vec<StateDifference>,
    pub(super) first: Option<FirstDifference>,
    /// Sums over the frame: name, and the figure in both.
    pub(super) counters: Vec<(String, [u64; 2])>,
    /// What happened in both to the first pixel that differs after that draw.
    pub(super) histories: Option<[History; 2]>,
}

impl Differences {
    pub(super) fn none(&self) -> bool {
        self.made.is_empty()
            && self.states.is_empty()
            && self.first.is_none()
            && self.counters.is_empty()
    }
}

/// Says what differs; that anything does is exit code 1.
pub(crate) fn run(args: &DiffArgs) -> Result<(), CliError> {
    let inputs = Inputs::open(&args.a, &args.b, args.frame)?;
    let found = compare(&inputs, args.gpu.config())?;
    if args.json {
        output::print_json(&DiffDocument::new(&inputs, &found))?;
    } else {
        output::print(&text::describe(&inputs, &found))?;
    }
    if found.none() {
        Ok(())
    } else {
        Err(CliError::Differs)
    }
}

fn compare(inputs: &Inputs<'_>, config: GpuConfig) -> Result<Differences, CliError> {
    let frames = inputs.frames();
    let measure = |side: usize| inputs.drawn(side, || DrawHashes::measure(frames[side], config));
    let (a, report_a) = measure(0)??;
    let (b, report_b) = measure(1)??;
    let first = first_difference(frames, [&a, &b], config)?;
    let histories = match &first {
        Some(first) => histories(inputs, first, config)?,
        None => None,
    };
    Ok(Differences {
        made: differing_settings(inputs),
        states: compare_states(frames[0], frames[1]),
        histories,
        first,
        counters: differing_figures(&[figures(&report_a), figures(&report_b)]),
    })
}

/// What happened to the first pixel that differs; nothing where a draw is in one frame only.
fn histories(
    inputs: &Inputs<'_>,
    first: &FirstDifference,
    config: GpuConfig,
) -> Result<Option<[History; 2]>, CliError> {
    let Some(at) = first.attachments.first() else {
        return Ok(None);
    };
    let follow = |side: usize| {
        let frame = &inputs.sides[side].frame;
        let pixel = || history::pixel_of(frame, config, at.images[side], at.first);
        Ok::<_, CliError>(inputs.drawn(side, pixel)??)
    };
    Ok(Some([follow(0)?, follow(1)?]))
}

/// Fragments by their end, and bytes by client, of a whole frame.
fn figures(report: &SubmitReport) -> Vec<(String, u64)> {
    let mut sum = gnomon_raster::Counters::default();
    report.passes.iter().for_each(|p| sum.add(&p.totals()));
    let f = sum.fragments;
    let mut all: Vec<(String, u64)> = [
        ("primitives", sum.primitives.input),
        ("fragments", f.generated),
        ("fragments killed by zmin/zmax", f.hiz_killed),
        ("fragments failed in bounds", f.bounds_failed),
        ("fragments failed in stencil", f.stencil_failed),
        ("fragments failed in depth", f.depth_failed),
        ("fragments discarded", f.discarded),
        ("fragments written", f.written),
    ]
    .map(|(name, n)| (name.to_owned(), n))
    .into();
    for (client, traffic) in sum.traffic.named() {
        all.push((format!("bytes of {client} read"), traffic.read_bytes));
        all.push((format!("bytes of {client} written"), traffic.write_bytes));
    }
    all
}

fn differing_figures([a, b]: &[Vec<(String, u64)>; 2]) -> Vec<(String, [u64; 2])> {
    let of = |all: &[(String, u64)], name: &str| {
        all.iter()
            .find(|(n, _)| n == name)
            .map_or(0, |(_, value)| *value)
    };
    let names = a.iter().chain(
        b.iter()
            .filter(|(name, _)| !a.iter().any(|(n, _)| n == name)),
    );
    let pairs = names.map(|(name, _)| (name.clone(), [of(a, name), of(b, name)]));
    pairs.filter(|(_, [x, y])| x != y).collect()
}

/// What the traces say of how they were made.
fn differing_settings(inputs: &Inputs<'_>) -> Vec<(String, [Option<String>; 2])> {
    let [a, b] = [0, 1].map(|side| {
        let meta = &inputs.sides[side].meta;
        let mut all = meta.params.clone();
        all.insert("scene".to_owned(), meta.scene.clone());
        all.insert("technique".to_owned(), meta.technique.clone());
        all.insert(
            "size".to_owned(),
            format!("{}x{}", meta.size[0], meta.size[1]),
        );
        all.insert("time".to_owned(), meta.time.to_string());
        all
    });
    let names = a
        .keys()
        .chain(b.keys().filter(|name| !a.contains_key(*name)));
    let pairs = names.map(|name| (name.clone(), [a.get(name).cloned(), b.get(name).cloned()]));
    pairs.filter(|(_, [x, y])| x != y).collect()
}
