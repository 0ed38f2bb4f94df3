//! Tables of what each draw counted, in the order of submission, in full numbers.

use gnomon_raster::{ClientTraffic, Counters, PassReport, SubmitReport, Traffic};

use super::tables::{Table, clears, frame_counters};

/// Columns of [`work`] behind the draw's name.
const WORK: [&str; 9] = [
    "primitives",
    "rasterized",
    "fragments",
    "hiz",
    "bounds",
    "stencil",
    "depth",
    "discarded",
    "written",
];

/// Primitives, and fragments by where they ended.
pub(crate) fn work(report: &SubmitReport) -> Table {
    let header: Vec<&str> = [&["draw"][..], &WORK].concat();
    let title = "Draws: primitives, and fragments by where they ended";
    let mut table = Table::new(title, &header);
    for pass in &report.passes {
        table.rows.push(vec![pass.label.clone()]);
        let draws = pass.draws.iter().enumerate();
        table
            .rows
            .extend(draws.map(|(i, d)| row(name(i, &d.label), &work_of(&d.counters))));
    }
    let sum = frame_counters(report);
    table.rows.push(row("total".to_owned(), &work_of(&sum)));
    table
}

fn name(number: usize, label: &str) -> String {
    format!("  {number} {label}")
}

fn row(name: String, numbers: &[u64]) -> Vec<String> {
    let numbers = numbers.iter().map(u64::to_string);
    std::iter::once(name).chain(numbers).collect()
}

fn work_of(c: &Counters) -> [u64; WORK.len()] {
    let (p, f) = (&c.primitives, &c.fragments);
    [
        p.input,
        p.rasterized,
        f.generated,
        f.hiz_killed,
        f.bounds_failed,
        f.stencil_failed,
        f.depth_failed,
        f.discarded,
        f.written,
    ]
}

/// Bytes read and written by each client that has any; clears beside the draws.
pub(crate) fn traffic(report: &SubmitReport) -> Table {
    let mut sum = frame_counters(report);
    sum.add(&clears(report));
    let clients: Vec<String> = sum.traffic.named().into_iter().map(|(n, _)| n).collect();
    let ways = |client: &String| [format!("{client} read"), format!("{client} write")];
    let mut header = vec!["draw".to_owned()];
    header.extend(clients.iter().flat_map(ways));
    header.push("total".to_owned());
    let mut table = Table {
        title: "Draws: bytes read and written by client".to_owned(),
        header,
        rows: Vec::new(),
    };
    for pass in &report.passes {
        push_pass(&mut table.rows, pass, &clients);
    }
    table
        .rows
        .push(row("total".to_owned(), &bytes_of(&sum.traffic, &clients)));
    table
}

fn push_pass(rows: &mut Vec<Vec<String>>, pass: &PassReport, clients: &[String]) {
    rows.push(vec![pass.label.clone()]);
    if pass.clear != ClientTraffic::default() {
        let cleared = bytes_of(&pass.clear, clients);
        rows.push(row("  clear".to_owned(), &cleared));
    }
    let draws = pass.draws.iter().enumerate();
    rows.extend(draws.map(|(i, d)| {
        let bytes = bytes_of(&d.counters.traffic, clients);
        row(name(i, &d.label), &bytes)
    }));
}

/// Read and written bytes of `clients`, then all of them.
fn bytes_of(traffic: &ClientTraffic, clients: &[String]) -> Vec<u64> {
    let named = traffic.named();
    let of = |client: &String| {
        let found = named.iter().find(|(name, _)| name == client);
        let Traffic {
            read_bytes,
            write_bytes,
            ..
        } = found.map(|(_, t)| *t).unwrap_or_default();
        [read_bytes, write_bytes]
    };
    let mut bytes: Vec<u64> = clients.iter().flat_map(of).collect();
    bytes.push(traffic.total_bytes());
    bytes
}
