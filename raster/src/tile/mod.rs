//! The tile stage: coverage, tests, shading and output of one execution tile.
//!
//! A tile's worker walks the draws, their chunks and the triangles binned to the
//! tile in submission order. `coverage` finds the 8×8 blocks that a triangle
//! touches and their 64-bit masks; `block` runs the fixed function of
//! `docs/rasterisation-rules.md` §7 on a mask, with `depth` and `stencil`;
//! `shade` calls the fragment shader on what is left; `output` blends.

mod block;
mod config;
mod coverage;
mod depth;
mod output;
mod shade;
mod stencil;
mod target;

pub(crate) use config::{DrawConfig, StencilFace, TargetConfig};
pub(crate) use depth::ShaderDepth;
pub(crate) use target::{ColorTile, DepthTile, TileTarget};

use crate::counters::{Accesses, Counters, EventCounters, FragmentCounters, TileCounters};
use crate::geometry::{Chunk, DepthEncoding, ShadedVertices};
use crate::observer::BlockAccess;
use crate::shader::{PACKETS, PacketOutput, ShaderEvents};
use crate::simd::{Lanes, SimdLevel, with_lanes};

/// Whether counting is compiled in; the `uncounted` feature exists to measure
/// what it costs.
pub(crate) const COUNT: bool = !cfg!(feature = "uncounted");

/// Receives block accesses; [`Silent`] costs nothing.
pub(crate) trait Recorder: Send {
    const ON: bool;
    fn record(&mut self, access: BlockAccess);
}

/// Nobody listens.
pub(crate) struct Silent;

impl Recorder for Silent {
    const ON: bool = false;
    fn record(&mut self, _: BlockAccess) {}
}

impl Recorder for Vec<BlockAccess> {
    const ON: bool = true;
    fn record(&mut self, access: BlockAccess) {
        self.push(access);
    }
}

/// Counters of the tile stage for one draw.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileStageCounters {
    pub(crate) fragments: FragmentCounters,
    pub(crate) invocations: u64,
    pub(crate) tiles: TileCounters,
    pub(crate) events: EventCounters,
    pub(crate) accesses: Accesses,
    pub(crate) shader: ShaderEvents,
}

impl TileStageCounters {
    /// Adds another worker's.
    fn add(&mut self, o: &Self) {
        let mut a = std::mem::take(self).into_counters();
        a.add(&o.clone().into_counters());
        *self = Self::from_counters(&a);
    }

    fn from_counters(c: &Counters) -> Self {
        Self {
            fragments: c.fragments,
            invocations: c.fragment_shader_invocations,
            tiles: c.tiles,
            events: c.events,
            accesses: c.accesses,
            shader: ShaderEvents {
                fetches: c.accesses.tex_fetch,
                texels: c.accesses.tex_texel,
            },
        }
    }

    /// As the counters of a draw, to be added to the geometry stage's.
    pub(crate) fn into_counters(self) -> Counters {
        let mut accesses = self.accesses;
        accesses.tex_fetch = self.shader.fetches;
        accesses.tex_texel = self.shader.texels;
        Counters {
            fragments: self.fragments,
            fragment_shader_invocations: self.invocations,
            tiles: self.tiles,
            events: self.events,
            accesses,
            ..Counters::default()
        }
    }
}

/// A chunk with what its triangles refer to.
pub(crate) struct ChunkRef<'a> {
    pub(crate) chunk: &'a Chunk,
    pub(crate) shaded: &'a ShadedVertices,
}

/// One draw (or a part of one) for the tile stage.
pub(crate) struct DrawWork<'a> {
    /// Number in the render pass.
    pub(crate) draw: usize,
    pub(crate) config: &'a DrawConfig<'a>,
    pub(crate) chunks: Vec<ChunkRef<'a>>,
}

/// Memory that a worker keeps from tile to tile.
pub(crate) struct Scratch {
    pub(crate) counters: Vec<TileStageCounters>,
    pub(crate) outputs: Box<[PacketOutput; PACKETS]>,
    varyings: shade::VaryingCache,
}

impl Scratch {
    pub(crate) fn new(draws: usize) -> Self {
        Self {
            counters: vec![TileStageCounters::default(); draws],
            outputs: Box::new(core::array::from_fn(|_| PacketOutput::EMPTY)),
            varyings: shade::VaryingCache::default(),
        }
    }
}

impl Scratch {
    /// Adds what another worker counted.
    pub(crate) fn absorb(&mut self, o: Self) {
        for (a, b) in self.counters.iter_mut().zip(o.counters) {
            a.add(&b);
        }
    }
}

/// Runs all of `work` on one tile.
pub(crate) fn run_tile<R: Recorder>(
    level: SimdLevel,
    work: &[DrawWork<'_>],
    tile_number: usize,
    target: &mut TileTarget<'_>,
    scratch: &mut Scratch,
    recorder: &mut R,
) {
    with_lanes!(level, l => run_tile_lanes(l, level, work, tile_number, target, scratch, recorder));
}

#[inline(always)]
fn run_tile_lanes<L: Lanes, R: Recorder>(
    l: L,
    level: SimdLevel,
    work: &[DrawWork<'_>],
    tile_number: usize,
    target: &mut TileTarget<'_>,
    scratch: &mut Scratch,
    recorder: &mut R,
) {
    for w in work {
        for chunk in &w.chunks {
            let bin = chunk.chunk.bins.tile(tile_number);
            if bin.is_empty() {
                continue;
            }
            let mut env = block::Env {
                level,
                config: w.config,
                draw: w.draw as u32,
                chunk,
                target: &mut *target,
                counters: &mut scratch.counters[w.draw],
                outputs: &mut scratch.outputs,
                varyings: &mut scratch.varyings,
            };
            match w.config.encoding {
                DepthEncoding::D24 => coverage::bin::<L, R, true>(l, &mut env, recorder, bin),
                DepthEncoding::Float => coverage::bin::<L, R, false>(l, &mut env, recorder, bin),
            }
        }
    }
}
