//! Who pays: bytes by draw, client, place and pixel, with the same sum each way.

use gnomon_raster::{MAX_COLOR_ATTACHMENTS, MAX_TEXTURES};
use serde::Serialize;

/// Bytes in both directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Amount {
    /// Bytes read.
    pub read_bytes: u64,
    /// Bytes written.
    pub write_bytes: u64,
}

impl Amount {
    /// Both directions.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.read_bytes + self.write_bytes
    }

    fn add(&mut self, o: &Self) {
        self.read_bytes += o.read_bytes;
        self.write_bytes += o.write_bytes;
    }
}

/// Bytes at each level of the memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Levels {
    /// What the commands ask for, after the profile's HiZ, in the aspects' own bytes.
    pub logical: Amount,
    /// Between the units and their caches: whole words, depth and stencil in one.
    pub cache: Amount,
    /// Between caches and memory.
    pub dram: Amount,
}

impl Levels {
    /// Adds another's.
    pub fn add(&mut self, o: &Self) {
        self.logical.add(&o.logical);
        self.cache.add(&o.cache);
        self.dram.add(&o.dram);
    }

    fn at(&mut self, level: Level) -> &mut Amount {
        match level {
            Level::Logical => &mut self.logical,
            Level::Cache => &mut self.cache,
            Level::Dram => &mut self.dram,
        }
    }
}

/// A level of the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    Logical,
    Cache,
    Dram,
}

/// Which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Read,
    Write,
}

/// A client of the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Client {
    /// Depth and stencil.
    DepthStencil,
    /// A colour attachment.
    Color(u8),
    /// A texture slot.
    Texture(u8),
    /// Vertex data.
    Vertex,
    /// Indices.
    Index,
    /// HiZ or LRZ entries.
    Hiz,
    /// Polygon lists of tilers.
    PolygonList,
    /// The display.
    Scanout,
}

/// How many clients there are.
pub(super) const CLIENTS: usize = 6 + MAX_COLOR_ATTACHMENTS + MAX_TEXTURES;
const TEXTURES: usize = 1 + MAX_COLOR_ATTACHMENTS;
const OTHERS: usize = TEXTURES + MAX_TEXTURES;

impl Client {
    /// All of them, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        let color = (0..MAX_COLOR_ATTACHMENTS as u8).map(Self::Color);
        let textures = (0..MAX_TEXTURES as u8).map(Self::Texture);
        let others = [
            Self::Vertex,
            Self::Index,
            Self::Hiz,
            Self::PolygonList,
            Self::Scanout,
        ];
        let first = core::iter::once(Self::DepthStencil);
        first.chain(color).chain(textures).chain(others)
    }

    pub(super) fn index(self) -> usize {
        match self {
            Self::DepthStencil => 0,
            Self::Color(i) => 1 + usize::from(i),
            Self::Texture(i) => TEXTURES + usize::from(i),
            Self::Vertex => OTHERS,
            Self::Index => OTHERS + 1,
            Self::Hiz => OTHERS + 2,
            Self::PolygonList => OTHERS + 3,
            Self::Scanout => OTHERS + 4,
        }
    }
}

impl core::fmt::Display for Client {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::DepthStencil => write!(f, "zs"),
            Self::Color(i) => write!(f, "color[{i}]"),
            Self::Texture(i) => write!(f, "tex[{i}]"),
            Self::Vertex => write!(f, "vertex"),
            Self::Index => write!(f, "index"),
            Self::Hiz => write!(f, "hiz"),
            Self::PolygonList => write!(f, "plist"),
            Self::Scanout => write!(f, "scanout"),
        }
    }
}

/// Shares of `total` in proportion to `weights`; they add up to it: what rounding down
/// leaves goes to the largest remainders, of equal ones to the first.
pub(super) fn shares(total: u64, weights: &[u64]) -> Vec<u64> {
    let sum: u128 = weights.iter().map(|w| u128::from(*w)).sum();
    if sum == 0 {
        let mut all = vec![0; weights.len()];
        all.iter_mut().take(1).for_each(|s| *s = total);
        return all;
    }
    let exact = |w: &u64| u128::from(total) * u128::from(*w);
    let mut all: Vec<u64> = weights.iter().map(|w| (exact(w) / sum) as u64).collect();
    let left = total - all.iter().sum::<u64>();
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by_key(|i| (u128::MAX - exact(&weights[*i]) % sum, *i));
    order.iter().take(left as usize).for_each(|i| all[*i] += 1);
    all
}

