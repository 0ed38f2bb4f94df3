//! What each draw of a frame left behind, as a hash a tile: it tells where two runs part.

use std::collections::BTreeMap;

use gnomon_raster::{
    AccessBatch, AccessObserver, BlockLeft, Error, Gpu, GpuConfig, Recording, SubmitReport, Wants,
};

use crate::format::v1::TileHash;
use crate::witness::Contents;

/// Side of a tile in 8×8 blocks.
pub(crate) const TILE: u16 = 8;

/// Hashes of what each draw left behind, by pass, draw, and tile of 64×64 pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawHashes {
    passes: Vec<Vec<BTreeMap<[u16; 2], u64>>>,
}

impl DrawHashes {
    /// Runs `recording` on a new GPU and watches what each draw leaves in its blocks.
    ///
    /// # Errors
    /// What the GPU refuses.
    pub fn of(recording: &Recording, config: GpuConfig) -> Result<Self, Error> {
        Self::measure(recording, config).map(|(hashes, _)| hashes)
    }

    /// The same, with what the run counted: watching changes no counter.
    ///
    /// # Errors
    /// What the GPU refuses.
    pub fn measure(
        recording: &Recording,
        config: GpuConfig,
    ) -> Result<(Self, SubmitReport), Error> {
        let mut gpu = Gpu::new(config)?;
        gpu.load(recording)?;
        let draws = recording.list.passes.iter().map(|p| p.draws.len());
        let mut hashes = Hashing::new(draws);
        let wants = Wants {
            left: Some(&Contents),
            ..Wants::default()
        };
        let report = gpu.submit_observed(&recording.list, wants, &mut hashes)?;
        Ok((hashes.done(), report))
    }

    /// Of each pass, its tiles by draw, column and row, as they are written down.
    pub(crate) fn lists(&self) -> Vec<Vec<TileHash>> {
        let list = |draws: &Vec<BTreeMap<[u16; 2], u64>>| {
            let draws = draws.iter().enumerate();
            let tiles = draws.flat_map(|(draw, tiles)| tiles.iter().map(move |t| (draw, t)));
            let hash = |(draw, (tile, hash)): (usize, (&[u16; 2], &u64))| TileHash {
                draw: draw as u32,
                tile: *tile,
                hash: *hash,
            };
            tiles.map(hash).collect()
        };
        self.passes.iter().map(list).collect()
    }

    /// Tiles that draw number `draw` of pass number `pass` wrote to.
    #[must_use]
    pub fn tiles(&self, pass: usize, draw: usize) -> Option<&BTreeMap<[u16; 2], u64>> {
        self.passes.get(pass)?.get(draw)
    }
}

/// Gathers what draws left in their blocks.
pub(crate) struct Hashing {
    hashes: DrawHashes,
}

impl Hashing {
    /// For passes with that many draws each.
    pub(crate) fn new(draws: impl Iterator<Item = usize>) -> Self {
        let passes = draws.map(|n| vec![BTreeMap::new(); n]).collect();
        Self {
            hashes: DrawHashes { passes },
        }
    }

    /// The hashes of all that was heard.
    pub(crate) fn done(self) -> DrawHashes {
        self.hashes
    }
}

impl AccessObserver for Hashing {
    /// A tile is the sum over its blocks.
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let tile = |b: &BlockLeft| (b.draw, [b.block[0] / TILE, b.block[1] / TILE]);
        for blocks in batch.left.chunk_by(|a, b| tile(a) == tile(b)) {
            let (draw, tile) = tile(&blocks[0]);
            let tiles = &mut self.hashes.passes[pass][draw as usize];
            let sum = tiles.entry(tile).or_insert(0);
            let all = blocks.iter().map(|b| mix(b.block, b.seen));
            *sum = all.fold(*sum, u64::wrapping_add);
        }
    }
}

/// A block's share in the hash of its tile: another for the same content elsewhere.
fn mix(block: [u16; 2], seen: u64) -> u64 {
    let place = u64::from(block[0]) << 16 | u64::from(block[1]);
    let mut x = seen ^ place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93);
    x ^ x >> 32
}
