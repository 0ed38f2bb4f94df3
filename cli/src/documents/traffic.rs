//! Traffic as rows, for JSON, CSV and tables; of places as arrays.

use gnomon_traces::profile::{Client, Levels, PassMerge, Traffic, TrafficRow};
use serde::Serialize;

/// What a profile makes of a recorded frame.
#[derive(Serialize)]
pub struct TrafficDocument {
    pub(crate) trace: String,
    pub(crate) profile: String,
    pub(crate) by: &'static str,
    /// Textures have cache and dram bytes; otherwise look-ups were not recorded.
    pub(crate) texels_recorded: bool,
    /// Of tilers with `--per-pass-merged`: which passes go on in the tiles of those before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) merges: Option<Vec<MergeDocument>>,
    pub(crate) rows: Vec<RowDocument>,
    pub(crate) totals: Levels,
}

/// What traffic is added up by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum By {
    /// Render passes
    Pass,
    /// Draws, and what passes do outside of them
    Draw,
    /// Clients of the memory
    Client,
    /// Blocks of 8x8 pixels of the picture
    Tile,
    /// Pixels of the picture
    Pixel,
}

impl By {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Pass,
        Self::Draw,
        Self::Client,
        Self::Tile,
        Self::Pixel,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Draw => "draw",
            Self::Client => "client",
            Self::Tile => "tile",
            Self::Pixel => "pixel",
        }
    }
}

/// dram bytes in both directions of all clients, by tile or by pixel, row by row; empty
/// where `by` is no place, or pixels were not judged.
pub fn dram_bytes(traffic: &Traffic, by: By) -> Vec<u64> {
    match by {
        By::Pixel => {
            let pixels = traffic.pixels().map(|(pixels, _)| pixels);
            let pixels = pixels.unwrap_or_default();
            pixels.iter().map(|l| l.dram.bytes()).collect()
        }
        By::Tile => {
            let [columns, rows] = traffic.grid;
            let mut sums = vec![0; (columns * rows) as usize];
            for client in Client::all() {
                let cells = traffic.cells(client).iter();
                (sums.iter_mut().zip(cells)).for_each(|(sum, l)| *sum += l.dram.bytes());
            }
            sums
        }
        By::Pass | By::Draw | By::Client => Vec::new(),
    }
}

#[derive(Serialize)]
pub(crate) struct MergeDocument {
    pub(crate) key: String,
    pub(crate) merged: bool,
    pub(crate) refused_reason: Option<String>,
}

#[derive(Serialize)]
pub(crate) struct RowDocument {
    pub(crate) key: String,
    pub(crate) client: String,
    #[serde(flatten)]
    pub(crate) levels: Levels,
    pub(crate) hiz: HizDocument,
}

#[derive(Clone, Default, Serialize)]
pub(crate) struct HizDocument {
    pub(crate) disabled_reason: Option<String>,
}

impl TrafficDocument {
    /// Of the file called `trace`. `merged`: passes were allowed to go on in the tiles of those before.
    pub fn new(trace: &str, traffic: &Traffic, by: By, merged: bool) -> Self {
        Self {
            trace: trace.to_owned(),
            profile: traffic.profile.clone(),
            by: by.name(),
            texels_recorded: traffic.texels_recorded,
            merges: merged.then(|| traffic.merges.iter().map(MergeDocument::new).collect()),
            rows: rows(traffic, by),
            totals: traffic.total(),
        }
    }
}

impl MergeDocument {
    fn new(merge: &PassMerge) -> Self {
        Self {
            key: format!("{} {}", merge.pass, merge.label),
            merged: merge.refused.is_none(),
            refused_reason: merge.refused.as_ref().map(|r| r.to_string()),
        }
    }
}

fn rows(traffic: &Traffic, by: By) -> Vec<RowDocument> {
    match by {
        By::Draw => traffic.rows.iter().flat_map(draw_rows).collect(),
        By::Pass => pass_rows(traffic),
        By::Client => client_rows(traffic),
        By::Tile => tile_rows(traffic),
        By::Pixel => pixel_rows(traffic),
    }
}

