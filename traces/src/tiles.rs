//! What draws left in tiles of 64×64 pixels, as hashes: tells where two runs part.

use std::collections::BTreeMap;

use gnomon_raster::BlockAccess;

use crate::format::v1::TileHash;
use crate::witness::hash_of;

/// Side of a tile in blocks.
const TILE: u16 = 8;

/// The tile of a block: row, column.
pub(crate) fn tile_of(block: [u16; 2]) -> [u16; 2] {
    [block[1] / TILE, block[0] / TILE]
}

/// Gathers the hashes of a pass: of each block what the draw's last event left there.
#[derive(Default)]
pub(crate) struct TileHashes {
    done: Vec<TileHash>,
    draw: u32,
    blocks: BTreeMap<[u16; 2], u64>,
}

impl TileHashes {
    /// The next event of the pass.
    pub(crate) fn hear(&mut self, event: &BlockAccess) {
        if event.draw != self.draw {
            self.close();
            self.draw = event.draw;
        }
        if event.witness != 0 {
            self.blocks.insert(event.block, hash_of(event.witness));
        }
    }

    /// The hashes, by draw, row and column; nothing is kept.
    pub(crate) fn take(&mut self) -> Vec<TileHash> {
        self.close();
        self.draw = 0;
        core::mem::take(&mut self.done)
    }

    fn close(&mut self) {
        let mut tiles: BTreeMap<[u16; 2], u64> = BTreeMap::new();
        for (block, seen) in core::mem::take(&mut self.blocks) {
            let sum = tiles.entry(tile_of(block)).or_insert(0);
            *sum = sum.wrapping_add(mix(block, seen));
        }
        let draw = self.draw;
        let tiles = tiles.into_iter();
        let hashes = tiles.map(|(tile, hash)| TileHash { draw, tile, hash });
        self.done.extend(hashes);
    }
}

/// A block's share in the hash of its tile: another for the same content elsewhere.
fn mix(block: [u16; 2], seen: u64) -> u64 {
    let place = u64::from(block[0]) << 16 | u64::from(block[1]);
    let mut x = seen ^ place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93);
    x ^ x >> 32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hashes(events: &[(u32, [u16; 2], u64)]) -> Vec<TileHash> {
        let mut all = TileHashes::default();
        for &(draw, block, witness) in events {
            all.hear(&BlockAccess {
                draw,
                block,
                witness,
                ..BlockAccess::default()
            });
        }
        all.take()
    }

    #[test]
    fn the_last_event_of_a_draw_counts_wherever_it_is() {
        let seen = hashes(&[(0, [3, 9], 512), (0, [1, 2], 256), (1, [8, 0], 256)]);
        let places: Vec<_> = seen.iter().map(|t| (t.draw, t.tile)).collect();
        assert_eq!(places, [(0, [0, 0]), (0, [1, 0]), (1, [0, 1])]);
        let again = hashes(&[
            (0, [1, 2], 768),
            (0, [1, 2], 256),
            (0, [3, 9], 512),
            (1, [8, 0], 256),
            (1, [8, 1], 0),
        ]);
        assert_eq!(seen, again);
        let moved = hashes(&[(0, [2, 2], 256)]);
        assert_ne!(moved[0].hash, seen[0].hash, "another place");
    }
}
