//! Accesses of primitives that are rasterised together wait for one another.

use gnomon_raster::{BlockAccess, TexelAccess};

use super::Judge;

impl Judge {
    pub(super) fn accesses(&mut self, pass: usize, e: &BlockAccess, texels: &[TexelAccess]) {
        if self.event(pass, e) {
            texels.iter().for_each(|t| self.texels(pass, e, t));
        }
    }

    /// Keeps an access until all primitives that are rasterised with its own are there.
    pub(super) fn wait(&mut self, pass: usize, e: &BlockAccess, texels: &[TexelAccess]) {
        let together = self.profile.together;
        let last = self.waiting.blocks.last();
        let group = |e: &BlockAccess| (e.draw, e.primitive / together);
        if last.is_some_and(|last| group(last) != group(e)) {
            self.release(pass);
        }
        self.waiting.push(e, texels);
    }

    /// Block by block, in each by primitive.
    pub(super) fn release(&mut self, pass: usize) {
        let mut waiting = core::mem::take(&mut self.waiting);
        let image = self.plans[pass].images.iter().flatten().next();
        let place = |e: &BlockAccess| image.map_or(0, |i| i.block(e.block));
        let mut order: Vec<(u32, usize)> = waiting.blocks.iter().map(place).zip(0..).collect();
        order.sort_unstable();
        for (_, i) in order {
            let texels = &waiting.texels[waiting.range(i)];
            let e = &waiting.blocks[i];
            self.accesses(pass, e, texels);
        }
        waiting.clear();
        self.waiting = waiting;
    }
}

/// Accesses of primitives that are rasterised together.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    blocks: Vec<BlockAccess>,
    texels: Vec<TexelAccess>,
    /// Where the texels of each access end.
    ends: Vec<usize>,
}

impl Waiting {
    fn push(&mut self, e: &BlockAccess, texels: &[TexelAccess]) {
        self.blocks.push(*e);
        self.texels.extend_from_slice(texels);
        self.ends.push(self.texels.len());
    }

    fn range(&self, i: usize) -> core::ops::Range<usize> {
        let start = i.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[i]
    }

    fn clear(&mut self) {
        self.blocks.clear();
        self.texels.clear();
        self.ends.clear();
    }
}
