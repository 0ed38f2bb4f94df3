//! Stacked bars of bytes by client, and the waterfall of fragments.

use std::fmt::Write;

use gnomon_traces::judged::Judged;
use gnomon_traces::report::{ClientBytes, FrameReport};

use super::escape;

/// Bars of each pass, logical bytes above those under each profile; each segment is a
/// client, and all are of one scale.
pub(crate) fn passes(frame: &FrameReport, judged: &[Judged]) -> String {
    let frames = || std::iter::once(frame).chain(judged.iter().map(|j| &j.frame));
    let largest = frames().flat_map(|f| &f.passes).map(|p| p.bytes()).max();
    let largest = largest.unwrap_or(0);
    let mut out = "<h3>Bytes by pass and client, logical beside each profile</h3>\n".to_owned();
    out += &key("logical", frame);
    for j in judged {
        out += &key(&j.profile, &j.frame);
    }
    out += "<div class=\"bars\">\n";
    let rows = frames().map(|f| f.passes.len()).max().unwrap_or(0);
    for number in 0..rows {
        out += &pass(number, frame, judged, largest);
    }
    out + "</div>\n"
}

/// The bars of one pass. Profiles may have an end of the frame behind all passes.
fn pass(number: usize, frame: &FrameReport, judged: &[Judged], largest: u64) -> String {
    let mut out = String::new();
    if let Some(p) = frame.passes.get(number) {
        out += &bar(&p.label, p.bytes(), largest, &p.clients);
    }
    for j in judged {
        let Some(p) = j.frame.passes.get(number) else {
            continue;
        };
        let name = match frame.passes.get(number) {
            Some(_) => format!("· {}", j.profile),
            None => format!("{}, {}", p.label, j.profile),
        };
        out += &bar(&name, p.bytes(), largest, &p.clients);
    }
    out
}

/// Sums of a frame's clients.
fn key(name: &str, frame: &FrameReport) -> String {
    let mut out = format!("<div class=\"key\"><b>{}</b>", escape(name));
    for c in frame.clients() {
        let _ = write!(
            out,
            "<span><i class=\"{}\"></i>{} {}</span>",
            class(&c.client),
            escape(&c.client),
            c.total()
        );
    }
    out + &format!("<span>all {}</span></div>\n", frame.bytes())
}

/// A row: name, segments, sum.
fn bar(label: &str, sum: u64, largest: u64, clients: &[ClientBytes]) -> String {
    let segments: String = clients
        .iter()
        .filter(|c| c.total() > 0)
        .map(|c| {
            let title = format!("{}: {} read, {} written", c.client, c.read, c.write);
            segment(class(&c.client), c.total(), largest, &title)
        })
        .collect();
    format!(
        "<div class=\"row\"><b>{}</b><span class=\"bar\">{segments}</span><span class=\"n\">{sum}</span></div>\n",
        escape(label)
    )
}

fn segment(class: &str, amount: u64, of: u64, title: &str) -> String {
    let width = 100.0 * amount as f64 / of.max(1) as f64;
    format!(
        "<i class=\"{class}\" style=\"width:{width:.4}%\" title=\"{}\"></i>",
        escape(title)
    )
}

/// The colour of a client.
pub(crate) fn class(client: &str) -> &'static str {
    match client {
        "z" | "zs" => "c-z",
        "stencil" => "c-stencil",
        "hiz" => "c-hiz",
        "vertex" | "index" => "c-vertex",
        c if c.starts_with("color") => "c-color",
        c if c.starts_with("tex") => "c-tex",
        _ => "c-other",
    }
}

/// Fragments from their generation to what is written, by where they end.
pub(crate) fn waterfall(frame: &FrameReport) -> String {
    let f = frame.totals().fragments;
    let ends = [
        ("ended by zmin/zmax", f.hiz_killed),
        ("outside the depth bounds", f.bounds_failed),
        ("failed the stencil test", f.stencil_failed),
        ("failed the depth test", f.depth_failed),
        ("discarded", f.discarded),
    ];
    let mut out = "<h3>Fragments, from generated to written</h3>\n<div class=\"bars waterfall\">\n"
        .to_owned();
    out += &step("generated", 0, f.generated, f.generated, "w-in");
    let mut before = f.generated;
    for (label, lost) in ends {
        before -= lost;
        out += &step(label, before, lost, f.generated, "w-lost");
    }
    out += &step("written", 0, f.written, f.generated, "w-out");
    out + "</div>\n"
}

/// A row of the waterfall, `amount` behind a gap of `before`.
fn step(label: &str, before: u64, amount: u64, all: u64, class: &str) -> String {
    let gap = 100.0 * before as f64 / all.max(1) as f64;
    let body = segment(class, amount, all, &format!("{amount} of {all}"));
    format!(
        "<div class=\"row\"><b>{}</b><span class=\"bar\"><i style=\"width:{gap:.4}%\"></i>{body}</span><span class=\"n\">{amount}</span></div>\n",
        escape(label)
    )
}
