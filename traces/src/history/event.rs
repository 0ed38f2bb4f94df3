//! Events of a pixel, from what the probe found and what passes do at their ends.

use gnomon_raster::state::{CompareFunction, StencilFaceState, StencilOperation};
use gnomon_raster::{
    Draw, Format, FragmentEnd, LoadOp, MAX_VARYINGS, Recording, RenderPass, StoreOp,
};

use super::HistoryError;
use super::attachments::{Attachments, Value};
use super::collect::Found;

/// Something that happened to the pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelEvent {
    /// Number of the pass.
    pub pass: usize,
    /// Its label.
    pub pass_label: String,
    /// What happened.
    pub kind: EventKind,
    /// The pass's depth-stencil attachment, if it has one.
    pub depth_stencil: Option<Change>,
    /// Its colour attachments.
    pub color: Vec<Change>,
}

/// An attachment before and after an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// Number in [`super::History::attachments`].
    pub attachment: usize,
    /// What it held.
    pub before: Value,
    /// What it holds.
    pub after: Value,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// A pass began: what it does to its attachments, colours in order.
    Load {
        /// Colours.
        color: Vec<LoadOp<[f32; 4]>>,
        /// Depth and stencil.
        depth_stencil: Option<(LoadOp<f32>, LoadOp<u8>)>,
    },
    /// A fragment came.
    Fragment(Box<FragmentEvent>),
    /// A pass ended that discards something.
    Store {
        /// Colours.
        color: Vec<StoreOp>,
        /// Depth and stencil.
        depth_stencil: Option<(StoreOp, StoreOp)>,
    },
}

/// A fragment of the pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct FragmentEvent {
    /// Number of the draw in its pass.
    pub draw: u32,
    /// Its label.
    pub label: String,
    /// Number of the primitive in the draw, instances in turn.
    pub primitive: u32,
    /// Number of the triangle in the primitive.
    pub piece: u32,
    /// The primitive faces the viewer.
    pub front: bool,
    /// Where the fragment ended.
    pub end: FragmentEnd,
    /// Its depth as it would be stored.
    pub depth: Option<u32>,
    /// The depth test's function; `None` without depth attachment, as what follows.
    pub compare: Option<CompareFunction>,
    /// The depth bounds, as they would be stored, where the test is on.
    pub bounds: Option<[u32; 2]>,
    /// Stencil state.
    pub stencil: Option<StencilUse>,
    /// Smallest and largest depth of the primitive in the 8×8 block.
    pub span: [u32; 2],
    /// Smallest and largest depth that the block held.
    pub stored: [u32; 2],
    /// Bits of the varyings that the draw has; `None` where the shader was not run.
    pub varyings: Option<Vec<u32>>,
    /// What the shader gave each colour attachment, as bits; `None` where it gave nothing.
    pub outputs: Option<Vec<[u32; 4]>>,
    /// Packets of the block that the shader is run for before the pixel's.
    pub(super) packets_before: u32,
    /// Number among all fragments of the pixel's place, of whatever pass.
    pub(super) number: usize,
}

/// What the stencil stage is told, and what it does to the fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StencilUse {
    /// State of the side that the primitive shows.
    pub face: StencilFaceState,
    /// The reference value.
    pub reference: u8,
    /// The operation that was applied; `None` where the fragment did not come so far.
    pub op: Option<StencilOperation>,
}

/// Puts the events together; `first` and `last` are what the attachments held before the
/// frame and hold after it.
pub(super) fn events(
    recording: &Recording,
    attachments: &Attachments,
    found: &[Found],
    first: Vec<Value>,
    last: &[Value],
) -> Result<Vec<PixelEvent>, HistoryError> {
    let mut chain = Chain {
        attachments,
        now: first,
        events: Vec::new(),
    };
    let mut found = found.iter().enumerate().peekable();
    for (number, pass) in recording.list.passes.iter().enumerate() {
        let is_followed = attachments.has(pass);
        if is_followed {
            chain.load(number, pass);
        }
        while let Some((i, f)) = found.next_if(|(_, f)| f.pass == number) {
            if is_followed {
                chain.fragment(pass, i, f)?;
            }
        }
        if is_followed {
            chain.store(number, pass);
        }
    }
    chain.end(last)
}

/// Events so far, and what the attachments hold after them.
struct Chain<'a> {
    attachments: &'a Attachments,
    now: Vec<Value>,
    events: Vec<PixelEvent>,
}

/// The numbers of a pass's attachments: depth-stencil, and colours.
type Slots = (Option<usize>, Vec<usize>);

