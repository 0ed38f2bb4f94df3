//! The table of all cells, a line each (RFC 4180).

use super::exact::Exact;
use super::front::{Cost, front, points};
use super::results::{Group, Results};
use super::stored::{Cell, Measured, Outcome};
use crate::output::csv::line;

/// Columns before and behind the figures.
const HEAD: [&str; 8] = [
    "scene",
    "technique",
    "settings",
    "width",
    "height",
    "threads",
    "status",
    "reason",
];

type Figure = (&'static str, fn(&Measured) -> String);

/// Figures of measured cells.
const FIGURES: &[Figure] = &[
    ("rmse", |m| some(m.found.rmse)),
    ("max", |m| some(m.found.max)),
    ("p99", |m| some(m.found.p99)),
    ("mean", |m| some(m.found.mean)),
    ("rmse_umbra", |m| some(m.found.rmse_umbra)),
    ("rmse_penumbra", |m| some(m.found.rmse_penumbra)),
    ("rmse_lit", |m| some(m.found.rmse_lit)),
    ("banding_p99", |m| some(Some(m.found.banding_p99))),
    ("psnr", |m| some(Some(m.found.psnr))),
    ("ssim", |m| some(m.found.ssim)),
    ("flip", |m| some(Some(m.found.flip))),
    ("frame_ms", |m| m.time.frame().to_string()),
    ("frame_ms_min", |m| m.time.spread()[0].to_string()),
    ("frame_ms_max", |m| m.time.spread()[1].to_string()),
    ("build_ms", |m| m.time.build().to_string()),
    ("load", |m| some(m.time.load)),
    ("bytes", |m| m.found.bytes.to_string()),
    ("bytes_z", |m| client(m, "z")),
    ("bytes_stencil", |m| client(m, "stencil")),
    ("bytes_color", |m| client(m, "color")),
    ("bytes_tex", |m| client(m, "tex")),
    ("bytes_vertex", |m| client(m, "vertex")),
    ("bytes_index", |m| client(m, "index")),
    ("bytes_hiz", |m| client(m, "hiz")),
    ("shaded_fragments", |m| m.found.shaded_fragments.to_string()),
    ("pixels", |m| m.found.pixels_compared.to_string()),
    ("pixels_left_out", |m| m.found.pixels_left_out.to_string()),
    ("color_hash", |m| m.found.color_hash.clone()),
    ("visibility_hash", |m| m.found.visibility_hash.clone()),
    ("warnings", warnings),
    ("simd", |m| m.time.simd.clone()),
];

/// The whole table.
pub(super) fn write(results: &Results) -> String {
    let fronts = Cost::ALL.map(|cost| format!("front_{}", cost.name()));
    let names = HEAD.iter().map(|n| (*n).to_owned());
    let names = names.chain(FIGURES.iter().map(|(name, _)| (*name).to_owned()));
    let mut out = line(names.chain(fronts));
    let groups = results.groups();
    let on: Vec<[Vec<bool>; 3]> = groups
        .iter()
        .map(|g| Cost::ALL.map(|c| front(&points(g, c))))
        .collect();
    for (cell, outcome) in results.cells() {
        out += &match outcome {
            None => row(cell, "missing", "", None, [false; 3]),
            Some(Outcome::Refused(why)) => row(cell, "refused", why, None, [false; 3]),
            Some(Outcome::Measured(m)) => row(
                cell,
                "measured",
                "",
                Some(m.as_ref()),
                fronts_of(cell, &groups, &on),
            ),
        };
    }
    out
}

/// On which fronts of its group the cell is.
fn fronts_of(cell: &Cell, groups: &[Group<'_>], on: &[[Vec<bool>; 3]]) -> [bool; 3] {
    let mut found = [false; 3];
    for (group, on) in groups.iter().zip(on).filter(|(g, _)| g.holds(cell)) {
        let at = group.rows.iter().position(|r| r.cell.key == cell.key);
        if let Some(at) = at {
            found = [0, 1, 2].map(|k| on[k][at]);
        }
    }
    found
}

fn row(
    cell: &Cell,
    status: &str,
    reason: &str,
    measured: Option<&Measured>,
    fronts: [bool; 3],
) -> String {
    let [width, height] = cell.size.map(|s| s.to_string());
    let head = [
        cell.scene.clone(),
        cell.technique.clone(),
        cell.settings_text(),
        width,
        height,
        cell.threads.to_string(),
        status.to_owned(),
        reason.to_owned(),
    ];
    let figures = FIGURES
        .iter()
        .map(|(_, figure)| measured.map(figure).unwrap_or_default());
    let fronts = fronts.map(|on| match (measured, on) {
        (None, _) => String::new(),
        (_, on) => u8::from(on).to_string(),
    });
    line(head.into_iter().chain(figures).chain(fronts))
}

fn some(figure: Option<Exact>) -> String {
    figure.map_or(String::new(), |f| f.0.to_string())
}

/// Bytes of all clients of a kind: `color` of `color[0]`, `color[1]`, ...
fn client(measured: &Measured, kind: &str) -> String {
    let clients = measured.found.clients.iter();
    let of_kind = clients.filter(|(name, _)| name.split('[').next() == Some(kind));
    of_kind
        .map(|(_, [read, write])| read + write)
        .sum::<u64>()
        .to_string()
}

fn warnings(measured: &Measured) -> String {
    let all = measured.found.warnings.iter();
    all.map(|(code, count)| format!("{code}={count}"))
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_names_of_their_own() {
        let mut names: Vec<&str> = FIGURES.iter().map(|f| f.0).chain(HEAD).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
