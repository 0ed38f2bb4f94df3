//! One render pass: its draws in batches, each through vertices, chunks, tiles.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::listen::{self, Listener};
use super::prepare::{Prepared, Target, prepare};
use super::split::{self, Fill, Lent};
use crate::command::{Draw, Referenced, RenderPass};
use crate::counters::{AccessSizes, Counters, Traffic};
use crate::geometry::{Chunk, ChunkInput, ShadedVertices, TileGrid, process_chunk, shade_part};
use crate::gpu::{DrawReport, Gpu, PassReport, Recycled};
use crate::observer::{BlockAccess, Wants};
use crate::shader::VertexBatch;
use crate::simd::SimdLevel;
use crate::tile::{ChunkRef, DrawWork, Scratch, TileTarget, run_tile};

/// Primitives of a chunk: enough to fill packets, few enough to share out.
const CHUNK: u32 = 1024;
/// Vertices that one worker shades at a time.
const VERTEX_RUN: usize = 2048;
/// Primitives of a batch on one thread; their set-ups wait in its cache until the tiles
/// have run.
const BATCH: u32 = 8 * CHUNK;
/// The same for each of several, which wait for one another at the end of a batch.
const SHARED_BATCH: u32 = 2 * BATCH;
/// The same while somebody listens, whose accesses wait in memory too.
const LISTENING_BATCH: u32 = 2 * CHUNK;

/// Executes a validated pass; a listener is told of its accesses.
pub(super) fn execute(
    gpu: &mut Gpu,
    pass: &RenderPass,
    listener: Option<Listener<'_>>,
) -> PassReport {
    let mut lent = split::lend(gpu, pass);
    let mut recycled = core::mem::take(&mut gpu.recycled);
    let wants = listener.as_ref().map(|l| l.wants).unwrap_or_default();
    let executor = Executor::new(gpu, pass, &lent, wants, &mut recycled);
    let counters = executor.run(&mut lent, listener);
    gpu.recycled = recycled;
    let clear = lent.clear_traffic();
    split::give_back(gpu, lent);
    let draws = pass.draws.iter().zip(counters);
    PassReport {
        label: pass.label.clone(),
        draws: draws.map(|(d, c)| draw_report(d, c)).collect(),
        clear,
        time: std::time::Duration::ZERO,
    }
}

fn draw_report(draw: &Draw, counters: Counters) -> DrawReport {
    let fragment = draw.pipeline.fragment.as_ref();
    DrawReport {
        label: draw.label.clone(),
        counters,
        counted: fragment.map_or(&[], |f| f.0.outputs().counts),
    }
}

/// Vertices of one instance of a draw.
struct Unit<'a> {
    draw: usize,
    instance: u32,
    /// Vertex numbers and, with indices, positions among them.
    referenced: std::borrow::Cow<'a, Referenced>,
    primitives: u32,
    /// Number of the first primitive in the draw.
    first_primitive: u32,
}

/// A run of primitives of a unit.
#[derive(Clone, Copy)]
struct Job {
    unit: usize,
    first: u32,
    primitives: u32,
}

struct Executor<'a> {
    gpu: &'a Gpu,
    grid: TileGrid,
    prepared: Vec<Prepared<'a>>,
    recycled: &'a mut Recycled,
    parallel: bool,
}

impl<'a> Executor<'a> {
    fn new(
        gpu: &'a Gpu,
        pass: &'a RenderPass,
        lent: &Lent,
        wants: Wants,
        recycled: &'a mut Recycled,
    ) -> Self {
        let target = Target {
            width: lent.layout.width,
            height: lent.layout.height,
            sizes: lent.sizes,
        };
        let draws = pass.draws.iter();
        Self {
            gpu,
            grid: TileGrid::new(
                lent.layout.tile_side(gpu.config.tile),
                lent.layout.width,
                lent.layout.height,
            ),
            prepared: draws.map(|d| prepare(gpu, &target, d, wants)).collect(),
            recycled,
            parallel: gpu.config.threads != 1,
        }
    }

