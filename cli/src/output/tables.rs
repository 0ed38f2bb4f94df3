//! Tables of what frames and passes cost, for terminals and for the report.

use comfy_table::{
    CellAlignment, ContentArrangement, Table as TerminalTable, TableComponent, presets,
};
use gnomon_pipeline::render::Rendered;
use gnomon_raster::{ClientTraffic, Counters, SubmitReport, Traffic};

use super::numbers::{count, milliseconds};

/// A title, named columns, rows of text. The first column is aligned to the
/// left; a row of a single cell is a heading. Column names may have several lines.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) header: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub(crate) fn new(title: &str, header: &[&str]) -> Self {
        Self {
            title: title.to_owned(),
            header: header.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// As text of at most about 95 columns.
    pub(crate) fn to_text(&self) -> String {
        let mut table = TerminalTable::new();
        table
            .load_preset(presets::UTF8_HORIZONTAL_ONLY)
            .remove_style(TableComponent::HorizontalLines)
            .remove_style(TableComponent::MiddleIntersections)
            .remove_style(TableComponent::LeftBorderIntersections)
            .remove_style(TableComponent::RightBorderIntersections)
            .set_content_arrangement(ContentArrangement::Disabled);
        table.set_header(&self.header);
        for row in &self.rows {
            table.add_row(row);
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        for column in table.column_iter_mut() {
            column.set_padding((0, 1));
        }
        format!("{}\n{}\n", self.title, table.trim_fmt())
    }
}

/// A frame and what to call it.
#[derive(Clone, Copy)]
pub(crate) struct Named<'a> {
    pub(crate) label: &'a str,
    pub(crate) done: &'a Rendered,
}

/// Fragments and what was skipped, pass by pass.
pub(crate) fn work(frames: &[Named<'_>]) -> Table {
    let header = [
        "pass",
        "time",
        "fragments",
        "hiz kill",
        "failed",
        "written",
        "tiles",
        "culled",
        "accepted",
    ];
    let mut table = Table::new(
        "Fragments, and 8x8 blocks tested against zmin/zmax",
        &header,
    );
    for frame in frames {
        table.rows.push(vec![frame.label.to_owned()]);
        let mut sum = Counters::default();
        for (pass, (_, ms)) in frame.done.report.passes.iter().zip(&frame.done.pass_ms) {
            let counters = pass.totals();
            sum.add(&counters);
            table.rows.push(work_row(&pass.label, *ms, &counters));
        }
        table
            .rows
            .push(work_row("total", frame.done.frame_ms, &sum));
    }
    table
}

fn work_row(name: &str, ms: f64, c: &Counters) -> Vec<String> {
    let f = &c.fragments;
    let failed = f.depth_failed + f.stencil_failed + f.bounds_failed + f.discarded;
    let counts = [
        f.generated,
        f.hiz_killed,
        failed,
        f.written,
        c.tiles.tested,
        c.tiles.culled,
        c.tiles.accepted,
    ];
    let mut row = vec![format!("  {name}"), milliseconds(ms)];
    row.extend(counts.map(count));
    row
}

/// Bytes read and written, client by client, pass by pass.
pub(crate) fn traffic(frames: &[Named<'_>]) -> Table {
    let header = [
        "pass",
        "z",
        "stencil",
        "color",
        "tex",
        "vertex+index",
        "hiz",
        "total",
    ];
    let mut table = Table::new("Bytes read/written by client, clears apart", &header);
    for frame in frames {
        table.rows.push(vec![frame.label.to_owned()]);
        let mut sum = Counters::default();
        for pass in &frame.done.report.passes {
            let counters = pass.totals();
            sum.add(&counters);
            table.rows.push(traffic_row(&pass.label, &counters.traffic));
        }
        let clear = clears(&frame.done.report);
        table.rows.push(traffic_row("clears", &clear.traffic));
        sum.add(&clear);
        table.rows.push(traffic_row("total", &sum.traffic));
    }
    if table
        .rows
        .iter()
        .all(|r| r.get(4).is_none_or(|c| c == NOTHING))
    {
        table.header.remove(4);
        table
            .rows
            .iter_mut()
            .filter(|r| r.len() > 4)
            .for_each(|r| drop(r.remove(4)));
    }
    table
}

const NOTHING: &str = "-";

fn traffic_row(name: &str, t: &ClientTraffic) -> Vec<String> {
    let geometry = [t.vertex, t.index];
    let clients: [&[Traffic]; 6] = [&[t.z], &[t.stencil], &t.color, &t.tex, &geometry, &[t.hiz]];
    let mut row = vec![format!("  {name}")];
    row.extend(clients.map(both_ways));
    row.push(count(t.total_bytes()));
    row
}

fn both_ways(traffic: &[Traffic]) -> String {
    let read: u64 = traffic.iter().map(|t| t.read_bytes).sum();
    let written: u64 = traffic.iter().map(|t| t.write_bytes).sum();
    match (read, written) {
        (0, 0) => NOTHING.to_owned(),
        _ => format!("{}/{}", count(read), count(written)),
    }
}

/// All bytes of a frame, clears included.
pub(crate) fn frame_bytes(report: &SubmitReport) -> u64 {
    frame_counters(report).traffic.total_bytes() + clears(report).traffic.total_bytes()
}

/// Sum of a frame's counters, clears left out.
pub(crate) fn frame_counters(report: &SubmitReport) -> Counters {
    let mut sum = Counters::default();
    report.passes.iter().for_each(|p| sum.add(&p.totals()));
    sum
}

/// Counters with the traffic of a frame's clears and nothing else.
pub(crate) fn clears(report: &SubmitReport) -> Counters {
    let mut sum = Counters::default();
    for pass in &report.passes {
        let mut clear = Counters::default();
        clear.traffic = pass.clear;
        sum.add(&clear);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The longest cells that numbers can make still fit.
    #[test]
    fn tables_fit_a_terminal() {
        let huge = Traffic {
            read_accesses: 1,
            read_bytes: 999_000,
            write_accesses: 1,
            write_bytes: 99_900,
        };
        let t = ClientTraffic {
            z: huge,
            stencil: huge,
            hiz: huge,
            vertex: huge,
            ..Default::default()
        };
        let mut table = Table::new(
            "t",
            &[
                "pass",
                "z",
                "stencil",
                "color",
                "tex",
                "vertex+index",
                "hiz",
                "total",
            ],
        );
        table.rows.push(traffic_row("volumes 15", &t));
        let text = table.to_text();
        assert!(text.lines().all(|l| l.chars().count() <= 95), "{text}");
        assert!(text.contains("999k/99.9k"));
    }
}
