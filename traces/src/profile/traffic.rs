//! What a judged frame costs.

use serde::Serialize;

use super::cache::CacheCounts;
use super::charge::{CLIENTS, Client, Ledger, Levels};
use super::hiz::DisabledReason;
use super::merge::PassMerge;

/// What HiZ did for a draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct HizCounts {
    /// Pairs of primitive and block that were tested.
    pub tested: u64,
    /// Pairs that were thrown away.
    pub culled: u64,
    /// Pairs whose depth test was decided without reading depth.
    pub accepted: u64,
    /// Fragments in pairs that were thrown away.
    pub killed: u64,
    /// Pixels whose depth was read.
    pub z_reads: u64,
}

/// A draw, what a pass does outside of draws, or the end of the frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrafficRow {
    /// The pass; `None` for the end of the frame.
    pub pass: Option<usize>,
    /// The draw; `None` for clears, loads and stores.
    pub draw: Option<usize>,
    /// Its label.
    pub label: String,
    /// What HiZ did.
    pub hiz: HizCounts,
    /// Why it had no HiZ.
    pub disabled: Option<DisabledReason>,
    /// Bytes of other lines that it forced out of caches.
    pub evicted_bytes: u64,
    pub(super) clients: [Levels; CLIENTS],
}

impl TrafficRow {
    /// The bytes of a client.
    #[must_use]
    pub fn client(&self, client: Client) -> Levels {
        self.clients[client.index()]
    }

    /// The bytes of all clients.
    #[must_use]
    pub fn total(&self) -> Levels {
        sum(self.clients.iter())
    }
}

/// The traffic of a frame under a profile.
#[derive(Debug, PartialEq, Eq)]
pub struct Traffic {
    /// The profile's name.
    pub profile: String,
    /// Every draw, each pass behind its draws, the end of the frame.
    pub rows: Vec<TrafficRow>,
    /// Columns and rows of the picture's blocks of 8×8 pixels.
    pub grid: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Depth and stencil's cache, colour's.
    pub caches: [CacheCounts; 2],
    /// All look-ups were recorded; otherwise textures have logical bytes only.
    pub texels_recorded: bool,
    /// Where merging was asked of a tiler: of each pass but the first, whether it goes on in
    /// the tiles of those before.
    pub merges: Vec<PassMerge>,
    pub(super) ledger: Ledger,
}

impl Traffic {
    /// All of a client.
    #[must_use]
    pub fn client(&self, client: Client) -> Levels {
        sum(self.rows.iter().map(|r| &r.clients[client.index()]))
    }

    /// All of everybody.
    #[must_use]
    pub fn total(&self) -> Levels {
        let mut all = Levels::default();
        Client::all().for_each(|c| all.add(&self.client(c)));
        all
    }

    /// A client's bytes by blocks of the picture, row by row, and behind them what has no
    /// place there: light views, vertices, the display. Empty where there are none.
    #[must_use]
    pub fn cells(&self, client: Client) -> &[Levels] {
        &self.ledger.cells[client.index()]
    }

    /// All clients' bytes by pixel, row by row, and what has no place in the picture;
    /// `None` unless it was asked for.
    #[must_use]
    pub fn pixels(&self) -> Option<(Vec<Levels>, Levels)> {
        let pixels = self.ledger.pixels.as_ref()?;
        let [width, height] = self.size;
        let at = |x: u32, y: u32| {
            let cell = y / 8 * self.grid[0] + x / 8;
            pixels[(64 * cell + 8 * (y % 8) + x % 8) as usize]
        };
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let picture: Vec<Levels> = rows.map(|(x, y)| at(x, y)).collect();
        let elsewhere = 64 * (self.grid[0] * self.grid[1]) as usize;
        Some((picture, sum(pixels[elsewhere..].iter())))
    }

    /// Bytes of a client that were written back at the end of the frame; they are part of
    /// the rows of whoever made them dirty.
    #[must_use]
    pub fn flushed(&self, client: Client) -> u64 {
        self.ledger.flushed[client.index()]
    }
}

fn sum<'a>(levels: impl Iterator<Item = &'a Levels>) -> Levels {
    let mut all = Levels::default();
    levels.for_each(|l| all.add(l));
    all
}
