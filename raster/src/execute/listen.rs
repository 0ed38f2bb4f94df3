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

/// Accesses that triangles may make together before they are handed over.
const ACCESSES: u64 = 1 << 16;

/// How many times the memory of an access goes with each, of what is wanted.
fn weight(wants: Wants<'_>) -> u64 {
    match (wants.outputs, wants.texels) {
        (true, _) => 8,
        (false, true) => 2,
        (false, false) => 1,
    }
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

/// Triangles of a chunk that run together.
#[derive(Debug, PartialEq)]
pub(super) struct Piece {
    /// Number of the chunk in its batch.
    pub(super) chunk: usize,
    pub(super) triangles: Range<u32>,
}

impl Piece {
    /// Each chunk whole.
    pub(super) fn all(chunks: &[Chunk]) -> Vec<Self> {
        let all = chunks.iter().enumerate();
        all.map(|(chunk, c)| Self {
            chunk,
            triangles: 0..c.triangles.len() as u32,
        })
        .collect()
    }
}

/// Cuts chunks into runs whose accesses wait in memory together: at least a triangle each.
pub(super) fn runs(chunks: &[Chunk], wants: Wants<'_>) -> Vec<Vec<Piece>> {
    let blocks = |c: &Chunk| c.triangles.iter().map(|t| t.most_blocks()).collect();
    let blocks: Vec<Vec<u64>> = chunks.iter().map(blocks).collect();
    cut(&blocks, ACCESSES / weight(wants))
}

/// Cuts chunks of triangles that touch at most so many blocks into runs of no more than
/// `whole`, where a triangle has no more.
fn cut(chunks: &[Vec<u64>], whole: u64) -> Vec<Vec<Piece>> {
    let mut runs = vec![Vec::new()];
    let mut room = whole;
    for (chunk, blocks) in chunks.iter().enumerate() {
        let mut start = 0;
        for (triangle, &most) in blocks.iter().enumerate() {
            if room < most && room < whole {
                push(&mut runs, chunk, start..triangle);
                runs.push(Vec::new());
                (start, room) = (triangle, whole);
            }
            room = room.saturating_sub(most);
        }
        push(&mut runs, chunk, start..blocks.len());
    }
    runs
}

fn push(runs: &mut [Vec<Piece>], chunk: usize, triangles: Range<usize>) {
    if let (false, Some(run)) = (triangles.is_empty(), runs.last_mut()) {
        let triangles = triangles.start as u32..triangles.end as u32;
        run.push(Piece { chunk, triangles });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut_of(chunks: &[&[u64]], whole: u64) -> Vec<Vec<(usize, Range<u32>)>> {
        let chunks: Vec<_> = chunks.iter().map(|c| c.to_vec()).collect();
        let runs = cut(&chunks, whole).into_iter();
        runs.map(|run| run.into_iter().map(|p| (p.chunk, p.triangles)).collect())
            .collect()
    }

    #[test]
    fn runs_hold_what_fits_and_at_least_a_triangle() {
        let chunks: [&[u64]; 4] = [&[1, 2, 3], &[], &[9, 1], &[4]];
        assert_eq!(
            cut_of(&chunks, 5),
            [
                vec![(0, 0..2)],
                vec![(0, 2..3)],
                vec![(2, 0..1)],
                vec![(2, 1..2), (3, 0..1)],
            ]
        );
        assert_eq!(cut_of(&chunks, 100), [[(0, 0..3), (2, 0..2), (3, 0..1)]]);
        // Load and store operations are there without triangles.
        assert_eq!(cut_of(&[&[]], 5), [[]]);
    }
}