impl Chain<'_> {
    fn slots(&self, pass: &RenderPass) -> Slots {
        let find = |t, s| self.attachments.find(t, s);
        let depth = pass.depth_stencil.as_ref();
        let color = pass.color.iter();
        (
            depth.and_then(|a| find(a.texture, a.subresource)),
            color
                .filter_map(|a| find(a.texture, a.subresource))
                .collect(),
        )
    }

    /// Adds an event after which the attachments hold `after`.
    fn push(&mut self, pass: (usize, &RenderPass), kind: EventKind, after: Vec<Value>) {
        let (depth, color) = self.slots(pass.1);
        let change = |attachment: usize| Change {
            attachment,
            before: self.now[attachment],
            after: after[attachment],
        };
        self.events.push(PixelEvent {
            pass: pass.0,
            pass_label: pass.1.label.clone(),
            kind,
            depth_stencil: depth.map(change),
            color: color.into_iter().map(change).collect(),
        });
        self.now = after;
    }

    fn load(&mut self, number: usize, pass: &RenderPass) {
        let (depth, color) = self.slots(pass);
        let mut after = self.now.clone();
        for (a, slot) in pass.color.iter().zip(color) {
            let format = self.attachments.list[slot].format;
            match a.load {
                LoadOp::Load => {}
                LoadOp::Clear(c) => after[slot] = Value::Color(format.stored_color(c)),
                LoadOp::DontCare => after[slot] = Value::Color([0; 4]),
            }
        }
        if let (Some(a), Some(slot)) = (&pass.depth_stencil, depth)
            && let Value::DepthStencil(z, s) = after[slot]
        {
            let format = self.attachments.list[slot].format;
            let z = loaded(a.depth_load, z, |v| format.stored_depth(v));
            after[slot] = Value::DepthStencil(z, loaded(a.stencil_load, s, |v| v));
        }
        let kind = EventKind::Load {
            color: pass.color.iter().map(|a| a.load).collect(),
            depth_stencil: pass
                .depth_stencil
                .as_ref()
                .map(|a| (a.depth_load, a.stencil_load)),
        };
        self.push((number, pass), kind, after);
    }

    fn store(&mut self, number: usize, pass: &RenderPass) {
        let color: Vec<StoreOp> = pass.color.iter().map(|a| a.store).collect();
        let depth = pass.depth_stencil.as_ref();
        let depth_stencil = depth.map(|a| (a.depth_store, a.stencil_store));
        let ends = depth_stencil.into_iter().flat_map(|(z, s)| [z, s]);
        if !color
            .iter()
            .copied()
            .chain(ends)
            .any(|s| s == StoreOp::Discard)
        {
            return;
        }
        let (slot, slots) = self.slots(pass);
        let mut after = self.now.clone();
        for (_, slot) in color
            .iter()
            .zip(slots)
            .filter(|(s, _)| **s == StoreOp::Discard)
        {
            after[slot] = Value::Color([0; 4]);
        }
        if let (Some((z_store, s_store)), Some(slot)) = (depth_stencil, slot)
            && let Value::DepthStencil(z, s) = after[slot]
        {
            let kept = |store| store == StoreOp::Store;
            let z = if kept(z_store) { z } else { 0 };
            after[slot] = Value::DepthStencil(z, if kept(s_store) { s } else { 0 });
        }
        let kind = EventKind::Store {
            color,
            depth_stencil,
        };
        self.push((number, pass), kind, after);
    }

    fn fragment(
        &mut self,
        pass: &RenderPass,
        number: usize,
        f: &Found,
    ) -> Result<(), HistoryError> {
        let draw = &pass.draws[f.access.draw as usize];
        let (depth, color) = self.slots(pass);
        let mut after = self.now.clone();
        let r = &f.record;
        let at = |when: usize| Value::DepthStencil(r.stored_depth[when], r.stencil[when]);
        let depth_values = depth.map(|slot| (slot, at(0), at(1)));
        let colors = color.iter().zip(r.color);
        let colors = colors.map(|(slot, c)| (*slot, Value::Color(c[0]), Value::Color(c[1])));
        for (slot, found, left) in depth_values.into_iter().chain(colors) {
            if self.now[slot] != found {
                return Err(self.broken((f.pass, &draw.label), slot, found));
            }
            after[slot] = left;
        }
        let format = depth.map(|slot| self.attachments.list[slot].format);
        let event = fragment_event(draw, pass, format, number, f);
        self.push((f.pass, pass), EventKind::Fragment(Box::new(event)), after);
        Ok(())
    }

    fn broken(&self, (pass, label): (usize, &str), slot: usize, found: Value) -> HistoryError {
        HistoryError::Broken {
            pass,
            label: label.to_owned(),
            what: self.attachments.list[slot].label.clone(),
            left: format!("{:?}", self.now[slot]),
            found: format!("{found:?}"),
        }
    }

    fn end(self, last: &[Value]) -> Result<Vec<PixelEvent>, HistoryError> {
        match (0..last.len()).find(|&slot| self.now[slot] != last[slot]) {
            Some(slot) => {
                let passes = self.events.last().map_or(0, |e| e.pass);
                Err(self.broken((passes, "the end of the frame"), slot, last[slot]))
            }
            None => Ok(self.events),
        }
    }
}

