//! Block accesses of a recorded frame as rows of words.

use gnomon::raster::{AccessBatch, AccessObserver, BlockAccess};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

/// Words of an access, in the order of `ACCESS` in `_dtypes.py`.
pub(crate) const WORDS: usize = 22;

/// Accesses so far.
pub(crate) struct Accesses {
    rows: Vec<[u64; WORDS]>,
    /// Memory was short; what came then was not kept.
    short: bool,
}

impl Accesses {
    /// Asks for memory for so many; a file may say anything, so that too much is no error yet.
    pub(crate) fn with_room(count: u64) -> Self {
        let mut rows = Vec::new();
        let count = usize::try_from(count.min(MOST_AHEAD)).unwrap_or(0);
        let short = rows.try_reserve_exact(count).is_err();
        Self { rows, short }
    }

    /// The rows, if memory sufficed.
    pub(crate) fn rows(self) -> PyResult<Vec<[u64; WORDS]>> {
        match self.short {
            false => Ok(self.rows),
            true => Err(PyMemoryError::new_err(format!(
                "memory is short for the accesses of the frame, {} bytes each",
                8 * WORDS
            ))),
        }
    }
}

/// Rows that memory is asked for before there is one.
const MOST_AHEAD: u64 = 1 << 20;

impl AccessObserver for Accesses {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        if self.short || self.rows.try_reserve(batch.blocks.len()).is_err() {
            self.short = true;
            return;
        }
        self.rows.extend(batch.blocks.iter().map(|b| row(pass, b)));
    }
}

/// Two numbers in a word, `low` first in memory.
fn pair(low: u32, high: u32) -> u64 {
    (u64::from(low) | u64::from(high) << 32).to_le()
}

fn row(pass: usize, b: &BlockAccess) -> [u64; WORDS] {
    let [x, y] = b.block.map(u32::from);
    let flags = u32::from(b.front)
        | u32::from(b.hiz_read) << 8
        | u32::from(b.hiz_write) << 16
        | u32::from(b.ended.hiz) << 24;
    let [r0, r1, r2, r3] = b.color_read;
    let [w0, w1, w2, w3] = b.color_write;
    let masks = [
        b.covered,
        b.z_read,
        b.z_write,
        b.stencil_read,
        b.stencil_write,
        r0,
        r1,
        r2,
        r3,
        w0,
        w1,
        w2,
        w3,
        b.ended.bounds,
        b.ended.stencil,
        b.ended.depth,
        b.ended.discarded,
    ];
    let mut words = [0; WORDS];
    words[0] = pair(pass as u32, b.draw);
    words[1] = pair(b.primitive, b.piece);
    words[2] = pair(x | y << 16, flags);
    for (word, mask) in words[3..20].iter_mut().zip(masks) {
        *word = mask.to_le();
    }
    words[20] = pair(b.span[0], b.span[1]);
    words[21] = pair(b.stored[0], b.stored[1]);
    words
}
