//! Results of several folders as one.

use std::path::Path;

use super::args::MergeArgs;
use super::results::Results;
use super::store::{Kept, Store};
use super::stored::{Cell, Measured, Outcome, Plan, Stored};
use crate::error::CliError;
use crate::output::files;

/// Copies every cell of the folders into the one that is asked for.
pub(super) fn merge(args: &MergeArgs) -> Result<(Results, Store), CliError> {
    files::check_folder("--out-dir", &args.out_dir)?;
    let stores: Vec<Store> = args.folders.iter().map(|f| Store::new(f)).collect();
    let plan = common_plan(&args.folders[0], &stores)?;
    let mut chosen = Vec::new();
    for cell in &plan.cells {
        chosen.extend(choose(cell, &stores)?);
    }
    let target = Store::new(&args.out_dir);
    target.put_plan(&plan)?;
    for stored in &chosen {
        target.put_cell(stored)?;
    }
    let (results, _) = Results::gather(plan, &target);
    Ok((results, target))
}

/// The plan of all folders.
fn common_plan(first: &Path, stores: &[Store]) -> Result<Plan, CliError> {
    let mut plans = stores.iter().map(Store::plan);
    let plan = plans.next().unwrap_or_else(|| Store::new(first).plan())?;
    for (store, other) in stores[1..].iter().zip(plans) {
        if let Some(difference) = difference(&plan, &other?) {
            return Err(CliError::Results {
                path: store.plan_path(),
                problem: format!(
                    "{difference}; folders of one suite, measured by one program, can be merged"
                ),
            });
        }
    }
    Ok(plan)
}

/// The first thing that two plans differ in.
fn difference(a: &Plan, b: &Plan) -> Option<String> {
    let facts = |p: &Plan| {
        [
            ("suite", p.suite.clone()),
            ("version", p.version.clone()),
            ("build", p.build.clone()),
            ("repeat", p.repeat.to_string()),
            ("light", p.light.to_string()),
            ("reference", p.reference.clone()),
            ("number of cells", p.cells.len().to_string()),
        ]
    };
    let different = facts(a).into_iter().zip(facts(b)).find(|(a, b)| a != b);
    if let Some(((what, a), (_, b))) = different {
        return Some(format!("{what} is {b}, and {a} in the first folder"));
    }
    let cells = a.cells.iter().zip(&b.cells).position(|(a, b)| a != b)?;
    let (a, b) = (a.cells[cells].label(), b.cells[cells].label());
    Some(format!(
        "cell {cells} is `{b}`, and another one, `{a}`, in the first folder"
    ))
}

/// The result of `cell`: one of any folder, where there are several the one with the
/// shortest frame.
fn choose(cell: &Cell, stores: &[Store]) -> Result<Option<Stored>, CliError> {
    let mut best: Option<Stored> = None;
    for store in stores {
        let next = match store.cell(cell) {
            Kept::Nothing => continue,
            Kept::Broken(path, problem) => return Err(CliError::Results { path, problem }),
            Kept::Result(stored) => *stored,
        };
        best = Some(match best {
            None => next,
            Some(known) => better(cell, known, next, store)?,
        });
    }
    Ok(best)
}

fn better(cell: &Cell, known: Stored, next: Stored, store: &Store) -> Result<Stored, CliError> {
    let [a, b] = [&known, &next].map(facts);
    if let Some((what, a, b)) = a
        .iter()
        .zip(&b)
        .find_map(|(a, b)| (a.1 != b.1).then(|| (a.0, a.1.clone(), b.1.clone())))
    {
        return Err(CliError::Results {
            path: store.cell_path(&cell.key),
            problem: format!(
                "`{}` of {} has {what} {b}, and {a} in another folder: results do not depend on \
                 machines, so one of them is wrong",
                cell.label(),
                cell.scene
            ),
        });
    }
    let ms = |s: &Stored| measured(s).map_or(0.0, |m| m.time.frame());
    Ok(if ms(&next) < ms(&known) { next } else { known })
}

fn measured(stored: &Stored) -> Option<&Measured> {
    match &stored.outcome {
        Outcome::Measured(m) => Some(m),
        Outcome::Refused(_) => None,
    }
}

/// Everything but times, by name.
fn facts(stored: &Stored) -> Vec<(&'static str, String)> {
    match &stored.outcome {
        Outcome::Refused(why) => vec![("the outcome", format!("refused: {why}"))],
        Outcome::Measured(m) => vec![
            ("the outcome", "measured".to_owned()),
            ("visibility", m.found.visibility_hash.clone()),
            ("color", m.found.color_hash.clone()),
            ("bytes", m.found.bytes.to_string()),
            ("figures", format!("{:?}", m.found)),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(why: &str) -> Stored {
        Stored {
            key: "k".to_owned(),
            outcome: Outcome::Refused(why.to_owned()),
        }
    }

    #[test]
    fn results_that_contradict_each_other_are_an_error() {
        let cell = Cell {
            key: "k".to_owned(),
            scene: "demo".to_owned(),
            technique: "pcf".to_owned(),
            settings: Vec::new(),
            params: Vec::new(),
            size: [1, 1],
            threads: 1,
        };
        let store = Store::new(Path::new("second"));
        let same = better(&cell, refused("a"), refused("a"), &store);
        assert_eq!(same.unwrap(), refused("a"));
        let other = better(&cell, refused("a"), refused("b"), &store);
        let message = other.unwrap_err().to_string();
        for part in [
            "second",
            "k.cell",
            "`pcf` of demo",
            "refused: b",
            "refused: a",
        ] {
            assert!(message.contains(part), "{message}");
        }
    }
}
