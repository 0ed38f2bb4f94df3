//! What stands on the page, from top to bottom.

use std::path::Path;

use gnomon_raster::GpuConfig;

use super::measure::Subject;
use crate::documents::worker_threads;
use crate::output::html::scatter::{Point, Scatter};
use crate::output::html::{bars, draws, frame, history, maps, page};
use crate::output::tables::Table;
use crate::output::{png, shell};

/// The page's text.
pub(super) fn make(scene: &str, gpu: &GpuConfig, repeat: u32, subjects: &[Subject]) -> String {
    let [width, height] = subjects.first().map_or([0; 2], |s| s.maps.size);
    let mut body = String::new();
    if subjects.len() > 1 {
        body += &compare(subjects);
    }
    for (number, subject) in subjects.iter().enumerate() {
        body += &section(number, subject);
    }
    page::Page {
        title: format!("{scene}: where the work goes"),
        lead: format!(
            "{width}×{height} pixels, {}. Logical bytes are what the commands ask for, before any cache; those under a profile go between caches and memory, as that hardware is modelled.",
            subjects.iter().map(|s| s.label.as_str()).collect::<Vec<_>>().join("; ")
        ),
        body,
        foot: foot(gpu, repeat, subjects),
    }
    .to_html()
}

fn section(number: usize, subject: &Subject) -> String {
    let title = page::escape(&subject.label);
    let picture = png::encode(&subject.picture);
    let pixels: Vec<[u32; 2]> = subject.histories.iter().map(|h| h.pixel).collect();
    let mut out = format!("<section id=\"s{number}\">\n<h2>{title}</h2>\n");
    out += &maps::figure(number, picture, &subject.maps, &pixels, &command());
    out += &subject
        .histories
        .iter()
        .map(|h| history::details(number, h))
        .collect::<String>();
    let findings = subject.findings.iter().map(|f| f.text.clone());
    let refused = subject.refused.iter().map(|e| format!("Not judged: {e}."));
    let lines: Vec<String> = findings
        .chain(refused)
        .chain(subject.warnings.iter().cloned())
        .collect();
    out += &page::list("Findings", &lines);
    out += &bars::passes(&subject.frame, &subject.judged);
    out += &bars::waterfall(&subject.frame);
    out += &frame::timeline(&subject.frame, "Logical bytes");
    for judged in &subject.judged {
        let title = format!("Bytes to and from memory under {}", judged.profile);
        out += &frame::timeline(&judged.frame, &title);
    }
    out += &draws::table(&subject.frame, &subject.judged);
    out + "</section>\n"
}

/// Errors beside bytes and times.
fn compare(subjects: &[Subject]) -> String {
    let header = ["technique", "RMSE", "bytes", "ms"];
    let mut table = Table::new("Techniques: error, bytes and time", &header);
    let mut points = Vec::new();
    for s in subjects {
        let rmse = s
            .score
            .as_ref()
            .and_then(|s| s.visibility.all)
            .map(|e| e.rmse);
        let shown = rmse.map_or("-".to_owned(), |r| r.to_string());
        let (bytes, ms) = (s.frame.bytes(), s.frame_ms);
        table.rows.push(vec![
            s.label.clone(),
            shown,
            bytes.to_string(),
            ms.to_string(),
        ]);
        points.extend(rmse.map(|rmse| (s.label.clone(), rmse, bytes, ms)));
    }
    let mut out = page::table(&table);
    if points.is_empty() {
        let why = "they are of visibility in scenes of one light";
        return out + &format!("<p>No errors: {why}.</p>\n");
    }
    let of = |x: fn(&(String, f64, u64, f64)) -> f64| -> Vec<Point> {
        points
            .iter()
            .map(|p| Point {
                label: p.0.clone(),
                at: [x(p), p.1],
            })
            .collect()
    };
    let charts = [
        ("logical megabytes", of(|p| p.2 as f64 / 1e6)),
        ("milliseconds", of(|p| p.3)),
    ];
    out += "<div class=\"charts\">\n";
    for (axis, points) in charts {
        let chart = Scatter {
            title: format!("Error against {axis}"),
            axes: [axis.to_owned(), "RMSE of visibility".to_owned()],
            points,
        };
        out += &chart.to_svg();
    }
    out + "</div>\n"
}

/// How the page was made, and what it is of.
fn foot(gpu: &GpuConfig, repeat: u32, subjects: &[Subject]) -> Vec<(String, String)> {
    let mut rows = vec![
        (
            "Version".to_owned(),
            format!("gnomon {}", env!("CARGO_PKG_VERSION")),
        ),
        ("Command".to_owned(), command()),
        (
            "Settings".to_owned(),
            format!(
                "{} threads, {}, execution tiles of {}, skipping {}, {} timed frames",
                worker_threads(gpu.threads),
                gpu.simd,
                gpu.tile,
                if gpu.skip { "on" } else { "off" },
                repeat
            ),
        ),
        ("CPU".to_owned(), cpu()),
    ];
    for s in subjects {
        let hashes = s.hashes.iter();
        rows.extend(hashes.map(|(what, hash)| (format!("{what}, {}", s.label), hash.clone())));
    }
    rows
}

/// As it was called, for a shell.
fn command() -> String {
    let mut words = std::env::args_os().map(|a| a.to_string_lossy().into_owned());
    let program = words.next().unwrap_or_default();
    let program = Path::new(&program).file_name();
    let program = program.map_or("gnomon".into(), |p| p.to_string_lossy().into_owned());
    let words = std::iter::once(program).chain(words);
    words
        .map(|w| shell::quote(&w))
        .collect::<Vec<_>>()
        .join(" ")
}

fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info
        .lines()
        .find_map(|l| l.strip_prefix("model name")?.split_once(": "));
    name.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| {
        name.trim().to_owned()
    })
}
