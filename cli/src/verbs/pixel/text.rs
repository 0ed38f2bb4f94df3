//! The history of a pixel as a table.

use gnomon_raster::state::{CompareFunction, StencilOperation};
use gnomon_raster::{Format, FragmentEnd, LoadOp, StoreOp};
use gnomon_traces::history::{Change, EventKind, FragmentEvent, History, PixelEvent, Value};

use super::words::stored;
use crate::documents::{end_name, operation, sign};
use crate::output::tables::Table;

/// One row an event, then what the pixel holds.
pub(crate) fn text(h: &History, frame: usize) -> String {
    let [x, y] = h.pixel;
    let title = format!(
        "pixel ({x}, {y}) of frame {frame}: {} events",
        h.events.len()
    );
    let header = [
        "event",
        "pass",
        "draw",
        "prim",
        "end",
        "fragment z",
        "depth",
        "stencil",
        "colour",
        "why",
    ];
    let mut table = Table::new(&title, &header);
    for (i, e) in h.events.iter().enumerate() {
        table.rows.push(row(h, i, e));
    }
    let mut text = table.to_text();
    text.push('\n');
    for (a, v) in h.attachments.iter().zip(&h.last) {
        text += &format!("{} ({:?}) holds {}\n", a.label, a.format, held(a.format, v));
    }
    text
}

fn held(format: Format, v: &Value) -> String {
    match v {
        Value::Color(c) => stored(format, *c),
        Value::DepthStencil(depth, stencil) => format!("depth {depth}, stencil {stencil}"),
    }
}

fn row(h: &History, number: usize, e: &PixelEvent) -> Vec<String> {
    let (mut draw, mut primitive, mut depth) = (String::new(), String::new(), String::new());
    let (end, why) = match &e.kind {
        EventKind::Load { .. } => ("load".to_owned(), load_words(&e.kind)),
        EventKind::Store { .. } => ("store".to_owned(), store_words(&e.kind)),
        EventKind::Fragment(f) => {
            draw = format!("{} {}", f.draw, f.label);
            primitive = match f.piece {
                0 => f.primitive.to_string(),
                piece => format!("{}.{piece}", f.primitive),
            };
            depth = f.depth.map(|d| d.to_string()).unwrap_or_default();
            (end_name(f.end).to_owned(), reason(f, e))
        }
    };
    let (z, s) = depth_stencil(e);
    let pass = format!("{} {}", e.pass, e.pass_label);
    let color = colors(h, e);
    vec![
        number.to_string(),
        pass,
        draw,
        primitive,
        end,
        depth,
        z,
        s,
        color,
        why,
    ]
}

/// A value before and after, once where it stays.
fn change(before: &str, after: &str) -> String {
    match before == after {
        true => before.to_owned(),
        false => format!("{before}→{after}"),
    }
}

fn depth_stencil(e: &PixelEvent) -> (String, String) {
    let Some(Change {
        before: Value::DepthStencil(z0, s0),
        after: Value::DepthStencil(z1, s1),
        ..
    }) = e.depth_stencil
    else {
        return Default::default();
    };
    (
        change(&z0.to_string(), &z1.to_string()),
        change(&s0.to_string(), &s1.to_string()),
    )
}

/// The colours that changed.
fn colors(h: &History, e: &PixelEvent) -> String {
    let one = |c: &Change| match (c.before, c.after) {
        (Value::Color(a), Value::Color(b)) if a != b => {
            let format = h.attachments[c.attachment].format;
            Some(change(&stored(format, a), &stored(format, b)))
        }
        _ => None,
    };
    e.color
        .iter()
        .filter_map(one)
        .collect::<Vec<_>>()
        .join(", ")
}