    /// Batch after batch: its vertices, its chunks, all tiles.
    fn run(mut self, lent: &mut Lent, mut listener: Option<Listener<'_>>) -> Vec<Counters> {
        let units = self.units();
        let mut counters = self.vertex_counters(&units);
        let batches = self.batches(&units, listener.is_some());
        let mut vertices = Vertices::new(units.len());
        let mut stage = TileStage::new(&self, lent);
        for (number, jobs) in batches.iter().enumerate() {
            let is_last = number + 1 == batches.len();
            self.shade_for(&units, jobs, &mut vertices);
            let chunks = self.chunks(&units, jobs, &vertices.shaded);
            for (job, chunk) in jobs.iter().zip(&chunks) {
                counters[units[job.unit].draw].add(&Counters {
                    primitives: chunk.counters,
                    ..Counters::default()
                });
            }
            let runs = match &listener {
                Some(_) => listen::runs(&chunks),
                None => core::iter::once(0..chunks.len()).collect(),
            };
            for run in runs {
                let ends = is_last && run.end == chunks.len();
                let (jobs, chunks) = (&jobs[run.clone()], &chunks[run]);
                let work = draw_work(&units, jobs, &vertices.shaded, chunks, &self.prepared);
                stage.run(&work, ends, listener.is_some());
                if let Some(listener) = &mut listener {
                    listener.hear(stage.desks.accesses(), self.parallel);
                }
            }
            self.recycled.chunks.extend(chunks);
            vertices.recycle(jobs, is_last, &mut self.recycled.shaded);
        }
        for desk in stage.desks.into_all() {
            let drawn = counters.iter_mut().zip(&self.prepared);
            for ((c, p), s) in drawn.zip(desk.scratch.counters) {
                c.add(&s.into_counters(&p.config));
            }
        }
        for (c, p) in counters.iter_mut().zip(&self.prepared) {
            c.settle(&p.sizes);
        }
        counters
    }

