//! Gathering what shaders give.

use gnomon_raster::{AccessBatch, AccessObserver, MAX_COLOR_ATTACHMENTS, Recording, RenderPass};

use super::fragment::{Entry, Outputs};

/// Outputs by pass and draw.
pub(super) struct Collector {
    pub(super) passes: Vec<Vec<Outputs>>,
}

impl Collector {
    pub(super) fn new(recording: &Recording) -> Self {
        let passes = recording.list.passes.iter();
        let draws = |p: &RenderPass| p.draws.iter().map(|_| Outputs::default()).collect();
        Self {
            passes: passes.map(draws).collect(),
        }
    }
}

impl AccessObserver for Collector {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let starts = batch.outputs.iter().skip(1).map(|o| o.first as usize);
        let ends = starts.chain([batch.values.len()]);
        for (shaded, end) in batch.outputs.iter().zip(ends) {
            let access = &batch.blocks[shaded.event as usize];
            let outputs = &mut self.passes[pass][access.draw as usize];
            let mut integers = [0; MAX_COLOR_ATTACHMENTS];
            integers.copy_from_slice(&shaded.integers);
            outputs.entries.push(Entry {
                primitive: access.primitive,
                block: access.block,
                discarded: shaded.discarded,
                kept: shaded.shaded & !shaded.discarded,
                integers,
                first: outputs.values.len(),
            });
            let values = &batch.values[shaded.first as usize..end];
            outputs.values.extend_from_slice(values);
        }
    }
}
