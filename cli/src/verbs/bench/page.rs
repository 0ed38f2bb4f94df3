//! The page: which technique to use, plots, tables.

use super::advice::{self, LIMITS};
use super::charts;
use super::front::{Cost, front, points};
use super::results::{Group, Results, Row};
use crate::draw::plot;
use crate::output::html::page::{self, Page};
use crate::output::numbers::error;
use crate::output::tables::Table;

/// The page's text.
pub(super) fn make(results: &Results) -> String {
    let plan = &results.plan;
    let groups = results.groups();
    let mut body = String::new();
    for family in advice::families(results) {
        body += &advise(&family);
    }
    for group in &groups {
        body += &section(results, group);
    }
    body += &left_out(results);
    Page {
        title: format!("{}: error against time and bytes", plan.suite),
        lead: lead(results),
        body,
        foot: foot(results, &groups),
    }
    .to_html()
}

fn lead(results: &Results) -> String {
    let plan = &results.plan;
    let cells = plan.cells.len();
    format!(
        "{cells} measurements, each the median of {} frames. Errors are of the visibility of \
         light {} against the {} oracle. In plots, lower left is better; the dashed line joins \
         what nothing beats.",
        plan.repeat, plan.light, plan.reference
    )
}

/// The cheapest technique at each error, on all scenes and on each.
fn advise(family: &[Group<'_>]) -> String {
    let Some(first) = family.first() else {
        return String::new();
    };
    let [width, height] = first.size;
    let mut out = format!(
        "<h2>Which technique at which error: {width}×{height}, {}</h2>\n",
        first.threads_text()
    );
    for cost in [Cost::Time, Cost::Bytes] {
        let by = match cost {
            Cost::Bytes => "bytes",
            _ => "time to build and draw",
        };
        let together = family.len() > 1;
        let mut header = vec!["RMSE at most"];
        header.extend(together.then_some("all scenes"));
        header.extend(family.iter().map(|g| g.scene));
        let mut table = Table::new(&format!("The cheapest by {by}"), &header);
        let overall = advice::overall(family, cost);
        for limit in LIMITS {
            let best = advice::best(&overall, limit);
            let all = best.map_or("nothing".to_owned(), |b| b.label.clone());
            let all = together.then_some(all);
            let each = family.iter().map(|g| cheapest(g, cost, limit));
            let row = std::iter::once(limit.to_string()).chain(all).chain(each);
            table.rows.push(row.collect());
        }
        out += &page::table(&table);
    }
    out
}

fn cheapest(group: &Group<'_>, cost: Cost, limit: f64) -> String {
    let found = advice::cheapest(group, cost, limit);
    found.map_or("nothing".to_owned(), |(row, paid)| {
        let paid = match cost {
            Cost::Bytes => format!("{:.1} MB", paid / 1e6),
            _ => format!("{paid:.2} ms"),
        };
        format!("{}, {paid}", row.cell.label())
    })
}

fn section(results: &Results, group: &Group<'_>) -> String {
    let mut out = format!("<section>\n<h2>{}</h2>\n", page::escape(&group.title()));
    for chart in charts::of_group(results, group) {
        out += "<figure class=\"cloud\">\n";
        out += &plot::cloud_in_page(&chart.cloud);
        out += "</figure>\n";
    }
    out + &page::table(&table(group)) + "</section>\n"
}

type Column = (&'static str, fn(&Row<'_>) -> String);

const COLUMNS: &[Column] = &[
    ("technique", |r| r.cell.technique.clone()),
    ("settings", |r| r.cell.settings_text()),
    ("RMSE", |r| some(r.rmse())),
    ("max", |r| some(r.measured.found.max.map(|e| e.0))),
    ("umbra", |r| some(r.measured.found.rmse_umbra.map(|e| e.0))),
    ("penumbra", |r| {
        some(r.measured.found.rmse_penumbra.map(|e| e.0))
    }),
    ("lit", |r| some(r.measured.found.rmse_lit.map(|e| e.0))),
    ("FLIP", |r| error(r.measured.found.flip.0)),
    ("build ms", |r| ms(r.measured.time.build())),
    ("frame ms", |r| ms(r.measured.time.frame())),
    ("least", |r| ms(r.measured.time.spread()[0])),
    ("largest", |r| ms(r.measured.time.spread()[1])),
    ("load", |r| {
        r.measured
            .time
            .load
            .map_or(String::new(), |l| l.0.to_string())
    }),
    ("MB", |r| {
        format!("{:.2}", r.measured.found.bytes as f64 / 1e6)
    }),
    ("shaded fragments", |r| {
        r.measured.found.shaded_fragments.to_string()
    }),
];

/// All rows; the last column names the fronts that a row is on.
fn table(group: &Group<'_>) -> Table {
    let mut header: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
    header.push("front of");
    let mut table = Table::new("All measurements", &header);
    let on = Cost::ALL.map(|cost| front(&points(group, cost)));
    for (k, row) in group.rows.iter().enumerate() {
        let mut cells: Vec<String> = COLUMNS.iter().map(|(_, of)| of(row)).collect();
        let fronts = Cost::ALL.iter().zip(&on).filter(|(_, on)| on[k]);
        cells.push(fronts.map(|(c, _)| c.name()).collect::<Vec<_>>().join(" "));
        table.rows.push(cells);
    }
    table
}

fn some(value: Option<f64>) -> String {
    value.map_or(String::new(), error)
}

fn ms(value: f64) -> String {
    format!("{value:.2}")
}

/// What was refused, and what has no result yet.
fn left_out(results: &Results) -> String {
    let refused = results.refused();
    let mut lines: Vec<String> = refused
        .map(|(cell, why)| format!("{}, {}: refused: {why}", cell.scene, cell.label()))
        .collect();
    if results.missing() > 0 {
        lines.push(format!("{} cells have no result yet.", results.missing()));
    }
    match lines.is_empty() {
        true => String::new(),
        false => page::list("Left out", &lines),
    }
}

fn foot(results: &Results, groups: &[Group<'_>]) -> Vec<(String, String)> {
    let plan = &results.plan;
    let times = groups
        .iter()
        .flat_map(|g| &g.rows)
        .map(|r| &r.measured.time);
    let mut machines: Vec<String> = times
        .map(|t| format!("{} cores, {}", t.cores, t.simd))
        .collect();
    machines.sort();
    machines.dedup();
    let row = |name: &str, value: String| (name.to_owned(), value);
    vec![
        row(
            "Version",
            format!("gnomon {}, build {}", plan.version, plan.build),
        ),
        row("Machines", machines.join("; ")),
    ]
}
