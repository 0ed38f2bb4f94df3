//! A frame for the timeline of trace viewers, such as Perfetto: where another trace has
//! time, this one has bytes.

use serde::Serialize;

use crate::report::FrameReport;

/// The document that viewers of the Trace Event Format open.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChromeTrace {
    /// Draws, clients, names.
    #[serde(rename = "traceEvents")]
    pub events: Vec<ChromeEvent>,
}

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChromeEvent {
    /// The draw's label, or the client.
    pub name: String,
    /// `X` for a draw, `C` for what a client has moved so far, `M` for names of tracks.
    pub ph: &'static str,
    /// Kilobytes of all clients before it.
    pub ts: f64,
    /// Kilobytes of a draw.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dur: Option<f64>,
    /// Always 1.
    pub pid: u32,
    /// Number of the pass, from 1.
    pub tid: u32,
    /// Numbers in full.
    pub args: serde_json::Map<String, serde_json::Value>,
}

/// Draws of `frame` one after the other along the bytes that they move; `level` says which
/// bytes these are.
#[must_use]
pub fn chrome(frame: &FrameReport, level: &str) -> ChromeTrace {
    let process = format!("{level} kilobytes so far, not time");
    let mut events = vec![name_of("process_name", 0, &process)];
    for (number, pass) in frame.passes.iter().enumerate() {
        events.push(name_of("thread_name", number as u32 + 1, &pass.label));
    }
    let mut bytes = 0;
    let mut clients: Vec<(String, u64)> = Vec::new();
    for draw in &frame.draws {
        let mut event = event(&draw.label, "X", bytes, draw.pass as u32 + 1);
        event.dur = Some(kilobytes(draw.bytes()));
        event.args.insert("bytes".to_owned(), draw.bytes().into());
        events.push(event);
        bytes += draw.bytes();
        for client in &draw.clients {
            let sum = add(&mut clients, &client.client, client.total());
            let mut event = self::event(&client.client, "C", bytes, 0);
            event.args.insert("bytes".to_owned(), sum.into());
            events.push(event);
        }
    }
    ChromeTrace { events }
}

/// Adds to a client; gives its sum.
fn add(clients: &mut Vec<(String, u64)>, name: &str, bytes: u64) -> u64 {
    match clients.iter_mut().find(|(n, _)| n == name) {
        Some((_, sum)) => {
            *sum += bytes;
            *sum
        }
        None => {
            clients.push((name.to_owned(), bytes));
            bytes
        }
    }
}

fn kilobytes(bytes: u64) -> f64 {
    bytes as f64 / 1e3
}

fn event(name: &str, ph: &'static str, bytes: u64, tid: u32) -> ChromeEvent {
    ChromeEvent {
        name: name.to_owned(),
        ph,
        ts: kilobytes(bytes),
        dur: None,
        pid: 1,
        tid,
        args: serde_json::Map::new(),
    }
}

fn name_of(what: &str, tid: u32, name: &str) -> ChromeEvent {
    let mut event = event(what, "M", 0, tid);
    event.args.insert("name".to_owned(), name.into());
    event
}
