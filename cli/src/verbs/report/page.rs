//! What stands on the page, from top to bottom.

use std::path::Path;

use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::world::scene::Scene;

use super::measure::Subject;
use crate::output::html::scatter::{Point, Scatter};
use crate::output::html::{bars, draws, frame, history, maps, page};
use crate::output::json::worker_threads;
use crate::output::png;
use crate::output::tables::Table;
use crate::overlay;

/// The page's text.
pub(super) fn make(scene: &Scene, settings: &RenderSettings, subjects: &[Subject]) -> String {
    let [width, height] = settings.size;
    let mut body = String::new();
    if subjects.len() > 1 {
        body += &compare(scene, subjects);
    }
    for (number, subject) in subjects.iter().enumerate() {
        body += &section(number, subject);
    }
    page::Page {
        title: format!("{}: where the work goes", scene.name),
        lead: format!(
            "{width}×{height} pixels, {}. Bytes are logical: what the commands ask for, before any cache.",
            subjects.iter().map(|s| s.label.as_str()).collect::<Vec<_>>().join("; ")
        ),
        body,
        foot: foot(settings, subjects),
    }
    .to_html()
}

fn section(number: usize, subject: &Subject) -> String {
    let title = page::escape(&subject.label);
    let picture = png::encode(&overlay::picture(&subject.done));
    let pixels: Vec<[u32; 2]> = subject.histories.iter().map(|h| h.pixel).collect();
    let mut out = format!("<section id=\"s{number}\">\n<h2>{title}</h2>\n");
    out += &maps::figure(number, picture, &subject.maps, &pixels, &command());
    out += &subject
        .histories
        .iter()
        .map(|h| history::details(number, h))
        .collect::<String>();
    let findings = subject.findings.iter().map(|f| f.text.clone());
    let warnings = subject.done.warnings.iter();
    let warnings = warnings.map(|w| format!("Warning: {}: {}", w.code, w.message));
    out += &page::list("Findings", &findings.chain(warnings).collect::<Vec<_>>());
    out += &bars::passes(&subject.frame);
    out += &bars::waterfall(&subject.frame);
    out += &frame::timeline(&subject.frame);
    out += &draws::table(&subject.frame);
    out + "</section>\n"
}

/// Errors beside bytes and times.
fn compare(scene: &Scene, subjects: &[Subject]) -> String {
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
        let (bytes, ms) = (s.frame.bytes(), s.done.frame_ms);
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
        let why = if scene.lights.len() == 1 {
            "no pixel could be compared"
        } else {
            "errors of visibility are of one light, and the scene has several"
        };
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
fn foot(settings: &RenderSettings, subjects: &[Subject]) -> Vec<(String, String)> {
    let gpu = settings.gpu;
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
                settings.repeat
            ),
        ),
        ("CPU".to_owned(), cpu()),
    ];
    for s in subjects {
        rows.push((format!("Picture, {}", s.label), s.done.color_hash()));
        rows.push((format!("Visibility, {}", s.label), s.done.visibility_hash()));
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
    words.map(|w| quote(&w)).collect::<Vec<_>>().join(" ")
}

fn quote(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,:=+@%".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
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

#[cfg(test)]
mod tests {
    use super::quote;

    #[test]
    fn words_survive_a_shell() {
        assert_eq!(quote("a-b=1"), "a-b=1");
        assert_eq!(quote("a b"), "'a b'");
        assert_eq!(quote("it's"), r"'it'\''s'");
        assert_eq!(quote(""), "''");
    }
}
