//! How two frames differ as data: textures, passes, draws, field by field.

use gnomon_raster::{Draw, RecordedTexture, Recording, RenderPass};

use super::align::{Pair, align};
use super::facet::{FACETS, pass_parts};

/// One difference between two frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateDifference {
    /// Where it is.
    pub place: Place,
    /// Which field, such as `depth_stencil.stencil.front.pass_op`.
    pub field: String,
    /// What it is in the first frame and in the second; `None` where it is not there.
    pub values: [Option<String>; 2],
    /// Where data differ first, such as `vertex 3, float 1: 0.5 and 0.25`.
    pub at: Option<String>,
}

/// A place in one frame or in both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A texture, by id.
    Texture {
        /// Its id.
        id: usize,
        /// Its label.
        label: String,
    },
    /// A pass.
    Pass {
        /// Its number in the first frame and in the second.
        numbers: [Option<usize>; 2],
        /// Its label.
        label: String,
    },
    /// A draw.
    Draw {
        /// Its pass's number in both frames.
        passes: [usize; 2],
        /// The pass's label.
        pass: String,
        /// Its number in the pass of the first frame and of the second.
        numbers: [Option<usize>; 2],
        /// Its label.
        label: String,
    },
}

/// The passes of two frames side by side, with the draws of those that are in both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Alignment {
    pub(super) passes: Vec<(Pair, Vec<Pair>)>,
}

impl Alignment {
    pub(super) fn of(a: &Recording, b: &Recording) -> Self {
        let labels = |r: &Recording| -> Vec<String> {
            r.list.passes.iter().map(|p| p.label.clone()).collect()
        };
        let pairs = align(&labels(a), &labels(b)).into_iter();
        let passes = pairs.map(|pair| {
            let draws = match pair {
                Pair::Both(i, j) => align_draws(&a.list.passes[i], &b.list.passes[j]),
                Pair::First(_) | Pair::Second(_) => Vec::new(),
            };
            (pair, draws)
        });
        Self {
            passes: passes.collect(),
        }
    }
}

fn align_draws(a: &RenderPass, b: &RenderPass) -> Vec<Pair> {
    let labels =
        |p: &RenderPass| -> Vec<String> { p.draws.iter().map(|d| d.label.clone()).collect() };
    align(&labels(a), &labels(b))
}

/// All differences between the frames of `a` and `b`: of textures, then pass by pass.
/// Shaders are told apart by their identities; those without are taken to be equal.
#[must_use]
pub fn compare_states(a: &Recording, b: &Recording) -> Vec<StateDifference> {
    let mut found = texture_differences(a, b);
    for (pair, draws) in Alignment::of(a, b).passes {
        found.extend(match pair {
            Pair::Both(i, j) => pass_differences([a, b], [i, j], &draws),
            Pair::First(i) => vec![missing_pass(a, i, 0)],
            Pair::Second(j) => vec![missing_pass(b, j, 1)],
        });
    }
    found
}

fn texture_differences(a: &Recording, b: &Recording) -> Vec<StateDifference> {
    let count = a.textures().len().max(b.textures().len());
    let pairs = (0..count).map(|id| (id, [a, b].map(|r| r.textures().get(id))));
    pairs.flat_map(|(id, pair)| one_texture(id, pair)).collect()
}

fn one_texture(id: usize, pair: [Option<&RecordedTexture>; 2]) -> Vec<StateDifference> {
    let label = pair
        .into_iter()
        .flatten()
        .next()
        .map_or("", |t| &t.descriptor().label);
    let at = |field: &str, values| StateDifference {
        place: Place::Texture {
            id,
            label: label.to_owned(),
        },
        field: field.to_owned(),
        values,
        at: None,
    };
    let descriptors = pair.map(|t| t.map(|t| format!("{:?}", t.descriptor())));
    if descriptors[0] != descriptors[1] {
        return vec![at("descriptor", descriptors)];
    }
    let contents = pair.map(|t| t.map(contents_digest));
    if contents[0] != contents[1] {
        return vec![at("contents", contents)];
    }
    Vec::new()
}

fn contents_digest(texture: &RecordedTexture) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut images = 0;
    for (image, bytes) in texture.contents() {
        images += 1;
        hasher.update(&image.mip.to_le_bytes());
        hasher.update(&image.layer.to_le_bytes());
        hasher.update(bytes);
    }
    match images {
        0 => "zeros".to_owned(),
        n => format!("{n} images, {}", &hasher.finalize().to_hex()[..16]),
    }
}

fn missing_pass(of: &Recording, number: usize, side: usize) -> StateDifference {
    let pass = &of.list.passes[number];
    StateDifference {
        place: Place::Pass {
            numbers: on(side, number),
            label: pass.label.clone(),
        },
        field: "pass".to_owned(),
        values: on(side, format!("{} draws", pass.draws.len())),
        at: None,
    }
}

/// A value on one side only.
fn on<T>(side: usize, value: T) -> [Option<T>; 2] {
    match side {
        0 => [Some(value), None],
        _ => [None, Some(value)],
    }
}

fn pass_differences(
    frames: [&Recording; 2],
    numbers: [usize; 2],
    draws: &[Pair],
) -> Vec<StateDifference> {
    let passes = [0, 1].map(|side| &frames[side].list.passes[numbers[side]]);
    let mut found = attachment_differences(passes, numbers);
    for pair in draws {
        found.extend(draw_differences(passes, numbers, *pair));
    }
    found
}

/// What the passes do to their attachments at both ends.
fn attachment_differences(passes: [&RenderPass; 2], numbers: [usize; 2]) -> Vec<StateDifference> {
    let [a, b] = passes.map(pass_parts);
    let names = a
        .keys()
        .chain(b.keys().filter(|name| !a.contains_key(*name)));
    let differing = names.filter(|name| a.get(*name) != b.get(*name));
    differing
        .map(|name| StateDifference {
            place: Place::Pass {
                numbers: numbers.map(Some),
                label: passes[0].label.clone(),
            },
            field: name.clone(),
            values: [a.get(name).cloned(), b.get(name).cloned()],
            at: None,
        })
        .collect()
}

fn draw_differences(
    passes: [&RenderPass; 2],
    numbers: [usize; 2],
    pair: Pair,
) -> Vec<StateDifference> {
    let place = |draws: [Option<usize>; 2], label: &str| Place::Draw {
        passes: numbers,
        pass: passes[0].label.clone(),
        numbers: draws,
        label: label.to_owned(),
    };
    let lone = |side: usize, number: usize| {
        let draw = &passes[side].draws[number];
        vec![StateDifference {
            place: place(on(side, number), &draw.label),
            field: "draw".to_owned(),
            values: on(side, format!("{} vertices", draw.count)),
            at: None,
        }]
    };
    match pair {
        Pair::First(i) => lone(0, i),
        Pair::Second(j) => lone(1, j),
        Pair::Both(i, j) => {
            let (a, b) = (&passes[0].draws[i], &passes[1].draws[j]);
            let place = place([Some(i), Some(j)], &a.label);
            field_differences(a, b, &place)
        }
    }
}

fn field_differences(a: &Draw, b: &Draw, place: &Place) -> Vec<StateDifference> {
    let differing = FACETS.iter().filter_map(|facet| {
        let values = facet.compare(a, b)?;
        Some(StateDifference {
            place: place.clone(),
            field: facet.name.to_owned(),
            values: values.map(Some),
            at: facet.locate(a, b),
        })
    });
    differing.collect()
}
