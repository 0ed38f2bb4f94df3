//! The emulated GPU: textures, and the execution of command lists.

use std::time::Duration;

use crate::command::CommandList;
use crate::counters::{ClientTraffic, Counters};
use crate::error::Error;
use crate::execute;
use crate::geometry::{Chunk, ShadedVertices};
use crate::observer::{AccessObserver, Wants};
use crate::recording::{RecordedTexture, Recording};
use crate::simd::SimdLevel;
use crate::texture::{Texture, TextureDescriptor, TextureId};

/// How to execute. None of it changes a bit of the results or, but for `skip`,
/// of the counters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GpuConfig {
    /// Most worker threads; 0 for as many as [`crate::worker_threads`] says. No more are
    /// started than there is work for; 1 keeps all work on the caller's thread.
    pub threads: usize,
    /// Side of execution tiles in pixels: 16, 32, 64 or 128.
    pub tile: u32,
    /// Instruction set.
    pub simd: SimdLevel,
    /// Use zmin/zmax of 8×8 blocks to skip work.
    pub skip: bool,
}

impl Default for GpuConfig {
    fn default() -> Self {
        Self {
            threads: 0,
            tile: 64,
            simd: SimdLevel::detect(),
            skip: true,
        }
    }
}

/// A GPU and its textures.
pub struct Gpu {
    pub(crate) config: GpuConfig,
    /// Most worker threads.
    pub(crate) threads: usize,
    /// Those that have been started.
    pub(crate) pool: Option<rayon::ThreadPool>,
    /// Work is shared out among them.
    pub(crate) parallel: bool,
    pub(crate) textures: Vec<Texture>,
    /// Memory of past batches, so that no frame has to ask the system for it again.
    pub(crate) recycled: Recycled,
}

/// Buffers that wait for the next batch.
#[derive(Default)]
pub(crate) struct Recycled {
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) shaded: Vec<ShadedVertices>,
}

/// What a draw counted.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawReport {
    /// The draw's label.
    pub label: String,
    /// Its counters.
    pub counters: Counters,
    /// Names of [`Counters::shader_counts`].
    pub counted: &'static [&'static str],
}

/// What a render pass counted.
#[derive(Clone, Debug)]
pub struct PassReport {
    /// The pass's label.
    pub label: String,
    /// Its draws in order.
    pub draws: Vec<DrawReport>,
    /// Writes of clears.
    pub clear: ClientTraffic,
    /// Wall-clock time of the execution.
    pub time: Duration,
}

impl PassReport {
    /// Sum over the draws, clears left out.
    #[must_use]
    pub fn totals(&self) -> Counters {
        let mut sum = Counters::default();
        self.draws.iter().for_each(|d| sum.add(&d.counters));
        sum
    }

    /// What fragment shaders counted themselves, by name, in the order of first
    /// appearance.
    #[must_use]
    pub fn shader_counts(&self) -> Vec<(&'static str, u64)> {
        let of = |d: &DrawReport| d.counted.iter().copied().zip(d.counters.shader_counts);
        sums_by_name(self.draws.iter().flat_map(of))
    }
}

/// Sums of what has one name, in the order of first appearance.
fn sums_by_name(counts: impl Iterator<Item = (&'static str, u64)>) -> Vec<(&'static str, u64)> {
    let mut all: Vec<(&'static str, u64)> = Vec::new();
    for (name, n) in counts {
        match all.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += n,
            None => all.push((name, n)),
        }
    }
    all
}

/// What a command list counted.
#[derive(Clone, Debug, Default)]
pub struct SubmitReport {
    /// Its passes in order.
    pub passes: Vec<PassReport>,
}

impl SubmitReport {
    /// What fragment shaders counted themselves, over all passes.
    #[must_use]
    pub fn shader_counts(&self) -> Vec<(&'static str, u64)> {
        sums_by_name(self.passes.iter().flat_map(PassReport::shader_counts))
    }
}

impl Gpu {
    /// A GPU without textures. Worker threads start when there is work for them.
    ///
    /// # Errors
    /// For a tile size that is not supported, too many threads, or a floating-point
    /// unit that is set to flush denormals.
    pub fn new(config: GpuConfig) -> Result<Self, Error> {
        if ![16, 32, 64, 128].contains(&config.tile) {
            return Err(Error::TileSize { given: config.tile });
        }
        if execute::denormals_are_flushed() {
            return Err(Error::DenormalsFlushed);
        }
        Ok(Self {
            config,
            threads: execute::worker_threads(config.threads)?,
            pool: None,
            parallel: false,
            textures: Vec::new(),
            recycled: Recycled::default(),
        })
    }

    /// How it executes.
    #[must_use]
    pub fn config(&self) -> GpuConfig {
        self.config
    }

    /// Most worker threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Creates a texture of zeros.
    ///
    /// # Errors
    /// For sizes or levels that are not possible, or that there is no memory for.
    pub fn create_texture(&mut self, desc: &TextureDescriptor) -> Result<TextureId, Error> {
        let texture = Texture::new(desc)?;
        self.textures.push(texture);
        Ok(TextureId(self.textures.len() as u32 - 1))
    }

    /// Replaces all textures by those of `recording`, filled as it says: its ids are
    /// the GPU's then, and ids from before are not to be used again.
    ///
    /// # Errors
    /// As [`Gpu::create_texture`]; the textures from before are still there then.
    pub fn load(&mut self, recording: &Recording) -> Result<(), Error> {
        let textures = recording.textures().iter().map(RecordedTexture::build);
        self.textures = textures.collect::<Result<_, _>>()?;
        Ok(())
    }

    /// All textures as they are now, as a recording without commands, which
    /// [`Gpu::load`] makes again.
    ///
    /// # Errors
    /// None at present.
    pub fn save(&self) -> Result<Recording, Error> {
        Recording::of(&self.textures)
    }

    /// Ids of all textures, in the order of their creation.
    pub fn texture_ids(&self) -> impl Iterator<Item = TextureId> + use<> {
        (0..self.textures.len() as u32).map(TextureId)
    }

    /// A texture, to read it back.
    ///
    /// # Errors
    /// Where there is none of that id.
    pub fn texture(&self, id: TextureId) -> Result<&Texture, Error> {
        self.textures
            .get(id.0 as usize)
            .ok_or(Error::NoSuchTexture {
                id: id.0,
                count: self.textures.len(),
            })
    }

    /// A texture, to fill it.
    ///
    /// # Errors
    /// Where there is none of that id.
    pub fn texture_mut(&mut self, id: TextureId) -> Result<&mut Texture, Error> {
        let count = self.textures.len();
        self.textures
            .get_mut(id.0 as usize)
            .ok_or(Error::NoSuchTexture { id: id.0, count })
    }

    /// Validates all of `list`, then executes it.
    ///
    /// # Errors
    /// For invalid use, or threads that cannot be started: nothing has been executed
    /// then. For vertices that there is no memory for: passes before theirs have been.
    pub fn submit(&mut self, list: &CommandList) -> Result<SubmitReport, Error> {
        execute::submit(self, list, None)
    }

    /// As [`Gpu::submit`], and hands every block-level access to `observer`, with what it
    /// `wants`: the same bits and counters, more slowly. Of accesses, no more wait in
    /// memory than one batch: some 50 MB, or what 32 primitives make.
    ///
    /// # Errors
    /// As [`Gpu::submit`].
    pub fn submit_observed(
        &mut self,
        list: &CommandList,
        wants: Wants<'_>,
        observer: &mut dyn AccessObserver,
    ) -> Result<SubmitReport, Error> {
        execute::submit(self, list, Some((wants, observer)))
    }
}
