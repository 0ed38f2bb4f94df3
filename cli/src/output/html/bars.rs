//! Stacked bars of bytes by client, and the waterfall of fragments.

use std::fmt::Write;

use gnomon_traces::report::{ClientBytes, FrameReport};

use super::escape;

/// A bar for each pass and one for the frame; each segment is a client.
pub(crate) fn passes(frame: &FrameReport) -> String {
    let largest = frame.passes.iter().map(|p| p.bytes()).max().unwrap_or(0);
    let clients = frame.clients();
    let mut out = "<h3>Logical bytes by pass and client</h3>\n<div class=\"key\">".to_owned();
    for c in &clients {
        let _ = write!(
            out,
            "<span><i class=\"{}\"></i>{} {}</span>",
            class(&c.client),
            escape(&c.client),
            c.total()
        );
    }
    let _ = writeln!(
        out,
        "<span>all {}</span></div>\n<div class=\"bars\">",
        frame.bytes()
    );
    for pass in &frame.passes {
        out += &bar(&pass.label, pass.bytes(), largest, &pass.clients);
    }
    out + "</div>\n"
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
        "z" => "c-z",
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
