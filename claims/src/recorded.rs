//! Frames recorded in files, and judged by a profile of memory without being drawn again:
//! no shader is at hand.

use std::collections::BTreeSet;

use gnomon_pipeline::technique::{PassRole, Roles};
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::{AccessBatch, AccessObserver, BlockAccess, PassReport};
use gnomon_traces::profile::{Client, Judge, Profile, ProfileError, Traffic, profile};
use gnomon_traces::{DrawShape, FrameShape, Meta, RecordOptions, Trace, TraceError, record};

use super::lab::parsed;
use super::{Lab, ReproduceError};

/// A recorded frame, with what its passes are for.
pub(super) struct Recorded {
    trace: Trace,
    shape: FrameShape,
    roles: Roles,
}

/// Bytes that draws read and write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Moved {
    /// Of depth and stencil.
    pub(super) depth_stencil: [u64; 2],
    /// Of the first colour attachment.
    pub(super) color: [u64; 2],
    /// Of the texture in the first slot.
    pub(super) texture: u64,
}

impl Moved {
    /// Of attachments, both ways.
    pub(super) fn attachments(&self) -> u64 {
        self.depth_stencil.iter().chain(&self.color).sum()
    }
}

/// A level of the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    /// What commands ask for: 3 bytes of depth, 1 of stencil.
    Asked,
    /// What the profile's memory moves.
    Moved,
}

impl Recorded {
    /// Records one frame, and opens the file anew.
    pub(super) fn new(
        lab: &Lab,
        scene: &Scene,
        (technique, set): (&str, &[&str]),
        size: [u32; 2],
    ) -> Result<Self, ReproduceError> {
        let (technique, params) = parsed(technique, set)?;
        let frame = technique.frame(scene, size, &params)?;
        let options = RecordOptions {
            gpu: lab.settings().gpu,
            ..RecordOptions::default()
        };
        let file = record(Meta::new(&scene.name), &frame.recording, options)?;
        let trace = Trace::read(file.to_bytes().to_vec())?;
        Ok(Self {
            shape: trace.shape(0)?,
            trace,
            roles: frame.roles,
        })
    }

    /// The frame under a profile.
    pub(super) fn judge(&self, profile: &Profile) -> Result<Traffic, ReproduceError> {
        let mut judge = Judge::new(profile, &self.shape)?;
        self.trace.events(0, &mut judge)?;
        Ok(judge.finish())
    }

    /// What the draws of all passes that are for one of `roles` move; clears are no draws.
    pub(super) fn moved(&self, traffic: &Traffic, roles: &[PassRole], level: Level) -> Moved {
        self.moved_by(traffic, roles, level, |_| true)
    }

    /// The same of the draws among them that `wanted` names.
    pub(super) fn moved_by(
        &self,
        traffic: &Traffic,
        roles: &[PassRole],
        level: Level,
        wanted: impl Fn(&DrawShape) -> bool,
    ) -> Moved {
        let mut sum = Moved::default();
        let draw = |pass: Option<usize>, draw: Option<usize>| {
            self.shape.passes.get(pass?)?.draws.get(draw?)
        };
        let rows = traffic.rows.iter();
        let rows = rows.filter(|r| draw(r.pass, r.draw).is_some_and(&wanted));
        for row in rows.filter(|r| self.is_for(r.pass, roles)) {
            let of = |client| {
                let levels = row.client(client);
                let amount = match level {
                    Level::Asked => levels.logical,
                    Level::Moved => levels.dram,
                };
                [amount.read_bytes, amount.write_bytes]
            };
            add(&mut sum.depth_stencil, of(Client::DepthStencil));
            add(&mut sum.color, of(Client::Color(0)));
            sum.texture += of(Client::Texture(0))[0];
        }
        sum
    }

    fn is_for(&self, pass: Option<usize>, roles: &[PassRole]) -> bool {
        let role = pass.and_then(|p| self.roles.passes().get(p));
        role.is_some_and(|r| roles.contains(r))
    }

    /// Pairs of triangle and tile of `1 << shift` pixels a side that draws of these passes
    /// meet.
    pub(super) fn tiles_met(&self, roles: &[PassRole], shift: u32) -> Result<u64, ReproduceError> {
        let mut tiles = Tiles {
            wanted: self
                .roles
                .passes()
                .iter()
                .map(|r| roles.contains(r))
                .collect(),
            shift,
            triangle: None,
            met: BTreeSet::new(),
            count: 0,
        };
        self.trace.events(0, &mut tiles)?;
        Ok(tiles.count)
    }

    /// Bytes of a pixel of the first colour attachment of the first pass for one of `roles`.
    pub(super) fn color_bytes(&self, roles: &[PassRole]) -> u64 {
        let passes = self.shape.passes.iter().enumerate();
        let mut wanted = passes.filter(|(i, _)| self.is_for(Some(*i), roles));
        let color = wanted.find_map(|(_, p)| p.color.first());
        color.map_or(1, |a| self.shape.textures[a.texture.index()].format.bytes())
    }

    /// Bytes of a texel in the first slot of draws of these passes.
    pub(super) fn texel_bytes(&self, roles: &[PassRole]) -> u64 {
        let passes = self.shape.passes.iter().enumerate();
        let wanted = passes.filter(|(i, _)| self.is_for(Some(*i), roles));
        let mut draws = wanted.flat_map(|(_, p)| &p.draws);
        let bound = draws.find_map(|d| d.textures.first());
        bound.map_or(1, |b| self.shape.textures[b.texture.index()].format.bytes())
    }
}

fn add(sum: &mut [u64; 2], more: [u64; 2]) {
    sum.iter_mut().zip(more).for_each(|(s, m)| *s += m);
}

/// Memory without caches and without HiZ, which moves a word for each access: what papers
/// count that count accesses.
pub(super) fn uncached() -> Result<Profile, ReproduceError> {
    Ok(profile("naive")?)
}

/// Counts the tiles that each triangle meets.
struct Tiles {
    /// By pass.
    wanted: Vec<bool>,
    shift: u32,
    /// Pass, draw and primitive that come in.
    triangle: Option<(usize, u32, u32)>,
    met: BTreeSet<[u32; 2]>,
    count: u64,
}

impl Tiles {
    fn meet(&mut self, pass: usize, e: &BlockAccess) {
        let triangle = Some((pass, e.draw, e.primitive));
        if self.triangle != triangle {
            self.triangle = triangle;
            self.count += self.met.len() as u64;
            self.met.clear();
        }
        let [x, y] = e.block.map(|b| 8 * u32::from(b));
        let mut left = e.covered;
        while left != 0 {
            let bit = left.trailing_zeros();
            let pixel = [x + bit % 8, y + bit / 8];
            self.met.insert(pixel.map(|p| p >> self.shift));
            // Blocks lie in one tile, unless tiles are smaller.
            left = if self.shift >= 3 {
                0
            } else {
                left & (left - 1)
            };
        }
    }
}

impl AccessObserver for Tiles {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        if self.wanted.get(pass) == Some(&true) {
            batch.blocks.iter().for_each(|e| self.meet(pass, e));
        }
    }

    fn end(&mut self, _: usize, _: &PassReport) {
        self.count += self.met.len() as u64;
        self.met.clear();
        self.triangle = None;
    }
}

impl From<TraceError> for ReproduceError {
    fn from(error: TraceError) -> Self {
        Self::Recorded(error.to_string())
    }
}

impl From<ProfileError> for ReproduceError {
    fn from(error: ProfileError) -> Self {
        Self::Recorded(error.to_string())
    }
}
