//! Block-level access events, for consumers that model caches, replay or explain.
//!
//! Events stream: a pass hands them over in batches while it runs, so that no more
//! than a batch of them is ever in memory, and the batches one after the other are the
//! same on every machine, however they are cut.

use crate::MAX_COLOR_ATTACHMENTS;
use crate::gpu::PassReport;

/// What one primitive did to one 8×8 block. Bit `8·row + column` is a pixel.
///
/// Every covered pixel ends once: [`Ended`] and what was written partition `covered`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockAccess {
    /// Number of the draw in its render pass.
    pub draw: u32,
    /// Number of the primitive in its draw, instances in turn.
    pub primitive: u32,
    /// Number of the triangle in its primitive (clipping and lines make several).
    pub piece: u32,
    /// Block column and row; pixel = 8 × block.
    pub block: [u16; 2],
    /// Fragments generated.
    pub covered: u64,
    /// Pixels whose depth was read.
    pub z_read: u64,
    /// Pixels whose depth was written.
    pub z_write: u64,
    /// Pixels whose stencil was read.
    pub stencil_read: u64,
    /// Pixels whose stencil was written.
    pub stencil_write: u64,
    /// Pixels whose colour was read, by attachment.
    pub color_read: [u64; MAX_COLOR_ATTACHMENTS],
    /// Pixels whose colour was written, by attachment.
    pub color_write: [u64; MAX_COLOR_ATTACHMENTS],
    /// Where the fragments ended that were not written.
    pub ended: Ended,
    /// Smallest and largest depth of the primitive's plane over all 64 pixels of the
    /// block, as it is stored (the D24 integer, or the bits of a float), bias and the
    /// viewport's limits included. A shader may have written other depths. `[0; 2]`
    /// without depth attachment, or where [`Wants::depth_ranges`] is not set.
    pub span: [u32; 2],
    /// Smallest and largest depth that the block held before, over its pixels inside
    /// the image; `[0; 2]` where [`Self::span`] is.
    pub stored: [u32; 2],
    /// The primitive faces the viewer.
    pub front: bool,
    /// The zmin/zmax entry was read.
    pub hiz_read: bool,
    /// The zmin/zmax entry was written.
    pub hiz_write: bool,
}

/// Events wait in memory by the hundred thousand.
const _: () = assert!(size_of::<BlockAccess>() == 184);

/// Where fragments ended that were not written: disjoint parts of
/// [`BlockAccess::covered`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// All of them, by zmin/zmax.
    pub hiz: bool,
    /// At the depth bounds test.
    pub bounds: u64,
    /// At the stencil test.
    pub stencil: u64,
    /// At the depth test.
    pub depth: u64,
    /// Discarded by the shader.
    pub discarded: u64,
}

impl BlockAccess {
    /// Fragments that passed all tests and were not discarded.
    #[must_use]
    pub fn written(&self) -> u64 {
        let e = &self.ended;
        match e.hiz {
            true => 0,
            false => self.covered & !(e.bounds | e.stencil | e.depth | e.discarded),
        }
    }
}

/// What an observer wants to be told beside what costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// [`BlockAccess::span`] and [`BlockAccess::stored`], for which blocks are looked at
    /// that no test needs.
    pub depth_ranges: bool,
}

/// Some accesses of a render pass.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct AccessBatch<'a> {
    /// Ordered by draw, primitive, piece, block row, block column; all of them after
    /// those of the batch before.
    pub blocks: &'a [BlockAccess],
}

impl<'a> AccessBatch<'a> {
    /// A batch of `blocks`, to feed an observer by hand.
    #[must_use]
    pub fn new(blocks: &'a [BlockAccess]) -> Self {
        Self { blocks }
    }
}

/// Receives the accesses of render passes; it may be called on any thread, by one at a
/// time.
pub trait AccessObserver: Send {
    /// The next accesses of pass number `pass` in the command list. The batches of a
    /// pass, one after the other, are the same on every machine; where one ends and the
    /// next begins is not to be relied on. A pass without accesses has none.
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>);

    /// The pass is over, accesses or none; `report` is what it counted.
    fn end(&mut self, pass: usize, report: &PassReport) {
        let _ = (pass, report);
    }
}
