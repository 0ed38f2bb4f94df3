//! Histories of pixels as rows of numbers.

use gnomon::raster::FragmentEnd;
use gnomon::traces::history::{Change, EventKind, History, PixelEvent, Value};

/// Words of an event, in the order of `EVENT` in `_dtypes.py`.
pub(crate) const EVENT_WORDS: usize = 9;
/// A value that an event does not have.
const NONE: u32 = u32::MAX;

/// Events in order.
pub(crate) fn event_rows(history: &History) -> Vec<[u32; EVENT_WORDS]> {
    let events = history.events.iter().enumerate();
    events.map(|(number, e)| row(number as u32, e)).collect()
}

fn row(number: u32, e: &PixelEvent) -> [u32; EVENT_WORDS] {
    let pass = e.pass as u32;
    let without = |kind| [number, kind, pass, NONE, NONE, NONE, NONE, NONE, NONE];
    match &e.kind {
        EventKind::Load { .. } => without(0),
        EventKind::Store { .. } => without(2),
        EventKind::Fragment(f) => [
            number,
            1,
            pass,
            f.draw,
            f.primitive,
            f.piece,
            u32::from(f.front),
            end(f.end),
            f.depth.unwrap_or(NONE),
        ],
    }
}

/// Its place in `ENDS` of `_dtypes.py`.
fn end(end: FragmentEnd) -> u32 {
    match end {
        FragmentEnd::Hiz => 0,
        FragmentEnd::Bounds => 1,
        FragmentEnd::Stencil => 2,
        FragmentEnd::Depth => 3,
        FragmentEnd::Discarded => 4,
        FragmentEnd::Written => 5,
    }
}

/// What each attachment holds before the first event and after each, one after the other:
/// raw channels, or depth and stencil in the first two.
pub(crate) fn values(history: &History) -> Vec<[u32; 4]> {
    let mut now = first(history);
    let mut all = now.clone();
    for event in &history.events {
        for change in changes(event) {
            now[change.attachment] = raw(&change.after);
        }
        all.extend(&now);
    }
    all
}

/// What each attachment holds before anything happens: what its first event finds, or what
/// is there in the end, where nothing ever happens to it.
fn first(history: &History) -> Vec<[u32; 4]> {
    let found = |attachment: usize| {
        let mut all = history.events.iter().flat_map(changes);
        all.find(|c| c.attachment == attachment)
            .map(|c| raw(&c.before))
    };
    let attachments = history.last.iter().enumerate();
    attachments
        .map(|(number, last)| found(number).unwrap_or(raw(last)))
        .collect()
}

fn changes(event: &PixelEvent) -> impl Iterator<Item = &Change> {
    event.color.iter().chain(&event.depth_stencil)
}

fn raw(value: &Value) -> [u32; 4] {
    match *value {
        Value::Color(channels) => channels,
        Value::DepthStencil(depth, stencil) => [depth, u32::from(stencil), 0, 0],
    }
}