fn load_words(kind: &EventKind) -> String {
    fn word<T>(what: &str, op: &LoadOp<T>) -> String {
        match op {
            LoadOp::Load => format!("{what} loaded"),
            LoadOp::Clear(_) => format!("{what} cleared"),
            LoadOp::DontCare => format!("{what} not cared for"),
        }
    }
    let EventKind::Load {
        color,
        depth_stencil,
    } = kind
    else {
        return String::new();
    };
    let colors = color.iter().map(|op| word("colour", op));
    let depth = depth_stencil.iter();
    let depth = depth.flat_map(|(z, s)| [word("depth", z), word("stencil", s)]);
    depth.chain(colors).collect::<Vec<_>>().join(", ")
}

fn store_words(kind: &EventKind) -> String {
    let EventKind::Store {
        color,
        depth_stencil,
    } = kind
    else {
        return String::new();
    };
    let colors = color.iter().map(|op| ("colour", *op));
    let depth = depth_stencil.iter();
    let depth = depth.flat_map(|(z, s)| [("depth", *z), ("stencil", *s)]);
    let gone = depth
        .chain(colors)
        .filter(|(_, op)| *op == StoreOp::Discard);
    let words: Vec<_> = gone.map(|(what, _)| format!("{what} discarded")).collect();
    words.join(", ")
}

/// Why the fragment ended as it did.
fn reason(f: &FragmentEvent, e: &PixelEvent) -> String {
    let mut words = match f.end {
        FragmentEnd::Hiz => format!("block culled: {}", culled(f)),
        FragmentEnd::Bounds => outside_bounds(f, e),
        FragmentEnd::Stencil => stencil_failed(f, e),
        FragmentEnd::Depth => depth_failed(f, e),
        FragmentEnd::Discarded => "discarded by the shader".to_owned(),
        FragmentEnd::Written => String::new(),
    };
    if let Some(op) = f.stencil.and_then(|s| s.op)
        && op != StencilOperation::Keep
    {
        let facing = if f.front { "front" } else { "back" };
        let separator = if words.is_empty() { "" } else { "; " };
        words += &format!("{separator}{facing}, stencil {}", operation(op));
    }
    words
}

/// What zmin/zmax decided by.
fn culled(f: &FragmentEvent) -> String {
    let ([near, far], [min, max]) = (f.span, f.stored);
    match f.compare {
        Some(CompareFunction::Less) => format!("nearest {near} ≥ zmax {max}"),
        Some(CompareFunction::LessEqual) => format!("nearest {near} > zmax {max}"),
        Some(CompareFunction::Greater) => format!("farthest {far} ≤ zmin {min}"),
        Some(CompareFunction::GreaterEqual) => format!("farthest {far} < zmin {min}"),
        _ => format!("{near} to {far} against {min} to {max}"),
    }
}

fn stored_depth_stencil(e: &PixelEvent) -> (u32, u8) {
    match e.depth_stencil {
        Some(Change {
            before: Value::DepthStencil(z, s),
            ..
        }) => (z, s),
        _ => (0, 0),
    }
}

fn outside_bounds(f: &FragmentEvent, e: &PixelEvent) -> String {
    let [low, high] = f.bounds.unwrap_or_default();
    let (z, _) = stored_depth_stencil(e);
    format!("stored {z} is outside of {low} to {high}")
}

fn stencil_failed(f: &FragmentEvent, e: &PixelEvent) -> String {
    let Some(s) = f.stencil else {
        return String::new();
    };
    let mask = s.face.read_mask;
    let (reference, stored) = (s.reference & mask, stored_depth_stencil(e).1 & mask);
    match s.face.compare {
        CompareFunction::Never => "the stencil test never passes".to_owned(),
        compare => format!("not {reference} {} {stored}", sign(compare)),
    }
}

fn depth_failed(f: &FragmentEvent, e: &PixelEvent) -> String {
    let fragment = f.depth.unwrap_or_default();
    match f.compare {
        Some(CompareFunction::Never) | None => "the depth test never passes".to_owned(),
        Some(compare) => {
            let stored = stored_depth_stencil(e).0;
            format!("not {fragment} {} {stored}", sign(compare))
        }
    }
}
