//! Gathering the fragments of the probed pixel.

use gnomon_raster::{AccessBatch, AccessObserver, BlockAccess, FragmentRecord};

/// A fragment of the pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) pass: usize,
    /// The pixel.
    pub(super) probe: [u32; 2],
    /// What its primitive did to the block.
    pub(super) access: BlockAccess,
    pub(super) record: FragmentRecord,
}

/// Keeps the fragments, and of accesses only theirs.
pub(super) struct Collector {
    pub(super) probe: [u32; 2],
    pub(super) found: Vec<Found>,
}

impl AccessObserver for Collector {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let found = batch.fragments.iter().map(|record| Found {
            pass,
            probe: self.probe,
            access: batch.blocks[record.event as usize],
            record: *record,
        });
        self.found.extend(found);
    }
}
