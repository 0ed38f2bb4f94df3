//! Handing block accesses to an observer, batch by batch.

use core::ops::Range;

use rayon::prelude::*;

use crate::geometry::Chunk;
use crate::observer::{AccessBatch, AccessObserver, BlockAccess, Wants};

/// Primitives of a chunk while somebody listens: no fewer can be held back.
pub(super) const CHUNK: u32 = 32;
/// Accesses that chunks may make together before they are handed over.
const ACCESSES: u64 = 1 << 18;

/// An observer of one pass, and the accesses that it has not seen yet.
pub(super) struct Listener<'a> {
    pub(super) wants: Wants<'a>,
    observer: &'a mut dyn AccessObserver,
    pass: usize,
    blocks: Vec<BlockAccess>,
}

impl<'a> Listener<'a> {
    pub(super) fn new(wants: Wants<'a>, observer: &'a mut dyn AccessObserver, pass: usize) -> Self {
        Self {
            wants,
            observer,
            pass,
            blocks: Vec::new(),
        }
    }

    /// Hands over what the workers gathered since the last time.
    pub(super) fn hear<'d>(
        &mut self,
        gathered: impl Iterator<Item = &'d mut Vec<BlockAccess>>,
        parallel: bool,
    ) {
        self.blocks.clear();
        for list in gathered {
            if self.blocks.is_empty() && !parallel {
                core::mem::swap(&mut self.blocks, list);
            } else {
                // Other workers may gather as much the next time: keep no memory for each.
                self.blocks.extend(core::mem::take(list));
            }
        }
        let order = |a: &BlockAccess| (a.draw, a.primitive, a.piece, a.block[1], a.block[0]);
        if parallel {
            self.blocks.par_sort_unstable_by_key(order);
        } else {
            self.blocks.sort_unstable_by_key(order);
        }
        if !self.blocks.is_empty() {
            let batch = AccessBatch::new(&self.blocks);
            self.observer.batch(self.pass, &batch);
        }
    }
}

/// Cuts chunks into runs whose accesses wait in memory together: at least a chunk each.
pub(super) fn runs(chunks: &[Chunk]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let (mut start, mut room) = (0, ACCESSES);
    for (i, chunk) in chunks.iter().enumerate() {
        let most = chunk.triangles.iter().map(|t| t.most_blocks()).sum();
        if room < most && start < i {
            runs.push(start..i);
            (start, room) = (i, ACCESSES);
        }
        room = room.saturating_sub(most);
    }
    runs.push(start..chunks.len());
    runs
}
