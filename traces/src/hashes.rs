//! What each draw of a frame left behind, as a hash a tile: it tells where two frames part.

use gnomon_raster::{
    AccessBatch, AccessObserver, Error, Gpu, GpuConfig, PassReport, Recording, Wants,
};

use crate::format::v1::TileHash;
use crate::tiles::TileHashes;
use crate::witness::Witness;

/// Hashes of what each draw left behind, by pass, draw, and tile of 64×64 pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawHashes {
    /// By draw, row and column of the tile.
    passes: Vec<Vec<TileHash>>,
}

impl DrawHashes {
    /// Runs `recording` on a new GPU and watches what each draw leaves in its blocks.
    ///
    /// # Errors
    /// What the GPU refuses.
    pub fn of(recording: &Recording, config: GpuConfig) -> Result<Self, Error> {
        let mut gpu = Gpu::new(config)?;
        gpu.load(recording)?;
        let mut hashing = Hashing::default();
        let wants = Wants {
            witness: Some(&Witness),
            ..Wants::default()
        };
        gpu.submit_observed(&recording.list, wants, &mut hashing)?;
        Ok(Self {
            passes: hashing.passes,
        })
    }

    /// Tiles (row, column) that draw number `draw` of pass number `pass` wrote to, and
    /// what it left there.
    pub fn tiles(&self, pass: usize, draw: usize) -> impl Iterator<Item = ([u16; 2], u64)> + Clone {
        let all = self.passes.get(pass).map_or(&[][..], Vec::as_slice);
        let start = all.partition_point(|t| (t.draw as usize) < draw);
        let mine = all[start..].iter();
        mine.take_while(move |t| t.draw as usize == draw)
            .map(|t| (t.tile, t.hash))
    }
}

/// Gathers the hashes of all passes.
#[derive(Default)]
struct Hashing {
    passes: Vec<Vec<TileHash>>,
    tiles: TileHashes,
}

impl AccessObserver for Hashing {
    fn batch(&mut self, _: usize, batch: &AccessBatch<'_>) {
        batch.blocks.iter().for_each(|event| self.tiles.hear(event));
    }

    fn end(&mut self, _: usize, _: &PassReport) {
        self.passes.push(self.tiles.take());
    }
}
