//! Where two frames first differ.

use crate::measure::{Draw, Frame, Pass};

/// The first difference, in the order in which a frame is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Difference {
    /// What differs, in words.
    pub(crate) lines: Vec<String>,
    /// The first tile that does: column and row.
    pub(crate) tile: Option<[u32; 2]>,
}

/// Compares a golden with a frame.
pub(crate) fn first_difference(expected: &Frame, actual: &Frame) -> Difference {
    let mut found = Difference::default();
    for (e, a) in expected.images.iter().zip(&actual.images) {
        if e != a {
            found.lines.push(format!(
                "image {}: hash {} expected, {} found",
                a.what, e.hash, a.hash
            ));
        }
    }
    if expected.initial != actual.initial {
        found
            .lines
            .push("textures before the first pass are others".to_owned());
    }
    if expected.images.len() != actual.images.len() {
        found.lines.push(format!(
            "{} attached images expected, {} found",
            expected.images.len(),
            actual.images.len()
        ));
    }
    let passes = expected.passes.iter().zip(&actual.passes).enumerate();
    for (number, (e, a)) in passes {
        if e != a {
            in_pass(number, e, a, &mut found);
            return found;
        }
    }
    if expected.passes.len() != actual.passes.len() {
        found.lines.push(format!(
            "{} passes expected, {} found",
            expected.passes.len(),
            actual.passes.len()
        ));
    } else {
        found.lines.push("no draw differs".to_owned());
    }
    found
}

fn in_pass(number: usize, e: &Pass, a: &Pass, found: &mut Difference) {
    let label = &a.label;
    if e.targets != a.targets || e.label != a.label {
        found.lines.push(format!(
            "pass {number} was `{}` with {} and is `{}` with {}",
            e.label, e.targets, a.label, a.targets
        ));
    }
    let draws = e.draws.iter().zip(&a.draws).enumerate();
    if let Some((i, (e, a))) = draws.into_iter().find(|(_, (e, a))| e != a) {
        found.lines.push(format!(
            "first draw that differs: pass {number} `{}`, draw {i} `{}`",
            label, a.label
        ));
        in_draw(e, a, found);
    } else if e.draws.len() != a.draws.len() {
        found.lines.push(format!(
            "pass {number}: {} draws expected, {} found",
            e.draws.len(),
            a.draws.len()
        ));
    }
}

fn in_draw(e: &Draw, a: &Draw, found: &mut Difference) {
    if e.label != a.label {
        found.lines.push(format!("  it was `{}`", e.label));
    }
    let count = |d: &Draw, name: &str| {
        let of_name = d.counters.iter().find(|(n, _)| n == name);
        of_name.map_or(0, |(_, n)| *n)
    };
    let mut names: Vec<&String> = a
        .counters
        .iter()
        .chain(&e.counters)
        .map(|(n, _)| n)
        .collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let (e, a) = (count(e, name), count(a, name));
        if e != a {
            found
                .lines
                .push(format!("  {name}: {e} expected, {a} found"));
        }
    }
    let all = a.tiles.keys().chain(e.tiles.keys());
    let first = all.filter(|at| a.tiles.get(*at) != e.tiles.get(*at)).min();
    if let Some([row, column]) = first {
        found.lines.push(format!(
            "  first tile of 64×64 pixels: column {column}, row {row}"
        ));
        found.tile = Some([*column, *row]);
    }
}
