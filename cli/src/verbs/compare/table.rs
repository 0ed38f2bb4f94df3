//! The table: a column for each technique, so that it fits a terminal whatever
//! they are called; a row for each figure.

use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;

use super::measure::Measured;
use super::pixels;
use crate::output::numbers::{self, count, error};
use crate::output::tables::{self, Table};

/// Widest line of a column's name.
const NAME: usize = 12;
/// Columns of techniques in one table: 80 characters in all.
const COLUMNS: usize = 4;

/// A figure of one technique.
type Figure = (&'static str, fn(&Measured) -> String);

const FIGURES: &[Figure] = &[
    ("RMSE", |m| of(m.score.visibility.all, |e| e.rmse)),
    ("  in the umbra", |m| rmse(m, LightRegion::Umbra)),
    ("  in the penumbra", |m| rmse(m, LightRegion::Penumbra)),
    ("  in the light", |m| rmse(m, LightRegion::Lit)),
    ("largest error", |m| of(m.score.visibility.all, |e| e.max)),
    ("99% are within", |m| of(m.score.visibility.all, |e| e.p99)),
    ("mean, + too bright", mean),
    ("steps, 99% within", |m| error(m.score.banding.p99)),
    ("penumbra levels", |m| count(m.score.banding.levels as u64)),
    ("PSNR", psnr),
    ("SSIM", |m| {
        m.score.ssim.map_or(NONE.to_owned(), |s| format!("{s:.4}"))
    }),
    ("FLIP", |m| error(m.score.flip)),
    ("time", |m| numbers::milliseconds(m.done.frame_ms)),
    ("bytes", |m| {
        numbers::bytes(tables::frame_bytes(&m.done.report))
    }),
    ("shaded fragments", |m| {
        count(tables::frame_counters(&m.done.report).fragment_shader_invocations)
    }),
    ("  over penumbra pairs", |m| {
        WedgeWork::of(&m.done.report, &m.done.roles)
            .map_or(NONE.to_owned(), |w| format!("{:.2}", w.ratio()))
    }),
];

const NONE: &str = "-";

/// Tables of at most [`COLUMNS`] techniques each.
pub(super) fn tabulate(measured: &[Measured]) -> Vec<Table> {
    measured.chunks(COLUMNS).map(table).collect()
}

fn table(measured: &[Measured]) -> Table {
    let names: Vec<String> = measured.iter().map(|m| lines(&m.label)).collect();
    let header: Vec<&str> = std::iter::once("visibility")
        .chain(names.iter().map(String::as_str))
        .collect();
    let mut table = Table::new("Errors against the truth, and what they cost", &header);
    for (name, figure) in FIGURES {
        let cells = measured.iter().map(figure);
        table
            .rows
            .push(std::iter::once((*name).to_owned()).chain(cells).collect());
    }
    let counts: Vec<_> = measured.iter().map(|m| m.score.pixels).collect();
    table.rows.extend(pixels::tabulate(&counts));
    table
}

fn of(summary: Option<ErrorSummary>, figure: fn(ErrorSummary) -> f64) -> String {
    summary.map_or(NONE.to_owned(), |s| error(figure(s)))
}

fn rmse(measured: &Measured, region: LightRegion) -> String {
    of(measured.score.visibility.of_region(region), |e| e.rmse)
}

fn mean(measured: &Measured) -> String {
    let text = of(measured.score.visibility.all, |e| e.mean);
    if text == NONE || text == "0" || text.starts_with('-') {
        return text;
    }
    format!("+{text}")
}

fn psnr(measured: &Measured) -> String {
    if measured.score.psnr.is_infinite() {
        return "equal".to_owned();
    }
    format!("{:.1} dB", measured.score.psnr)
}

/// A label in lines of at most [`NAME`] characters, broken at blanks and behind
/// hyphens and equals signs; longer parts stay whole.
pub(super) fn lines(label: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in label.split(' ') {
        let mut fresh = true; // a word begins a line
        for part in word.split_inclusive(['-', '=']) {
            match lines.last_mut() {
                Some(line) if !fresh && line.len() + part.len() <= NAME => line.push_str(part),
                _ => lines.push(part.to_owned()),
            }
            fresh = false;
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_broken_where_they_can_be() {
        assert_eq!(lines("shadow-volumes"), "shadow-\nvolumes");
        assert_eq!(lines("unshadowed"), "unshadowed");
        assert_eq!(
            lines("soft-shadow-volumes-optimised samples=1024 pattern=rotated-grid"),
            "soft-shadow-\nvolumes-\noptimised\nsamples=1024\npattern=\nrotated-grid"
        );
    }
}
