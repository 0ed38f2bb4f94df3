//! What a report shows of a frame, as plain data: passes and draws with their bytes.

use gnomon_raster::{ClientTraffic, Counters, GpuConfig, SubmitReport, Traffic};

use crate::shape::{DrawShape, FrameShape};

/// Bytes of a client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClientBytes {
    /// The client: `z`, `stencil`, `color[0]` and so on.
    pub client: String,
    /// Bytes read.
    pub read: u64,
    /// Bytes written.
    pub write: u64,
}

impl ClientBytes {
    /// In both directions.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.read + self.write
    }
}

/// A pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassRow {
    /// Its label.
    pub label: String,
    /// What its draws counted.
    pub counters: Counters,
    /// Logical bytes of its draws and clears.
    pub clients: Vec<ClientBytes>,
}

/// A draw.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawRow {
    /// Number of its pass.
    pub pass: usize,
    /// Its pass's label.
    pub pass_label: String,
    /// Its number in the pass.
    pub draw: usize,
    /// Its label.
    pub label: String,
    /// What it counted.
    pub counters: Counters,
    /// Logical bytes.
    pub clients: Vec<ClientBytes>,
    /// Why zmin/zmax of blocks were not used; `None` where they were.
    pub hiz_disabled: Option<&'static str>,
}

impl DrawRow {
    /// Bytes of all clients.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.clients.iter().map(ClientBytes::total).sum()
    }
}

impl PassRow {
    /// Bytes of all clients.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.clients.iter().map(ClientBytes::total).sum()
    }
}

/// A frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// In submission order.
    pub passes: Vec<PassRow>,
    /// In submission order.
    pub draws: Vec<DrawRow>,
}

impl FrameReport {
    /// What a frame of `shape`, drawn under `config`, counted.
    #[must_use]
    pub fn new(shape: &FrameShape, report: &SubmitReport, config: GpuConfig) -> Self {
        let mut found = Self::default();
        for (number, (pass, counted)) in shape.passes.iter().zip(&report.passes).enumerate() {
            let totals = counted.totals();
            found.passes.push(PassRow {
                label: pass.label.clone(),
                counters: totals,
                clients: clients(&[totals.traffic, counted.clear]),
            });
            let draws = pass.draws.iter().zip(&counted.draws).enumerate();
            found.draws.extend(draws.map(|(draw, (s, d))| DrawRow {
                pass: number,
                pass_label: pass.label.clone(),
                draw,
                label: d.label.clone(),
                counters: d.counters,
                clients: clients(&[d.counters.traffic]),
                hiz_disabled: hiz_disabled(s, pass.depth_stencil.is_some(), config.skip),
            }));
        }
        found
    }

    /// What all draws counted.
    #[must_use]
    pub fn totals(&self) -> Counters {
        let mut sum = Counters::default();
        self.passes.iter().for_each(|p| sum.add(&p.counters));
        sum
    }

    /// Bytes of all passes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.passes.iter().map(PassRow::bytes).sum()
    }

    /// Clients of the whole frame, in the order in which passes name them first.
    #[must_use]
    pub fn clients(&self) -> Vec<ClientBytes> {
        let mut all: Vec<ClientBytes> = Vec::new();
        for client in self.passes.iter().flat_map(|p| &p.clients) {
            match all.iter_mut().find(|c| c.client == client.client) {
                Some(sum) => {
                    sum.read += client.read;
                    sum.write += client.write;
                }
                None => all.push(client.clone()),
            }
        }
        all
    }
}

/// Sums of the clients of several counts.
fn clients(counts: &[ClientTraffic]) -> Vec<ClientBytes> {
    let mut all: Vec<ClientBytes> = Vec::new();
    for (client, traffic) in counts.iter().flat_map(ClientTraffic::named) {
        let Traffic {
            read_bytes,
            write_bytes,
            ..
        } = traffic;
        match all.iter_mut().find(|c| c.client == client) {
            Some(sum) => {
                sum.read += read_bytes;
                sum.write += write_bytes;
            }
            None => all.push(ClientBytes {
                client,
                read: read_bytes,
                write: write_bytes,
            }),
        }
    }
    all
}

/// Why Gnomon's own zmin/zmax do not skip work of a draw.
fn hiz_disabled(draw: &DrawShape, has_depth: bool, skip: bool) -> Option<&'static str> {
    let depth = &draw.depth_stencil.depth;
    let reasons = [
        (!has_depth, "no depth attachment"),
        (!skip, "skipping is off"),
        (!depth.compare.reads_stored(), "no depth test"),
        (depth.bounds.is_some(), "depth bounds"),
        (
            draw.fragment.is_some_and(|f| f.depth),
            "shader writes depth",
        ),
    ];
    let found = reasons.into_iter().find(|(holds, _)| *holds);
    found.map(|(_, reason)| reason)
}
