//! Handing block accesses to an observer, batch by batch.

use core::ops::Range;

use rayon::prelude::*;

use super::order::Order;
use crate::geometry::Chunk;
use crate::observer::{
    AccessBatch, AccessObserver, BlockAccess, BlockLeft, FragmentRecord, ShadedBlock, TexelAccess,
    Wants,
};
use crate::tile::{Gathered, Turn};

/// Primitives of a chunk while somebody listens: no fewer can be held back.
const CHUNK: u32 = 32;
/// Accesses that chunks may make together before they are handed over.
const ACCESSES: u64 = 1 << 13;

/// How many times the memory of an access goes with each, of what is wanted.
fn weight(wants: Wants<'_>) -> u32 {
    match (wants.outputs, wants.texels) {
        (true, _) => 8,
        (false, true) => 2,
        (false, false) => 1,
    }
}

/// Primitives of a chunk for an observer who wants this.
pub(super) fn chunk(wants: Wants<'_>) -> u32 {
    CHUNK / weight(wants)
}

/// An observer of one pass, and the accesses that it has not seen yet.
pub(super) struct Listener<'a> {
    pub(super) wants: Wants<'a>,
    observer: &'a mut dyn AccessObserver,
    pass: usize,
    batch: Batch,
}

impl<'a> Listener<'a> {
    pub(super) fn new(wants: Wants<'a>, observer: &'a mut dyn AccessObserver, pass: usize) -> Self {
        Self {
            wants,
            observer,
            pass,
            batch: Batch::default(),
        }
    }

    /// Hands over what the workers gathered since the last time.
    pub(super) fn hear<'d>(
        &mut self,
        gathered: impl Iterator<Item = &'d mut Gathered>,
        parallel: bool,
    ) {
        let batch = &mut self.batch;
        batch.clear();
        gathered.for_each(|g| batch.take(g, parallel));
        // What draws left can be told behind their last events.
        if batch.blocks.is_empty() && batch.left.is_empty() {
            return;
        }
        batch.sort(parallel);
        let whole = AccessBatch {
            blocks: &batch.blocks,
            texels: &batch.texels,
            fragments: &batch.fragments,
            outputs: &batch.outputs,
            values: &batch.values,
            left: &batch.left,
        };
        self.observer.batch(self.pass, &whole);
    }
}

/// What all workers gathered.
#[derive(Default)]
struct Batch {
    blocks: Vec<BlockAccess>,
    turns: Vec<Turn>,
    texels: Vec<TexelAccess>,
    fragments: Vec<FragmentRecord>,
    outputs: Vec<ShadedBlock>,
    values: Vec<u32>,
    left: Vec<BlockLeft>,
    order: Order,
    /// Memory for blocks in their order.
    ordered: Vec<BlockAccess>,
}

impl Batch {
    fn clear(&mut self) {
        self.blocks.clear();
        self.turns.clear();
        self.texels.clear();
        self.fragments.clear();
        self.outputs.clear();
        self.values.clear();
        self.left.clear();
    }

    /// Takes over what one worker gathered, of several if `parallel`.
    fn take(&mut self, from: &mut Gathered, parallel: bool) {
        let (event, value) = (self.blocks.len() as u32, self.values.len() as u32);
        append(&mut self.blocks, &mut from.blocks, parallel, |_| {});
        append(&mut self.turns, &mut from.turns, parallel, |_| {});
        append(&mut self.texels, from.texels.folded(), parallel, |t| {
            t.event += event
        });
        append(&mut self.fragments, &mut from.fragments, parallel, |f| {
            f.event += event;
        });
        append(&mut self.outputs, &mut from.outputs, parallel, |o| {
            (o.event, o.first) = (o.event + event, o.first + value);
        });
        append(&mut self.values, &mut from.values, parallel, |_| {});
        append(&mut self.left, &mut from.left, parallel, |_| {});
    }

    /// Orders events, and with them what belongs to them, so that nothing tells who has
    /// gathered it.
    fn sort(&mut self, parallel: bool) {
        let order = self.order.of(&self.turns);
        self.ordered.clear();
        self.ordered.reserve(order.len());
        for &event in order {
            self.ordered.push(self.blocks[event as usize]);
        }
        core::mem::swap(&mut self.blocks, &mut self.ordered);
        self.left
            .sort_unstable_by_key(|l| (l.draw, l.block[1], l.block[0]));
        if self.texels.is_empty() && self.fragments.is_empty() && self.outputs.is_empty() {
            return;
        }
        let mut rank = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            rank[old as usize] = new as u32;
        }
        self.sort_outputs(&rank);
        let new = |event: &mut u32| *event = rank[*event as usize];
        self.texels.iter_mut().for_each(|t| new(&mut t.event));
        self.fragments.iter_mut().for_each(|f| new(&mut f.event));
        let texel = |t: &TexelAccess| (t.event, t.slot, t.mip, t.layer, t.block[1], t.block[0]);
        sort_by_key(&mut self.texels, parallel, texel);
        self.fragments.sort_unstable_by_key(|f| f.event);
    }

    /// Orders outputs by their events' new numbers, and moves their values after them.
    fn sort_outputs(&mut self, rank: &[u32]) {
        let ends = self.outputs.iter().skip(1).map(|o| o.first);
        let ends: Vec<u32> = ends.chain([self.values.len() as u32]).collect();
        let mut parts: Vec<_> = self.outputs.drain(..).zip(ends).collect();
        parts
            .iter_mut()
            .for_each(|(o, _)| o.event = rank[o.event as usize]);
        parts.sort_unstable_by_key(|(o, _)| o.event);
        let mut values = Vec::with_capacity(self.values.len());
        for (output, end) in parts {
            let first = values.len() as u32;
            values.extend_from_slice(&self.values[output.first as usize..end as usize]);
            self.outputs.push(ShadedBlock { first, ..output });
        }
        self.values = values;
    }
}

/// Moves what a worker gathered to the end of `to`, each entry changed.
fn append<T>(to: &mut Vec<T>, from: &mut Vec<T>, parallel: bool, change: impl Fn(&mut T)) {
    from.iter_mut().for_each(change);
    if parallel {
        // Other workers may gather as much the next time: keep no memory for each.
        to.append(&mut core::mem::take(from));
    } else {
        core::mem::swap(to, from);
    }
}

fn sort_by_key<T: Send, K: Ord>(list: &mut [T], parallel: bool, key: impl Fn(&T) -> K + Sync) {
    if parallel {
        list.par_sort_unstable_by_key(key);
    } else {
        list.sort_unstable_by_key(key);
    }
}

/// Cuts chunks into runs whose accesses wait in memory together: at least a chunk each.
pub(super) fn runs(chunks: &[Chunk], wants: Wants<'_>) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let whole = ACCESSES / u64::from(weight(wants));
    let (mut start, mut room) = (0, whole);
    for (i, chunk) in chunks.iter().enumerate() {
        let most = chunk.triangles.iter().map(|t| t.most_blocks()).sum();
        if room < most && start < i {
            runs.push(start..i);
            (start, room) = (i, whole);
        }
        room = room.saturating_sub(most);
    }
    runs.push(start..chunks.len());
    runs
}
