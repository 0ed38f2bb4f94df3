//! The tile stage: coverage, tests, shading and output of one execution tile.
//!
//! A tile's worker walks the draws, their chunks and the triangles binned to the
//! tile in submission order. `coverage` finds the 8×8 blocks that a triangle
//! touches and their 64-bit masks; `block` runs the fixed function of
//! `docs/rasterisation-rules.md` §7 on a mask, with `depth`, `depth_test` and `stencil`, and
//! `lean` does the same for the states that most draws have;
//! `shade` calls the fragment shader on what is left; `output` blends.

mod block;
mod config;
mod coverage;
mod depth;
mod depth_test;
mod lean;
mod listen;
mod output;
mod shade;
mod stencil;
mod target;
mod witness;

use core::ops::Range;

use block::{BlockStage, General};
use lean::Lean;

pub(crate) use config::{DrawConfig, StencilFace, TargetConfig};
pub(crate) use listen::{Gathered, Listening, Turn};
pub(crate) use target::{ColorTile, DepthTile, TileTarget};
pub(crate) use witness::Untold;

pub(crate) use crate::counters::COUNT;
use crate::counters::{Accesses, Counters, EventCounters, FragmentCounters, TileCounters};
use crate::geometry::{Chunk, DepthEncoding, ShadedVertices};
use crate::observer::Wants;
use crate::shader::{PacketOutput, ShaderEvents};
use crate::simd::{F32, Lanes, SimdLevel, outlined, with_lanes};
use crate::texture::PACKETS;

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
    /// As the counters of the draw of `config`, to be added to the geometry stage's.
    pub(crate) fn into_counters(mut self, config: &DrawConfig<'_>) -> Counters {
        if COUNT {
            self.derive(config);
        }
        let mut accesses = self.accesses;
        accesses.tex_fetch = self.shader.fetches;
        accesses.tex_texel = self.shader.texels;
        Counters {
            fragments: self.fragments,
            fragment_shader_invocations: self.invocations,
            tiles: self.tiles,
            events: self.events,
            accesses,
            shader_counts: self.shader.counts,
            ..Counters::default()
        }
    }

    /// What follows from other counts is not counted block by block.
    fn derive(&mut self, config: &DrawConfig<'_>) {
        let f = &mut self.fragments;
        let tested = f.generated - f.hiz_killed - f.bounds_failed;
        let unshaded = tested - f.stencil_failed - f.depth_failed;
        f.written = unshaded - f.discarded;
        let a = &mut self.accesses;
        a.hiz_read = self.tiles.tested;
        if config.shader.is_some() {
            for (i, target) in config.targets.iter().enumerate() {
                a.color_write[i] = u64::from(target.mask.0 != 0) * f.written;
                a.color_read[i] = u64::from(target.reads) * f.written;
            }
        }
        if !config.lean {
            return;
        }
        // Tests come before the shader, and whatever passes them is shaded and stored.
        if config.shader.is_some() {
            self.invocations = unshaded;
        }
        if config.depth_write {
            a.z_write = unshaded;
        }
        if let Some([failed, passed]) = config.counting {
            a.stencil_write = u64::from(failed) * f.depth_failed + u64::from(passed) * unshaded;
            a.stencil_read = a.stencil_write;
        }
    }
}

/// Triangles of a chunk with what they refer to.
pub(crate) struct ChunkRef<'a> {
    pub(crate) chunk: &'a Chunk,
    pub(crate) shaded: &'a ShadedVertices,
    /// Those that run now.
    pub(crate) triangles: Range<u32>,
    /// Number of the first of them among all that run together.
    pub(crate) first: u32,
}

