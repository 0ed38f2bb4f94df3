//! What happened to a pixel, as a table.

use gnomon_raster::{Format, FragmentEnd};
use gnomon_traces::history::{Change, EventKind, History, PixelEvent, Value};

use super::super::tables::Table;
use super::page;

/// The history of one pixel of section `number`.
pub(crate) fn details(number: usize, history: &History) -> String {
    let [x, y] = history.pixel;
    let mut header = vec![
        "#",
        "pass",
        "what",
        "primitive",
        "side",
        "end",
        "depth of fragment",
    ];
    header.extend(history.attachments.iter().map(|a| a.label.as_str()));
    let mut table = Table::new(&format!("Pixel {x}, {y}"), &header);
    let events = history.events.iter().enumerate();
    table.rows.extend(events.map(|(i, e)| row(history, i, e)));
    format!(
        "<div class=\"history\" id=\"s{number}p{x}-{y}\">\n{}</div>\n",
        page::table(&table)
    )
}

fn row(history: &History, number: usize, event: &PixelEvent) -> Vec<String> {
    let mut row = vec![number.to_string(), event.pass_label.clone()];
    let none = || String::new();
    row.extend(match &event.kind {
        EventKind::Load { .. } => ["load or clear".to_owned(), none(), none(), none(), none()],
        EventKind::Store { .. } => [
            "discarding store".to_owned(),
            none(),
            none(),
            none(),
            none(),
        ],
        EventKind::Fragment(f) => [
            format!("draw {} {}", f.draw, f.label),
            f.primitive.to_string(),
            if f.front { "front" } else { "back" }.to_owned(),
            end(f.end).to_owned(),
            f.depth.map_or_else(none, |d| d.to_string()),
        ],
    });
    let changes = || event.depth_stencil.iter().chain(&event.color);
    row.extend(history.attachments.iter().enumerate().map(|(i, a)| {
        let change = changes().find(|c| c.attachment == i);
        change.map_or_else(none, |c| show(c, a.format))
    }));
    row
}

fn end(end: FragmentEnd) -> &'static str {
    match end {
        FragmentEnd::Hiz => "zmin/zmax",
        FragmentEnd::Bounds => "depth bounds",
        FragmentEnd::Stencil => "stencil test",
        FragmentEnd::Depth => "depth test",
        FragmentEnd::Discarded => "discarded",
        FragmentEnd::Written => "written",
    }
}

fn show(change: &Change, format: Format) -> String {
    let value = |v: &Value| match v {
        Value::DepthStencil(depth, stencil) => format!("{depth}, stencil {stencil}"),
        Value::Color(channels) => {
            let shown = channels[..format.channels()].iter().map(u32::to_string);
            shown.collect::<Vec<_>>().join(" ")
        }
    };
    match change.before == change.after {
        true => value(&change.after),
        false => format!("{} → {}", value(&change.before), value(&change.after)),
    }
}
