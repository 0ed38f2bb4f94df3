//! Tables of what frames and passes cost, for terminals and for the report.

use comfy_table::{
    CellAlignment, ContentArrangement, Table as TerminalTable, TableComponent, presets,
};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_raster::{ClientTraffic, Counters, Traffic};

use super::numbers::{count, milliseconds, rough_count};
use super::wrap::WIDTH;
pub(crate) use crate::documents::{clears, frame_bytes, frame_counters};

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

    /// As text that fits 80 columns as long as names do.
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
        for row in self.rows.iter().filter(|r| r.len() > 1) {
            table.add_row(row);
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        for column in table.column_iter_mut() {
            column.set_padding((0, 0));
        }
        format!("{}\n{}", self.title, self.with_headings(&table.trim_fmt()))
    }

    /// Whether its lines fit a terminal.
    fn fits(&self) -> bool {
        self.to_text().lines().all(|l| l.chars().count() <= WIDTH)
    }

    /// Puts the headings between the rows; as cells they would widen the first column.
    fn with_headings(&self, text: &str) -> String {
        let mut lines = text.lines();
        let mut out = String::new();
        let mut put = |line: &str| {
            out += line.trim_end();
            out.push('\n');
        };
        lines.by_ref().take(HEAD_LINES).for_each(&mut put);
        for row in &self.rows {
            match &row[..] {
                [heading] => put(heading),
                _ => lines.next().into_iter().for_each(&mut put),
            }
        }
        lines.for_each(put);
        out
    }
}

/// Lines of a table before its rows: a rule, the names of columns, a rule.
const HEAD_LINES: usize = 3;

/// A frame and what to call it.
#[derive(Clone, Copy)]
pub(crate) struct Named<'a> {
    pub(crate) label: &'a str,
    pub(crate) done: &'a Rendered,
}

/// Most rows of a frame before passes that differ by a number are one.
const MOST_ROWS: usize = 24;

/// A pass, or passes of many lights together.
struct PassRow {
    name: String,
    count: usize,
    ms: f64,
    counters: Counters,
}

/// The passes of a frame, those of one name together, such as `mips x16`; where
/// they are too many to read, those of all lights together, such as `wedges x30`.
fn pass_rows(done: &Rendered) -> Vec<PassRow> {
    let passes = &done.report.passes;
    let name = |label: &str| {
        if passes.len() > MOST_ROWS {
            kind(label)
        } else {
            label.to_owned()
        }
    };
    let mut rows: Vec<PassRow> = Vec::new();
    for (pass, (_, ms)) in passes.iter().zip(&done.pass_ms) {
        let name = name(&pass.label);
        match rows.iter_mut().find(|r| r.name == name) {
            Some(row) => {
                row.count += 1;
                row.ms += ms;
                row.counters.add(&pass.totals());
            }
            None => rows.push(PassRow {
                name,
                count: 1,
                ms: *ms,
                counters: pass.totals(),
            }),
        }
    }
    for row in rows.iter_mut().filter(|r| r.count > 1) {
        row.name += &format!(" x{}", row.count);
    }
    rows
}

/// A pass's label without the number of its light.
fn kind(label: &str) -> String {
    let words = label.split(' ');
    let words = words.filter(|w| !w.bytes().all(|b| b.is_ascii_digit()));
    words.collect::<Vec<_>>().join(" ")
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
        for row in pass_rows(frame.done) {
            sum.add(&row.counters);
            table.rows.push(work_row(&row.name, row.ms, &row.counters));
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

/// Bytes read and written, client by client, pass by pass; to two digits where three
/// do not fit a terminal.
pub(crate) fn traffic(frames: &[Named<'_>]) -> Table {
    let table = traffic_in(frames, count);
    if table.fits() {
        table
    } else {
        traffic_in(frames, rough_count)
    }
}

/// What writes numbers.
type Write = fn(u64) -> String;

fn traffic_in(frames: &[Named<'_>], write: Write) -> Table {
    let header = [
        "pass", "z", "stencil", "color", "tex", "vertex", "hiz", "total",
    ];
    let mut table = Table::new("Bytes read/written by client, clears apart", &header);
    for frame in frames {
        table.rows.push(vec![frame.label.to_owned()]);
        let mut sum = Counters::default();
        for row in pass_rows(frame.done) {
            sum.add(&row.counters);
            table
                .rows
                .push(traffic_row(&row.name, &row.counters.traffic, write));
        }
        let clear = clears(&frame.done.report);
        table
            .rows
            .push(traffic_row("clears", &clear.traffic, write));
        sum.add(&clear);
        table.rows.push(traffic_row("total", &sum.traffic, write));
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

fn traffic_row(name: &str, t: &ClientTraffic, write: Write) -> Vec<String> {
    let geometry = [t.vertex, t.index];
    let clients: [&[Traffic]; 6] = [&[t.z], &[t.stencil], &t.color, &t.tex, &geometry, &[t.hiz]];
    let mut row = vec![format!("  {name}")];
    row.extend(clients.map(|c| both_ways(c, write)));
    row.push(write(t.total_bytes()));
    row
}

fn both_ways(traffic: &[Traffic], write: Write) -> String {
    let read: u64 = traffic.iter().map(|t| t.read_bytes).sum();
    let written: u64 = traffic.iter().map(|t| t.write_bytes).sum();
    match (read, written) {
        (0, 0) => NOTHING.to_owned(),
        _ => format!("{}/{}", write(read), write(written)),
    }
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
                "pass", "z", "stencil", "color", "tex", "vertex", "hiz", "total",
            ],
        );
        let heading = "a heading, however long it is, is no cell and widens no column of numbers";
        table.rows.push(vec![heading.to_owned()]);
        table.rows.push(traffic_row("volumes 15", &t, count));
        table.rows.push(vec!["last".to_owned()]);
        table.rows.push(traffic_row("total", &t, count));
        let text = table.to_text();
        assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
        assert!(text.contains("999k/99.9k"));
        let lines: Vec<&str> = text.lines().collect();
        let starts = [
            "t",
            "──",
            "pass",
            "══",
            heading,
            "  volumes 15",
            "last",
            "  total",
            "──",
        ];
        assert_eq!(lines.len(), starts.len(), "{text}");
        for (line, start) in lines.iter().zip(starts) {
            assert!(line.starts_with(start), "{text}");
        }
    }

    #[test]
    fn work_fits_a_terminal() {
        let mut table = work(&[]);
        let mut c = Counters::default();
        c.fragments.generated = 999_400;
        c.fragments.hiz_killed = 123_456;
        c.fragments.depth_failed = 123_456;
        c.fragments.written = 123_456;
        c.tiles.tested = 12_345_678;
        c.tiles.culled = 123_456;
        c.tiles.accepted = 123_456;
        table.rows.push(work_row("volumes 15", 99.94, &c));
        let text = table.to_text();
        assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    }
}