impl<'a> ChunkRef<'a> {
    /// Numbers in the chunk of those that may touch tile number `tile`, which stand there
    /// in order.
    fn bin(&self, tile: usize) -> &'a [u32] {
        let bin = self.chunk.bins.tile(tile);
        if self.triangles.len() == self.chunk.triangles.len() {
            return bin;
        }
        let start = bin.partition_point(|t| *t < self.triangles.start);
        let length = bin[start..].partition_point(|t| *t < self.triangles.end);
        &bin[start..start + length]
    }

    /// Number of triangle `t` of the chunk among all that run together.
    pub(crate) fn number(&self, t: u32) -> u32 {
        self.first + (t - self.triangles.start)
    }
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

/// Runs all of `work` on one tile, after which the pass may have `ended`. What a listener
/// wants is gathered.
pub(crate) fn run_tile(
    level: SimdLevel,
    work: &[DrawWork<'_>],
    tile_number: usize,
    target: &mut TileTarget<'_>,
    scratch: &mut Scratch,
    mut listening: Option<(Wants<'_>, &mut Gathered)>,
    ended: bool,
) {
    for w in work {
        tell_left(level, w, target, &mut listening, w.draw as u32);
        for chunk in &w.chunks {
            let bin = chunk.bin(tile_number);
            if bin.is_empty() {
                continue;
            }
            let mut env = block::Env {
                level,
                config: w.config,
                draw: w.draw as u32,
                chunk,
                triangle: 0,
                target: &mut *target,
                counters: &mut scratch.counters[w.draw],
                outputs: &mut scratch.outputs,
                varyings: &mut scratch.varyings,
                listening: listening.as_mut().map(|(wants, gathered)| Listening {
                    wants: *wants,
                    gathered,
                }),
            };
            with_lanes!(level, l => run_bin(l, &mut env, bin));
        }
    }
    if ended && let Some(w) = work.last() {
        tell_left(level, w, target, &mut listening, u32::MAX);
    }
}

/// Tells a listener who wants that of what the draw before `next` left in the tile, if
/// there is one.
fn tell_left(
    level: SimdLevel,
    work: &DrawWork<'_>,
    target: &mut TileTarget<'_>,
    listening: &mut Option<(Wants<'_>, &mut Gathered)>,
    next: u32,
) {
    if let Some((wants, gathered)) = listening
        && let Some(witness) = wants.left
        && target.untold.is_of_another(next)
    {
        witness::tell_left(target, work.config, level, witness, &mut gathered.left);
    }
}

/// Chooses the kernel for the draw: what it is compiled for is known in it.
#[inline(always)]
fn run_bin<L: Lanes>(l: L, env: &mut block::Env<'_, '_>, bin: &[u32]) {
    let config = env.config;
    if let Some(color) = config.constant {
        fill_outputs(l, env.outputs, color);
    }
    let lean = config.lean && env.listening.is_none();
    match (lean, config.encoding, config.shader.is_some()) {
        (true, DepthEncoding::D24, false) => kernel::<L, Lean<false>, true>(l, env, bin),
        (true, DepthEncoding::D24, true) => kernel::<L, Lean<true>, true>(l, env, bin),
        (true, DepthEncoding::Float, false) => kernel::<L, Lean<false>, false>(l, env, bin),
        (true, DepthEncoding::Float, true) => kernel::<L, Lean<true>, false>(l, env, bin),
        (false, DepthEncoding::D24, _) => kernel::<L, General, true>(l, env, bin),
        (false, DepthEncoding::Float, _) => kernel::<L, General, false>(l, env, bin),
    }
}

/// What a shader of one colour gives in every packet.
#[inline(always)]
fn fill_outputs<L: Lanes>(l: L, outputs: &mut [PacketOutput; PACKETS], color: [f32; 4]) {
    for out in outputs {
        out.integers[0] = 0;
        for (channel, c) in out.color[0].iter_mut().zip(color) {
            F32::splat(l, c).store(channel);
        }
    }
}

#[inline(always)]
fn kernel<L: Lanes, S: BlockStage, const D24: bool>(
    l: L,
    env: &mut block::Env<'_, '_>,
    bin: &[u32],
) {
    outlined(
        l,
        #[inline(always)]
        || coverage::bin::<L, S, D24>(l, env, bin),
    );
}
