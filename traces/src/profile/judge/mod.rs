//! A frame's accesses, heard one after the other and charged as a profile has it.

mod ends;
mod entries;
mod waiting;
mod words;

use gnomon_raster::{AccessBatch, AccessObserver, PassReport};

use super::ProfileError;
use super::cache::Cache;
use super::charge::{At, Client, Ledger};
use super::merge::{PassMerge, merges};
use super::model::Profile;
use super::plan::{PassPlan, plans};
use super::surface::Images;
use super::tiles::Bins;
use super::traffic::{HizCounts, Traffic, TrafficRow};
use crate::shape::FrameShape;
use waiting::Waiting;

/// How to judge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JudgeOptions {
    /// Charge pixels too.
    pub pixels: bool,
    /// Passes that can go on in the tiles of those before do so; of tilers only.
    pub merged: bool,
}

/// Judges a frame: an observer of its accesses, recorded or live, with skipping off.
#[derive(Debug)]
pub struct Judge {
    profile: Profile,
    shape: FrameShape,
    images: Images,
    ledger: Ledger,
    zs: Cache,
    color: Cache,
    texture: Vec<Cache>,
    /// Of each block of depth, by its first line; see `entries.rs`.
    entries: Vec<u64>,
    plans: Vec<PassPlan>,
    merges: Vec<PassMerge>,
    hiz: Vec<HizCounts>,
    /// By texture: drawn to since it was sampled.
    drawn: Vec<bool>,
    texels_recorded: bool,
    begun: usize,
    bins: Bins,
    waiting: Waiting,
}

/// The entry of a block whose depths are those that the next access will report.
const PENDING: u64 = u64::MAX;

/// Whether a shader of the frame looks anything up.
fn reads_textures(shape: &FrameShape) -> bool {
    let mut draws = shape.passes.iter().flat_map(|p| &p.draws);
    draws.any(|d| d.fragment.is_some_and(|f| f.textures > 0))
}

impl Judge {
    /// Ready for the accesses of a frame of this shape.
    ///
    /// # Errors
    /// The hardware cannot do what the frame does.
    pub fn new(profile: &Profile, shape: &FrameShape) -> Result<Self, ProfileError> {
        Self::with_options(profile, shape, JudgeOptions::default())
    }

    /// As [`Judge::new`], with options.
    ///
    /// # Errors
    /// As [`Judge::new`].
    pub fn with_options(
        profile: &Profile,
        shape: &FrameShape,
        options: JudgeOptions,
    ) -> Result<Self, ProfileError> {
        super::support::check(profile, shape)?;
        let images = Images::new(shape);
        let merges = match options.merged {
            true => merges(profile, shape, &images),
            false => Vec::new(),
        };
        let plans = plans(profile, shape, &images, &merges);
        let rows = plans.iter().map(|p| p.draws.len() + 1).sum::<usize>() + 1;
        let cells = images.elsewhere() as usize + 1;
        let lines = images.lines.state.len();
        Ok(Self {
            ledger: Ledger::new(rows, cells, options.pixels),
            zs: Cache::new(&profile.depth_stencil),
            color: Cache::new(&profile.color),
            texture: (0..profile.texture_units)
                .map(|_| Cache::new(&profile.texture))
                .collect(),
            entries: vec![PENDING; lines],
            hiz: vec![HizCounts::default(); rows],
            drawn: vec![false; shape.textures.len()],
            texels_recorded: !reads_textures(shape),
            begun: 0,
            bins: Bins::default(),
            waiting: Waiting::default(),
            profile: profile.clone(),
            shape: shape.clone(),
            images,
            plans,
            merges,
        })
    }

    /// Whether a pass goes on in the tiles of those before.
    pub(crate) fn merges_any(&self) -> bool {
        self.merges.iter().any(|m| m.refused.is_none())
    }

    fn at(&self, row: u32, client: Client, cell: u32, mask: u64) -> At {
        At {
            row,
            client,
            cell,
            mask,
        }
    }

    /// The end of the frame: caches are written back, the picture is displayed.
    #[must_use]
    pub fn finish(mut self) -> Traffic {
        if let Some(last) = self.plans.len().checked_sub(1) {
            self.begin_through(last);
        }
        let all = 0..self.images.lines.state.len() as u32;
        let lines = &mut self.images.lines;
        self.zs.flush(lines, &mut self.ledger, all.clone(), None);
        self.color.flush(lines, &mut self.ledger, all, None);
        self.scan_out();
        Traffic {
            rows: self.rows(),
            profile: self.profile.name,
            grid: self.images.grid(),
            size: self.images.picture,
            caches: [self.zs.counts, self.color.counts],
            merges: self.merges,
            texels_recorded: self.texels_recorded,
            ledger: self.ledger,
        }
    }

    fn rows(&self) -> Vec<TrafficRow> {
        let mut rows = Vec::new();
        for (number, (pass, plan)) in self.shape.passes.iter().zip(&self.plans).enumerate() {
            for (i, (draw, hiz)) in pass.draws.iter().zip(&plan.draws).enumerate() {
                rows.push(TrafficRow {
                    disabled: hiz.test.err(),
                    ..self.row(rows.len(), Some(number), Some(i), &draw.label)
                });
            }
            rows.push(self.row(rows.len(), Some(number), None, &pass.label));
        }
        rows.push(self.row(rows.len(), None, None, "end of frame"));
        rows
    }

    fn row(
        &self,
        number: usize,
        pass: Option<usize>,
        draw: Option<usize>,
        label: &str,
    ) -> TrafficRow {
        TrafficRow {
            pass,
            draw,
            label: label.to_owned(),
            hiz: self.hiz[number],
            disabled: None,
            evicted_bytes: self.ledger.evicted[number],
            clients: self.ledger.rows[number],
        }
    }
}

impl AccessObserver for Judge {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        self.begin_through(pass);
        let mut texels = batch.texels;
        self.texels_recorded |= !texels.is_empty();
        for (i, e) in batch.blocks.iter().enumerate() {
            let mine = texels.iter().take_while(|t| t.event as usize <= i).count();
            let (mine, rest) = texels.split_at(mine);
            texels = rest;
            match self.profile.together {
                1 => self.accesses(pass, e, mine),
                _ => self.wait(pass, e, mine),
            }
        }
    }

    fn end(&mut self, pass: usize, report: &PassReport) {
        self.begin_through(pass);
        self.release(pass);
        self.vertices(pass, report);
        self.store(pass);
    }
}
