//! The history of a pixel as JSON.

use gnomon_raster::{LoadOp, StoreOp};
use gnomon_traces::history::{Change, EventKind, FragmentEvent, History, PixelEvent, Value};
use serde::Serialize;
use serde_json::{Value as Json, json};

use super::words::{end_name, operation, sign};

/// Everything that happened to a pixel.
#[derive(Serialize)]
pub struct PixelDocument {
    pixel: [u32; 2],
    frame: usize,
    size: [u32; 2],
    attachments: Vec<AttachmentDocument>,
    events: Vec<EventDocument>,
    #[serde(rename = "final")]
    last: Vec<Json>,
}

#[derive(Serialize)]
struct AttachmentDocument {
    label: String,
    texture: usize,
    mip: u32,
    layer: u32,
    format: String,
}

/// `draw` to `piece` and what only fragments have are `null` for loads and stores.
#[derive(Serialize)]
struct EventDocument {
    event: usize,
    kind: &'static str,
    pass: usize,
    pass_label: String,
    draw: Option<u32>,
    label: String,
    primitive: Option<u32>,
    piece: Option<u32>,
    front: Option<bool>,
    end: String,
    depth: Option<Json>,
    stencil: Option<Json>,
    varyings: Option<Vec<Json>>,
    outputs: Option<Vec<Vec<Json>>>,
    color: Vec<ColorDocument>,
}

#[derive(Serialize)]
struct ColorDocument {
    attachment: usize,
    before: Json,
    after: Json,
    /// What a load or store operation does.
    #[serde(skip_serializing_if = "Option::is_none")]
    operation: Option<Json>,
}

impl PixelDocument {
    /// Of frame number `frame`.
    pub fn new(h: &History, frame: usize) -> Self {
        let attachments = h.attachments.iter().map(|a| AttachmentDocument {
            label: a.label.clone(),
            texture: a.texture.index(),
            mip: a.subresource.mip,
            layer: a.subresource.layer,
            format: format!("{:?}", a.format),
        });
        let events = h.events.iter().enumerate();
        Self {
            pixel: h.pixel,
            frame,
            size: h.size,
            attachments: attachments.collect(),
            events: events.map(|(i, e)| event(i, e)).collect(),
            last: h.last.iter().map(value).collect(),
        }
    }
}

/// What an attachment holds.
fn value(v: &Value) -> Json {
    match v {
        Value::Color(c) => json!(c),
        Value::DepthStencil(depth, stencil) => json!({"depth": depth, "stencil": stencil}),
    }
}

/// A float; where JSON has no number for it, its name.
fn float(bits: &u32) -> Json {
    let v = f32::from_bits(*bits);
    match v.is_finite() {
        true => json!(v),
        false => json!(v.to_string()),
    }
}

fn load<T: Serialize>(op: &LoadOp<T>) -> Json {
    match op {
        LoadOp::Load => json!("load"),
        LoadOp::DontCare => json!("dont-care"),
        LoadOp::Clear(v) => json!({ "clear": v }),
    }
}

fn store(op: &StoreOp) -> Json {
    match op {
        StoreOp::Store => json!("store"),
        StoreOp::Discard => json!("discard"),
    }
}

fn event(number: usize, e: &PixelEvent) -> EventDocument {
    let mut d = EventDocument {
        event: number,
        kind: "fragment",
        pass: e.pass,
        pass_label: e.pass_label.clone(),
        draw: None,
        label: e.pass_label.clone(),
        primitive: None,
        piece: None,
        front: None,
        end: String::new(),
        depth: None,
        stencil: None,
        varyings: None,
        outputs: None,
        color: e.color.iter().map(color).collect(),
    };
    let (mut operations, mut of_depth) = (Vec::new(), [None, None]);
    match &e.kind {
        EventKind::Fragment(f) => of_fragment(&mut d, f),
        EventKind::Load {
            color,
            depth_stencil,
        } => {
            d.kind = "load";
            operations = color.iter().map(load).collect();
            of_depth = ends(depth_stencil.as_ref().map(|(z, s)| [load(z), load(s)]));
        }
        EventKind::Store {
            color,
            depth_stencil,
        } => {
            d.kind = "store";
            operations = color.iter().map(store).collect();
            of_depth = ends(depth_stencil.as_ref().map(|(z, s)| [store(z), store(s)]));
        }
    }
    if d.end.is_empty() {
        d.end = d.kind.to_owned();
    }
    for (c, op) in d.color.iter_mut().zip(operations) {
        c.operation = Some(op);
    }
    depth_stencil(&mut d, e, of_depth);
    d
}

fn ends(both: Option<[Json; 2]>) -> [Option<Json>; 2] {
    both.map_or([None, None], |b| b.map(Some))
}

fn color(c: &Change) -> ColorDocument {
    ColorDocument {
        attachment: c.attachment,
        before: value(&c.before),
        after: value(&c.after),
        operation: None,
    }
}

fn of_fragment(d: &mut EventDocument, f: &FragmentEvent) {
    d.draw = Some(f.draw);
    d.label = f.label.clone();
    d.primitive = Some(f.primitive);
    d.piece = Some(f.piece);
    d.front = Some(f.front);
    d.end = end_name(f.end).to_owned();
    d.varyings = f.varyings.as_ref().map(|v| v.iter().map(float).collect());
    let floats = |c: &[u32; 4]| c.iter().map(float).collect();
    d.outputs = f.outputs.as_ref().map(|o| o.iter().map(floats).collect());
}

/// Fills in depth and stencil, with what only fragments have.
fn depth_stencil(d: &mut EventDocument, e: &PixelEvent, [of_depth, of_stencil]: [Option<Json>; 2]) {
    let Some(Change {
        attachment,
        before: Value::DepthStencil(z0, s0),
        after: Value::DepthStencil(z1, s1),
    }) = e.depth_stencil
    else {
        return;
    };
    let fragment = match &e.kind {
        EventKind::Fragment(f) => Some(f),
        _ => None,
    };
    d.depth = Some(json!({
        "attachment": attachment,
        "fragment": fragment.and_then(|f| f.depth),
        "before": z0,
        "after": z1,
        "compare": fragment.and_then(|f| f.compare).map(sign),
        "bounds": fragment.and_then(|f| f.bounds),
        "primitive_in_block": fragment.map(|f| f.span),
        "stored_in_block": fragment.map(|f| f.stored),
        "operation": of_depth,
    }));
    let used = fragment.and_then(|f| f.stencil);
    d.stencil = Some(json!({
        "before": s0,
        "after": s1,
        "op": used.and_then(|s| s.op).map(operation),
        "reference": used.map(|s| s.reference),
        "read_mask": used.map(|s| s.face.read_mask),
        "write_mask": used.map(|s| s.face.write_mask),
        "compare": used.map(|s| sign(s.face.compare)),
        "operation": of_stencil,
    }));
}