fn row(key: &str, client: &str, levels: Levels) -> Option<RowDocument> {
    (levels != Levels::default()).then(|| RowDocument {
        key: key.to_owned(),
        client: client.to_owned(),
        levels,
        hiz: HizDocument::default(),
    })
}

fn key(row: &TrafficRow) -> String {
    match (row.pass, row.draw) {
        (Some(pass), Some(draw)) => format!("{pass}/{draw} {}", row.label),
        (Some(pass), None) => format!("{pass} {}", row.label),
        _ => row.label.clone(),
    }
}

fn draw_rows(of: &TrafficRow) -> Vec<RowDocument> {
    let key = key(of);
    let clients = Client::all();
    let rows = clients.filter_map(|c| row(&key, &c.to_string(), of.client(c)));
    let mut rows: Vec<RowDocument> = rows.collect();
    for row in &mut rows {
        row.hiz.disabled_reason = of.disabled.map(|r| r.to_string());
    }
    rows
}

fn pass_rows(traffic: &Traffic) -> Vec<RowDocument> {
    let passes = traffic.rows.chunk_by(|a, b| a.pass == b.pass);
    passes.flat_map(pass_row).collect()
}

fn pass_row(rows: &[TrafficRow]) -> Vec<RowDocument> {
    let key = rows.last().map(key).unwrap_or_default();
    let sum = |client| {
        let mut sum = Levels::default();
        rows.iter().for_each(|r| sum.add(&r.client(client)));
        sum
    };
    let mut all: Vec<RowDocument> = Client::all()
        .filter_map(|c| row(&key, &c.to_string(), sum(c)))
        .collect();
    let hiz = HizDocument {
        disabled_reason: reasons(rows),
    };
    all.iter_mut().for_each(|r| r.hiz = hiz.clone());
    all
}

/// Each reason once, with how many draws it concerns.
pub(crate) fn reasons(rows: &[TrafficRow]) -> Option<String> {
    let draws = rows.iter().filter(|r| r.draw.is_some()).count();
    let mut found: Vec<_> = rows.iter().filter_map(|r| r.disabled).collect();
    found.sort_unstable();
    let each = found.chunk_by(|a, b| a == b);
    let each = each.map(|same| format!("{}: {} of {draws} draws", same[0], same.len()));
    let text = each.collect::<Vec<_>>().join("; ");
    (!text.is_empty()).then_some(text)
}

fn client_rows(traffic: &Traffic) -> Vec<RowDocument> {
    let clients = Client::all();
    let rows = clients.filter_map(|c| row("frame", &c.to_string(), traffic.client(c)));
    rows.collect()
}

/// What has no place in the picture comes last.
fn tile_rows(traffic: &Traffic) -> Vec<RowDocument> {
    let [columns, down] = traffic.grid;
    let mut rows = Vec::new();
    for cell in 0..=(columns * down) as usize {
        let key = match cell < (columns * down) as usize {
            true => format!("{},{}", cell as u32 % columns, cell as u32 / columns),
            false => "elsewhere".to_owned(),
        };
        let levels = |c| traffic.cells(c).get(cell).copied().unwrap_or_default();
        rows.extend(Client::all().filter_map(|c| row(&key, &c.to_string(), levels(c))));
    }
    rows
}

fn pixel_rows(traffic: &Traffic) -> Vec<RowDocument> {
    let Some((pixels, elsewhere)) = traffic.pixels() else {
        return Vec::new();
    };
    let width = traffic.size[0] as usize;
    let at =
        |(i, levels): (usize, Levels)| row(&format!("{},{}", i % width, i / width), "all", levels);
    let mut rows: Vec<RowDocument> = pixels.into_iter().enumerate().filter_map(at).collect();
    rows.extend(row("elsewhere", "all", elsewhere));
    rows
}
