//! The timeline: bytes of the draws in the order of submission.

use std::fmt::Write;

use gnomon_traces::report::{DrawRow, FrameReport};

use super::bars::class;
use super::escape;

/// Columns at most; draws beyond share them.
const MOST_COLUMNS: usize = 400;
const HEIGHT: f64 = 120.0;

/// A column for each draw, or for as many as share one.
pub(crate) fn timeline(frame: &FrameReport) -> String {
    let each = frame.draws.len().div_ceil(MOST_COLUMNS).max(1);
    let columns: Vec<&[DrawRow]> = frame.draws.chunks(each).collect();
    let sum = |draws: &[DrawRow]| draws.iter().map(DrawRow::bytes).sum::<u64>();
    let top = columns.iter().map(|c| sum(c)).max().unwrap_or(0).max(1);
    let mut bars = String::new();
    for (x, draws) in columns.iter().enumerate() {
        bars += &column(x, draws, top);
    }
    let shared = match each {
        1 => String::new(),
        n => format!(" {n} draws share a column."),
    };
    format!(
        "<h3>Logical bytes, draw after draw</h3>\n<figure class=\"timeline\"><svg viewBox=\"0 0 {} {HEIGHT}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"bytes of each draw in order\">\n{bars}</svg>\n\
         <figcaption>{} draws in the order of submission, clears left out; the highest column is {top} bytes.{shared}</figcaption></figure>\n",
        columns.len().max(1),
        frame.draws.len()
    )
}

fn column(x: usize, draws: &[DrawRow], top: u64) -> String {
    let mut out = "<g>".to_owned();
    let first = &draws[0];
    let bytes: u64 = draws.iter().map(DrawRow::bytes).sum();
    let title = format!(
        "{} · {} {}: {bytes} bytes",
        first.pass_label, first.draw, first.label
    );
    let _ = write!(out, "<title>{}</title>", escape(&title));
    let mut y = HEIGHT;
    for client in draws.iter().flat_map(|d| &d.clients) {
        let height = HEIGHT * client.total() as f64 / top as f64;
        y -= height;
        let class = class(&client.client);
        let _ = write!(
            out,
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y:.3}\" width=\".9\" height=\"{height:.3}\"/>"
        );
    }
    out + "</g>\n"
}
