//! The summary for people.

use super::advice::{self, LIMITS};
use super::front::{Cost, along, points};
use super::results::{Group, Results};
use crate::documents::FileDocument;
use crate::output::numbers::{self, error};
use crate::output::tables::Table;
use crate::output::wrap::hanging;

/// Widest label of a table.
const LABEL: usize = 40;

/// Fronts, advice, what was refused, and files.
pub(super) fn summarise(results: &Results, files: &[FileDocument]) -> String {
    let mut text = String::new();
    for group in results.groups() {
        text += &format!("{}\n", front_table(&group).to_text());
    }
    for family in advice::families(results) {
        text += &advise(&family);
    }
    text += &refusals(results);
    let [all, missing] = [results.plan.cells.len(), results.missing()];
    text += &match missing {
        0 => format!("All {all} cells have a result.\n"),
        n => format!("{n} of {all} cells have no result yet: run the rest, or merge it.\n"),
    };
    for file in files {
        text += &format!("wrote {} ({})\n", file.path, file.kind);
    }
    text
}

/// What nothing beats in both time and error.
fn front_table(group: &Group<'_>) -> Table {
    let title = format!("{}: the front of error and time", group.title());
    let header = ["technique and settings", "RMSE", "build", "frame", "bytes"];
    let mut table = Table::new(&title, &header);
    for k in along(&points(group, Cost::Time)) {
        let row = &group.rows[k];
        let time = &row.measured.time;
        table.rows.push(vec![
            short(&row.cell.label()),
            row.rmse().map_or("-".to_owned(), error),
            numbers::milliseconds(time.build()),
            numbers::milliseconds(time.frame()),
            numbers::bytes(row.measured.found.bytes),
        ]);
    }
    table
}

/// The cheapest on all scenes at each error.
fn advise(family: &[Group<'_>]) -> String {
    let Some(first) = family.first().filter(|_| family.len() > 1) else {
        return String::new();
    };
    let [width, height] = first.size;
    let title = format!(
        "The cheapest over all {} scenes at {width}x{height}, {}",
        family.len(),
        first.threads_text()
    );
    let header = ["RMSE at most", "by build and frame", "all scenes"];
    let mut table = Table::new(&title, &header);
    let overall = advice::overall(family, Cost::Time);
    for limit in LIMITS {
        let best = advice::best(&overall, limit);
        table.rows.push(vec![
            limit.to_string(),
            best.map_or("nothing".to_owned(), |b| short(&b.label)),
            best.map_or("-".to_owned(), |b| numbers::milliseconds(b.cost)),
        ]);
    }
    format!("{}\n", table.to_text())
}

/// A label that fits a column; the tables have it in full.
fn short(label: &str) -> String {
    match label.chars().count() {
        n if n > LABEL => label.chars().take(LABEL - 3).collect::<String>() + "...",
        _ => label.to_owned(),
    }
}

/// Reasons, each once with the cells that it is given for.
fn refusals(results: &Results) -> String {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for (cell, why) in results.refused() {
        let name = format!("{} by {}", cell.scene, cell.technique);
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, names)) if names.contains(&name) => {}
            Some((_, names)) => names.push(name),
            None => reasons.push((why, vec![name])),
        }
    }
    let line = |(why, names): (&str, Vec<String>)| {
        hanging(&format!("refused: {}: ", names.join(", ")), 4, why)
    };
    reasons.into_iter().map(line).collect()
}