/// Where something is charged.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    /// Draw, pass or frame.
    pub(super) row: u32,
    pub(super) client: Client,
    /// Block of the picture, or the one that stands for everywhere else.
    pub(super) cell: u32,
    /// Its pixels.
    pub(super) mask: u64,
}

/// All that was charged.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Ledger {
    pub(super) rows: Vec<[Levels; CLIENTS]>,
    /// By client, then cell; empty for clients that charged nothing.
    pub(super) cells: Vec<Vec<Levels>>,
    /// By cell and pixel, where asked for.
    pub(super) pixels: Option<Vec<Levels>>,
    /// Write-backs that each row forced on dirty lines.
    pub(super) evicted: Vec<u64>,
    /// Bytes of write-backs at the end of the frame, by client.
    pub(super) flushed: [u64; CLIENTS],
    cell_count: usize,
}

impl Ledger {
    /// `cells` are those of the picture and one more.
    pub(super) fn new(rows: usize, cells: usize, pixels: bool) -> Self {
        Self {
            rows: vec![[Levels::default(); CLIENTS]; rows],
            cells: vec![Vec::new(); CLIENTS],
            pixels: pixels.then(|| vec![Levels::default(); 64 * cells]),
            evicted: vec![0; rows],
            flushed: [0; CLIENTS],
            cell_count: cells,
        }
    }

    /// Charges row, cell and pixels.
    pub(super) fn charge(&mut self, at: At, level: Level, way: Way, bytes: u64) {
        if bytes != 0 {
            self.charge_row(at, level, way, bytes);
            self.charge_place(at, level, way, bytes);
        }
    }

    pub(super) fn charge_row(&mut self, at: At, level: Level, way: Way, bytes: u64) {
        let amount = self.rows[at.row as usize][at.client.index()].at(level);
        add(amount, way, bytes);
    }

    pub(super) fn charge_place(&mut self, at: At, level: Level, way: Way, bytes: u64) {
        let cells = &mut self.cells[at.client.index()];
        if cells.is_empty() {
            cells.resize(self.cell_count, Levels::default());
        }
        add(cells[at.cell as usize].at(level), way, bytes);
        if let Some(pixels) = &mut self.pixels {
            let pixels = &mut pixels[64 * at.cell as usize..][..64];
            spread(pixels, at.mask, |p, b| add(p.at(level), way, b), bytes);
        }
    }
}

fn add(amount: &mut Amount, way: Way, bytes: u64) {
    match way {
        Way::Read => amount.read_bytes += bytes,
        Way::Write => amount.write_bytes += bytes,
    }
}

/// Equal shares for the pixels of `mask`, one byte more for the first of them; all for
/// the first pixel where there is none.
fn spread(pixels: &mut [Levels], mask: u64, charge: impl Fn(&mut Levels, u64), bytes: u64) {
    let mask = if mask == 0 { 1 } else { mask };
    let count = u64::from(mask.count_ones());
    let (each, mut more) = (bytes / count, bytes % count);
    let mut left = mask;
    while left != 0 {
        let extra = u64::from(more > 0);
        charge(&mut pixels[left.trailing_zeros() as usize], each + extra);
        more -= extra;
        left &= left - 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_and_follow_the_largest_remainder() {
        assert_eq!(shares(64, &[1, 1, 1]), [22, 21, 21]);
        assert_eq!(shares(10, &[1, 3, 2]), [2, 5, 3]);
        assert_eq!(shares(7, &[0, 0]), [7, 0]);
        assert_eq!(shares(256, &[u64::MAX, u64::MAX]), [128, 128]);
    }

    #[test]
    fn clients_have_places_of_their_own() {
        let places: Vec<usize> = Client::all().map(Client::index).collect();
        assert_eq!(places, (0..CLIENTS).collect::<Vec<_>>());
    }
}
