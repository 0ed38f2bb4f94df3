//! Replaying: a frame is drawn again, and must be what it was.

use gnomon_raster::shader::ShaderTable;
use gnomon_raster::{
    AccessBatch, AccessObserver, BlockAccess, Gpu, GpuConfig, Recording, SubmitReport, Wants,
};

use crate::error::TraceError;
use crate::format::v1::{Hashes, TileHash};
use crate::hashes::{DrawHashes, TILE};
use crate::run;
use crate::trace::{HASH, TRAF, Trace};

/// How far a replay is verified.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReplayDepth {
    /// What passes leave; where that differs, draws too.
    #[default]
    Ends,
    /// What passes leave and what draws leave, in any case.
    Draws,
}

/// A frame that was drawn again.
pub struct Replayed {
    /// The frame.
    pub recording: Recording,
    /// The GPU that drew it, its textures as the frame leaves them.
    pub gpu: Gpu,
    /// What was counted.
    pub report: SubmitReport,
    /// Attachments that were compared, over all passes.
    pub attachments: usize,
    /// Draws that were compared; 0 where passes sufficed.
    pub draws: usize,
    /// The first difference.
    pub difference: Option<ReplayDifference>,
}

/// Where a replay is not what was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplayDifference {
    /// The pass, by number.
    pub pass: usize,
    /// The pass's label.
    pub pass_label: String,
    /// The first attachment that differs at the pass's end, such as `color 0 'image'`;
    /// `None` where all are equal there.
    pub attachment: Option<String>,
    /// The first draw that left something else; `None` where no draws were recorded.
    pub draw: Option<DrawDifference>,
}

/// The first draw that is not what was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawDifference {
    /// Its number in the pass.
    pub draw: usize,
    /// Its label.
    pub label: String,
    /// Column and row of the tile of 64×64 pixels.
    pub tile: [u16; 2],
    /// Pixels of the tile that the draw wrote to, then or now: the difference is among
    /// them.
    pub pixels: u32,
    /// Those of them that it wrote to only then, or only now; `None` where no accesses were
    /// recorded. Where there are none, the values are others.
    pub apart: Option<u32>,
    /// The first of those, or else of all, row by row from the top.
    pub first: Option<[u32; 2]>,
    /// Name and version of its shader.
    pub shader: String,
}

impl core::fmt::Display for ReplayDifference {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match &self.draw {
            Some(d) => write!(f, "differs first at draw {} '{}'", d.draw, d.label)?,
            None => write!(f, "differs")?,
        }
        write!(f, " of pass {} '{}'", self.pass, self.pass_label)?;
        if let Some(attachment) = &self.attachment {
            write!(f, ", {attachment}")?;
        }
        let Some(d) = &self.draw else {
            return write!(f, "; no draws were recorded to tell more");
        };
        let [x, y] = d.tile;
        write!(f, ", tile ({x},{y}): among {} pixels", d.pixels)?;
        if let Some(apart) = d.apart {
            write!(f, ", {apart} of them written only then or only now")?;
        }
        if let Some([x, y]) = d.first {
            write!(f, ", first ({x},{y})")?;
        }
        write!(f, "; shader {}", d.shader)
    }
}

/// Draws a frame of `trace` with the shaders of `table` and compares it.
///
/// # Errors
/// The frame cannot be had, or the GPU refuses it. A difference is none.
pub fn replay(
    trace: &Trace,
    frame: usize,
    table: &ShaderTable,
    config: GpuConfig,
    depth: ReplayDepth,
) -> Result<Replayed, TraceError> {
    let recording = trace.recording(frame, table)?;
    let hashes = trace.hashes(frame)?;
    if hashes.ends.len() != recording.list.passes.len() {
        return Err(trace.missing(HASH, frame));
    }
    let (mut attachments, mut difference) = (0, None);
    let mut ends = run::EndHashes::default();
    let (gpu, report) = run::guarded(frame, || {
        let mut gpu = Gpu::new(config)?;
        let report = run::draw_passes(&mut gpu, &recording, |gpu, number, pass| {
            let now = ends.of(gpu, pass)?;
            attachments += now.len();
            if difference.is_none() {
                difference = end_difference(&recording, number, &hashes, &now);
            }
            Ok(())
        })?;
        Ok((gpu, report))
    })?;
    let mut replayed = Replayed {
        gpu,
        report,
        attachments,
        draws: 0,
        difference,
        recording,
    };
    let wanted = replayed.difference.is_some() || depth == ReplayDepth::Draws;
    if wanted && !hashes.draws.is_empty() {
        replayed.compare_draws(trace, frame, &hashes, config)?;
    }
    Ok(replayed)
}