fn loaded<T: Default, C>(op: LoadOp<C>, now: T, stored: impl Fn(C) -> T) -> T {
    match op {
        LoadOp::Load => now,
        LoadOp::Clear(v) => stored(v),
        LoadOp::DontCare => T::default(),
    }
}

fn fragment_event(
    draw: &Draw,
    pass: &RenderPass,
    format: Option<Format>,
    number: usize,
    f: &Found,
) -> FragmentEvent {
    let (a, r) = (&f.access, &f.record);
    let state = &draw.pipeline.depth_stencil;
    let is_attached = pass.depth_stencil.is_some();
    let varyings = draw.pipeline.vertex.varyings().len().min(MAX_VARYINGS);
    FragmentEvent {
        draw: a.draw,
        label: draw.label.clone(),
        primitive: a.primitive,
        piece: a.piece,
        front: a.front,
        end: r.end,
        depth: r.depth,
        compare: is_attached.then_some(state.depth.compare),
        bounds: bounds(draw, format),
        stencil: is_attached.then(|| stencil_use(draw, a.front, r.end)),
        span: a.span,
        stored: a.stored,
        varyings: r.varyings.map(|v| v[..varyings].to_vec()),
        outputs: r.source.map(|s| s[..pass.color.len()].to_vec()),
        packets_before: packets_before(draw, is_attached, f),
        number,
    }
}

/// The depth bounds as they are stored, where there is depth and the test is on.
fn bounds(draw: &Draw, format: Option<Format>) -> Option<[u32; 2]> {
    let bounds = draw.pipeline.depth_stencil.depth.bounds?;
    let format = format?;
    Some(bounds.map(|b| format.stored_depth(b)))
}

/// How many packets of two rows the shader is run for above the pixel's.
fn packets_before(draw: &Draw, is_attached: bool, f: &Found) -> u32 {
    let e = &f.access.ended;
    let shaded = match is_late(draw, is_attached, f.access.front) {
        true => f.access.covered,
        false => f.access.covered & !(e.bounds | e.stencil | e.depth),
    };
    let packets = f.probe[1] % 8 / 2;
    (0..packets)
        .filter(|k| (shaded >> (16 * k)) as u16 != 0)
        .count() as u32
}

/// Whether the draw's tests wait for its shader.
fn is_late(draw: &Draw, is_attached: bool, front: bool) -> bool {
    let state = &draw.pipeline.depth_stencil;
    let face = if front {
        state.stencil.front
    } else {
        state.stencil.back
    };
    let ops = [face.fail_op, face.depth_fail_op, face.pass_op];
    let changes = face.write_mask != 0 && ops.iter().any(|o| *o != StencilOperation::Keep);
    let writes = is_attached && (state.depth.write || changes);
    let outputs = draw.pipeline.fragment.as_ref().map(|f| f.outputs());
    outputs.is_some_and(|o| o.depth || (o.discards && writes))
}

fn stencil_use(draw: &Draw, front: bool, end: FragmentEnd) -> StencilUse {
    let stencil = &draw.pipeline.depth_stencil.stencil;
    let face = if front { stencil.front } else { stencil.back };
    StencilUse {
        face,
        reference: draw.stencil_reference[usize::from(!front)],
        op: match end {
            FragmentEnd::Stencil => Some(face.fail_op),
            FragmentEnd::Depth => Some(face.depth_fail_op),
            FragmentEnd::Written => Some(face.pass_op),
            // A shader that does not come first discards what has passed.
            FragmentEnd::Discarded if !is_late(draw, true, front) => Some(face.pass_op),
            FragmentEnd::Hiz | FragmentEnd::Bounds | FragmentEnd::Discarded => None,
        },
    }
}