    /// Vertex and index traffic of each draw.
    fn vertex_counters(&self, units: &[Unit<'_>]) -> Vec<Counters> {
        let draws = self.prepared.iter().enumerate();
        draws
            .map(|(i, p)| vertex_traffic(p.draw, units, i))
            .collect()
    }

    fn batches(&self, units: &[Unit<'_>], listening: bool) -> Vec<Vec<Job>> {
        if listening {
            return batches(units, listen::CHUNK, LISTENING_BATCH);
        }
        let threads = match self.parallel {
            true => rayon::current_num_threads() as u32,
            false => 1,
        };
        let room = match threads {
            1 => BATCH,
            n => SHARED_BATCH.saturating_mul(n),
        };
        batches(units, CHUNK, room)
    }

    fn units(&self) -> Vec<Unit<'a>> {
        let mut units = Vec::new();
        for (number, p) in self.prepared.iter().enumerate() {
            let d = p.draw;
            let primitives = d.count / d.pipeline.primitive.topology.vertices();
            if primitives == 0 {
                continue;
            }
            for instance in 0..d.instances {
                units.push(Unit {
                    draw: number,
                    instance,
                    referenced: referenced(d, primitives),
                    primitives,
                    first_primitive: instance * primitives,
                });
            }
        }
        units
    }

    /// Shades the vertices of the units up to the last of `jobs`.
    fn shade_for(&mut self, units: &[Unit<'_>], jobs: &[Job], vertices: &mut Vertices) {
        let end = jobs.last().map_or(0, |j| j.unit + 1);
        let start = vertices.ready;
        if start < end {
            vertices.ready = end;
            self.shade(&units[start..end], &mut vertices.shaded[start..end]);
        }
    }

    /// Shades the vertices of `units`, in recycled memory.
    fn shade(&mut self, units: &[Unit<'_>], shaded: &mut [ShadedVertices]) {
        let mut work = Vec::new();
        for (unit, out) in units.iter().zip(shaded) {
            *out = self.recycled.shaded.pop().unwrap_or_default();
            out.clear();
            out.resize(
                unit.referenced.vertices.len(),
                self.prepared[unit.draw].geometry.varyings,
            );
            let runs = unit.referenced.vertices.chunks(VERTEX_RUN);
            let parts = out.parts(VERTEX_RUN).into_iter().zip(runs);
            work.extend(parts.map(|(part, run)| (unit, part, run)));
        }
        let shade = |(unit, mut part, vertices): (&Unit<'_>, _, &[u32])| {
            let p = &self.prepared[unit.draw];
            let buffer = p.draw.vertices.as_deref();
            let batch = VertexBatch {
                data: buffer.map_or(&[], |b| &b.data),
                stride: buffer.map_or(0, |b| b.stride),
                vertices,
                instance: unit.instance,
            };
            let shader = &*p.draw.pipeline.vertex.0;
            shade_part(self.gpu.config.simd, shader, &p.geometry, &batch, &mut part);
        };
        if self.parallel && work.len() > 1 {
            work.into_par_iter().for_each(shade);
        } else {
            work.into_iter().for_each(shade);
        }
    }

    fn chunks(
        &mut self,
        units: &[Unit<'_>],
        jobs: &[Job],
        shaded: &[ShadedVertices],
    ) -> Vec<Chunk> {
        let mut old = core::mem::take(&mut self.recycled.chunks);
        self.recycled.chunks = old.split_off(jobs.len().min(old.len()));
        old.resize_with(jobs.len(), Chunk::default);
        let one = |(job, old): (&Job, Chunk)| {
            let unit = &units[job.unit];
            let p = &self.prepared[unit.draw];
            let per = p.geometry.topology.vertices();
            let local = &unit.referenced.local;
            let range = (job.first * per) as usize..((job.first + job.primitives) * per) as usize;
            let input = ChunkInput {
                state: &p.geometry,
                grid: &self.grid,
                shaded: &shaded[job.unit],
                indices: (!local.is_empty()).then(|| &local[range.clone()]),
                first: range.start as u32,
                primitives: job.primitives,
                first_primitive: unit.first_primitive + job.first,
            };
            process_chunk(self.gpu.config.simd, &input, old)
        };
        if self.parallel && jobs.len() > 1 {
            jobs.par_iter().zip(old).map(one).collect()
        } else {
            jobs.iter().zip(old).map(one).collect()
        }
    }
}

/// Shaded vertices of all units, in memory from the unit's first batch to its last.
struct Vertices {
    shaded: Vec<ShadedVertices>,
    /// Units that have been shaded.
    ready: usize,
}

impl Vertices {
    fn new(units: usize) -> Self {
        Self {
            shaded: core::iter::repeat_with(ShadedVertices::default)
                .take(units)
                .collect(),
            ready: 0,
        }
    }

    /// Gives up the units of `jobs`, but for the last one, with which the next batch
    /// may go on.
    fn recycle(&mut self, jobs: &[Job], is_last: bool, to: &mut Vec<ShadedVertices>) {
        let first = jobs.first().map_or(self.ready, |j| j.unit);
        let end = self.ready - usize::from(!is_last && self.ready > 0);
        let done = self.shaded.get_mut(first..end).unwrap_or_default();
        to.extend(done.iter_mut().map(core::mem::take));
    }
}

/// What a worker needs beside the tile itself; what it counts and finds.
struct Desk {
    scratch: Scratch,
    accesses: Vec<BlockAccess>,
}

/// Desks of a pass. A worker takes any free one for a tile: all that they gather
/// is sums, and lists that are sorted in the end.
#[derive(Default)]
struct Desks(Mutex<Vec<Desk>>);

impl Desks {
    fn take(&self, draws: usize) -> Desk {
        let free = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        free.unwrap_or_else(|| Desk {
            scratch: Scratch::new(draws),
            accesses: Vec::new(),
        })
    }

    fn put(&self, desk: Desk) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(desk);
    }

    /// What the workers have gathered.
    fn accesses(&mut self) -> impl Iterator<Item = &mut Vec<BlockAccess>> {
        let all = self.0.get_mut().unwrap_or_else(PoisonError::into_inner);
        all.iter_mut().map(|d| &mut d.accesses)
    }

    fn into_all(self) -> Vec<Desk> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tiles of a pass, and who works on them.
struct TileStage<'a> {
    gpu: &'a Gpu,
    grid: TileGrid,
    sizes: AccessSizes,
    tiles: Vec<TileTarget<'a>>,
    /// What the load operations store, until they have.
    loads: Option<Fill>,
    stores: Fill,
    draws: usize,
    parallel: bool,
    desks: Desks,
}

impl<'a> TileStage<'a> {
    fn new(executor: &Executor<'a>, lent: &'a mut Lent) -> Self {
        Self {
            gpu: executor.gpu,
            grid: executor.grid,
            sizes: lent.sizes,
            loads: Some(lent.loads()),
            stores: lent.stores(),
            tiles: lent.tiles(executor.gpu.config.tile),
            draws: executor.prepared.len(),
            parallel: executor.parallel,
            desks: Desks::default(),
        }
    }

    /// Runs `work` on all tiles, after the load operations the first time, and before
    /// the store operations where the pass `ends`.
    fn run(&mut self, work: &[DrawWork<'_>], ends: bool, listening: bool) {
        let loads = self.loads.take();
        let visit = Visit {
            level: self.gpu.config.simd,
            grid: self.grid,
            work,
            sizes: &self.sizes,
            before: loads.as_ref(),
            after: ends.then_some(&self.stores),
            listening,
        };
        let (desks, draws) = (&self.desks, self.draws);
        if self.parallel {
            let tiles = self.tiles.par_iter_mut().with_max_len(1);
            tiles.for_each(|tile| {
                let mut desk = desks.take(draws);
                visit.tile(tile, &mut desk);
                desks.put(desk);
            });
        } else {
            let mut desk = desks.take(draws);
            let tiles = self.tiles.iter_mut();
            tiles.for_each(|tile| visit.tile(tile, &mut desk));
            desks.put(desk);
        }
    }
}

/// What is done in every tile.
struct Visit<'a> {
    level: SimdLevel,
    grid: TileGrid,
    work: &'a [DrawWork<'a>],
    sizes: &'a AccessSizes,
    before: Option<&'a Fill>,
    after: Option<&'a Fill>,
    listening: bool,
}

impl Visit<'_> {
    fn tile(&self, tile: &mut TileTarget<'_>, desk: &mut Desk) {
        if let Some(fill) = self.before {
            fill.apply(tile, self.sizes);
        }
        let number = (tile.y >> self.grid.shift) * self.grid.across + (tile.x >> self.grid.shift);
        run_tile(
            self.level,
            self.work,
            number as usize,
            tile,
            &mut desk.scratch,
            self.listening.then_some(&mut desk.accesses),
        );
        if let Some(fill) = self.after {
            fill.apply(tile, self.sizes);
        }
    }
}

/// Chunks grouped by draw, in submission order.
fn draw_work<'a>(
    units: &[Unit<'_>],
    jobs: &[Job],
    shaded: &'a [ShadedVertices],
    chunks: &'a [Chunk],
    prepared: &'a [Prepared<'a>],
) -> Vec<DrawWork<'a>> {
    let mut work: Vec<DrawWork<'a>> = Vec::new();
    for (job, chunk) in jobs.iter().zip(chunks) {
        let draw = units[job.unit].draw;
        let chunk = ChunkRef {
            chunk,
            shaded: &shaded[job.unit],
        };
        match work.last_mut() {
            Some(w) if w.draw == draw => w.chunks.push(chunk),
            _ => work.push(DrawWork {
                draw,
                config: &prepared[draw].config,
                chunks: vec![chunk],
            }),
        }
    }
    work
}