/// The first attachment of a pass that is not what it was.
fn end_difference(
    recording: &Recording,
    number: usize,
    hashes: &Hashes,
    now: &[u128],
) -> Option<ReplayDifference> {
    let then = &hashes.ends[number];
    let differs = |i: &usize| then.get(*i) != now.get(*i);
    let first = (0..then.len().max(now.len())).find(differs)?;
    let pass = &recording.list.passes[number];
    let id = run::attachments(pass).get(first).map(|(id, _)| *id);
    let label = id.and_then(|id| recording.texture(id).ok());
    let label = label.map_or("", |t| t.descriptor().label.as_str());
    let kind = match pass.color.len() {
        n if first < n => format!("color {first}"),
        _ => "depth-stencil".to_owned(),
    };
    Some(ReplayDifference {
        pass: number,
        pass_label: pass.label.clone(),
        attachment: Some(format!("{kind} '{label}'")),
        draw: None,
    })
}

impl Replayed {
    fn compare_draws(
        &mut self,
        trace: &Trace,
        frame: usize,
        then: &Hashes,
        config: GpuConfig,
    ) -> Result<(), TraceError> {
        let unskipped = GpuConfig {
            skip: false,
            ..config
        };
        let now = run::guarded(frame, || DrawHashes::of(&self.recording, unskipped))?.lists();
        let passes = &self.recording.list.passes;
        self.draws = passes.iter().map(|p| p.draws.len()).sum();
        let mut passes = then.draws.iter().zip(&now).enumerate();
        let first = passes.find_map(|(i, (a, b))| first_difference(a, b).map(|at| (i, at)));
        let Some((pass, (draw, tile))) = first else {
            return Ok(());
        };
        let mut pixels = Pixels {
            at: (pass, draw, tile),
            run: 0,
            written: Default::default(),
        };
        self.observe(frame, unskipped, &mut pixels)?;
        let recorded = trace.has(TRAF, frame as u32, pass as u32);
        if recorded {
            pixels.run = 1;
            trace.events(frame, &mut pixels)?;
        }
        let list = &self.recording.list.passes[pass];
        let label = list.draws.get(draw as usize).map(|d| d.label.clone());
        let shader = trace.shader_of(frame, [pass, draw as usize]);
        // Hashes at the end of a pass tell the attachment, if it is this pass.
        let ends = self.difference.take().filter(|d| d.pass == pass);
        self.difference = Some(ReplayDifference {
            pass,
            pass_label: list.label.clone(),
            attachment: ends.and_then(|d| d.attachment),
            draw: Some(DrawDifference {
                draw: draw as usize,
                label: label.unwrap_or_default(),
                tile,
                pixels: pixels.count(|[a, b]| a | b),
                apart: recorded.then(|| pixels.count(|[a, b]| a ^ b)),
                first: match recorded {
                    true => pixels.first(|[a, b]| a ^ b),
                    false => None,
                }
                .or_else(|| pixels.first(|[a, b]| a | b)),
                shader: shader.unwrap_or_default(),
            }),
        });
        Ok(())
    }

    /// Draws the frame once more.
    fn observe(
        &self,
        frame: usize,
        config: GpuConfig,
        observer: &mut dyn AccessObserver,
    ) -> Result<(), TraceError> {
        run::guarded(frame, || {
            let mut gpu = Gpu::new(config)?;
            gpu.load(&self.recording)?;
            gpu.submit_observed(&self.recording.list, Wants::default(), observer)?;
            Ok(())
        })
    }
}

/// The first draw and tile that are not in both lists alike.
fn first_difference(then: &[TileHash], now: &[TileHash]) -> Option<(u32, [u16; 2])> {
    let at = then.iter().zip(now).position(|(a, b)| a != b);
    let at = at.unwrap_or(then.len().min(now.len()));
    let key = |t: &TileHash| (t.draw, t.tile);
    let (a, b) = (then.get(at).map(key), now.get(at).map(key));
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// Pixels that a draw writes to in a tile.
struct Pixels {
    at: (usize, u32, [u16; 2]),
    /// Of which run the next accesses are: now (0), then (1).
    run: usize,
    /// Of both runs, by block row and column.
    written: std::collections::BTreeMap<[u16; 2], [u64; 2]>,
}

impl Pixels {
    fn count(&self, which: impl Fn([u64; 2]) -> u64) -> u32 {
        self.written.values().map(|m| which(*m).count_ones()).sum()
    }

    fn first(&self, which: impl Fn([u64; 2]) -> u64) -> Option<[u32; 2]> {
        let pixels = self.written.iter().flat_map(|([row, column], masks)| {
            let mask = which(*masks);
            let set = (0..64u32).filter(move |i| mask >> i & 1 != 0);
            set.map(move |i| {
                let (x, y) = (8 * u32::from(*column), 8 * u32::from(*row));
                [y + i / 8, x + i % 8]
            })
        });
        pixels.min().map(|[y, x]| [x, y])
    }
}

impl AccessObserver for Pixels {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        let here = |b: &&BlockAccess| (pass, b.draw, b.block.map(|b| b / TILE)) == self.at;
        for b in batch.blocks.iter().filter(here) {
            let color = b.color_write.iter().fold(0, |m, w| m | w);
            let mask = b.z_write | b.stencil_write | color;
            let masks = self.written.entry([b.block[1], b.block[0]]).or_default();
            masks[self.run] |= mask;
        }
    }
}
