//! The table of draws.

use gnomon_traces::report::{DrawRow, FrameReport};

use super::super::tables::Table;
use super::page;

/// Rows at most; beyond, those that move most.
const MOST_ROWS: usize = 2000;

/// Every draw in full numbers.
pub(crate) fn table(frame: &FrameReport) -> String {
    let clients: Vec<String> = frame.clients().into_iter().map(|c| c.client).collect();
    let mut header: Vec<&str> = HEADER.to_vec();
    header.extend(clients.iter().map(String::as_str));
    header.push("bytes");
    let title = match frame.draws.len() {
        n if n > MOST_ROWS => format!(
            "Draws: the {MOST_ROWS} of {n} that move most (all: gnomon render --json --per draw)"
        ),
        _ => "Draws".to_owned(),
    };
    let mut table = Table::new(&title, &header);
    let rows = chosen(&frame.draws);
    table
        .rows
        .extend(rows.map(|(number, draw)| row(number, draw, &clients)));
    page::table(&table)
}

const HEADER: [&str; 14] = [
    "#",
    "pass",
    "draw",
    "label",
    "zmin/zmax",
    "primitives",
    "fragments",
    "hiz",
    "bounds",
    "stencil test",
    "depth test",
    "discarded",
    "written",
    "shaded",
];

/// Draws to show with their numbers, in the order of submission.
fn chosen(draws: &[DrawRow]) -> impl Iterator<Item = (usize, &DrawRow)> {
    let mut all: Vec<(usize, &DrawRow)> = draws.iter().enumerate().collect();
    if all.len() > MOST_ROWS {
        all.sort_by_key(|(i, d)| (std::cmp::Reverse(d.bytes()), *i));
        all.truncate(MOST_ROWS);
        all.sort_by_key(|(i, _)| *i);
    }
    all.into_iter()
}

fn row(number: usize, draw: &DrawRow, clients: &[String]) -> Vec<String> {
    let c = &draw.counters;
    let f = &c.fragments;
    let hiz = draw
        .hiz_disabled
        .map_or("used".to_owned(), |why| format!("off: {why}"));
    let counts = [
        c.primitives.input,
        f.generated,
        f.hiz_killed,
        f.bounds_failed,
        f.stencil_failed,
        f.depth_failed,
        f.discarded,
        f.written,
        c.fragment_shader_invocations,
    ];
    let of = |name: &String| {
        let found = draw.clients.iter().find(|c| c.client == *name);
        found.map_or(0, |c| c.total())
    };
    let mut row = vec![
        number.to_string(),
        draw.pass_label.clone(),
        draw.draw.to_string(),
        draw.label.clone(),
        hiz,
    ];
    let numbers = counts.into_iter().chain(clients.iter().map(of));
    row.extend(numbers.chain([draw.bytes()]).map(|n| n.to_string()));
    row
}