/// Chunks of all units, in batches of `size` primitives; at least one batch, for the load
/// operations.
fn batches(units: &[Unit<'_>], chunk: u32, size: u32) -> Vec<Vec<Job>> {
    let mut batches = vec![Vec::new()];
    let mut room = size;
    for (u, unit) in units.iter().enumerate() {
        for first in (0..unit.primitives).step_by(chunk as usize) {
            let primitives = chunk.min(unit.primitives - first);
            if room < primitives {
                batches.push(Vec::new());
                room = size;
            }
            room -= primitives;
            batches.last_mut().expect("never empty").push(Job {
                unit: u,
                first,
                primitives,
            });
        }
    }
    batches
}

fn referenced(d: &Draw, primitives: u32) -> std::borrow::Cow<'_, Referenced> {
    use std::borrow::Cow;
    let used = (primitives * d.pipeline.primitive.topology.vertices()) as usize;
    let first = d.first as usize;
    match &d.indices {
        None => Cow::Owned(Referenced {
            vertices: (d.first..d.first + used as u32).collect(),
            local: Vec::new(),
        }),
        Some(b) if first == 0 && used == b.indices().len() => Cow::Borrowed(b.referenced()),
        Some(b) => Cow::Owned(Referenced::of(&b.indices()[first..first + used])),
    }
}

/// Vertex and index traffic of draw number `number` (rules §8).
fn vertex_traffic(d: &Draw, units: &[Unit<'_>], number: usize) -> Counters {
    let mut c = Counters::default();
    // Units are in the order of draws; a pass may have thousands.
    let first = units.partition_point(|u| u.draw < number);
    let mine = || units[first..].iter().take_while(|u| u.draw == number);
    let invocations: u64 = mine().map(|u| u.referenced.vertices.len() as u64).sum();
    c.primitives.vertex_shader_invocations = invocations;
    let read = |accesses: u64, bytes: u64| Traffic {
        read_accesses: accesses,
        read_bytes: accesses * bytes,
        ..Traffic::default()
    };
    if let Some(v) = &d.vertices {
        c.traffic.vertex = read(invocations, 4 * v.stride as u64);
    }
    if d.indices.is_some() {
        let per = u64::from(d.pipeline.primitive.topology.vertices());
        c.traffic.index = read(mine().map(|u| u64::from(u.primitives) * per).sum(), 4);
    }
    c
}
