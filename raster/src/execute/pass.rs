//! One render pass: its draws in batches, each through vertices, chunks, tiles.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::prepare::{Prepared, Target, prepare};
use super::split::{self, Fill, Lent};
use crate::command::{Draw, Referenced, RenderPass};
use crate::counters::{AccessSizes, Counters, Traffic};
use crate::geometry::{Chunk, ChunkInput, ShadedVertices, TileGrid, process_chunk, shade_part};
use crate::gpu::{DrawReport, Gpu, PassReport, Recycled};
use crate::observer::BlockAccess;
use crate::shader::VertexBatch;
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

/// Executes a validated pass. Accesses go to `accesses` where it is given.
pub(super) fn execute(
    gpu: &mut Gpu,
    pass: &RenderPass,
    accesses: Option<&mut Vec<BlockAccess>>,
) -> PassReport {
    let mut lent = split::lend(gpu, pass);
    let mut recycled = core::mem::take(&mut gpu.recycled);
    let pool = gpu.pool.take();
    let run = || {
        let executor = Executor::new(gpu, pass, &lent, &mut recycled);
        executor.run(&mut lent, accesses)
    };
    let counters = match &pool {
        Some(pool) => pool.install(run),
        None => run(),
    };
    gpu.recycled = recycled;
    let clear = split::clear_traffic(pass, &lent);
    split::give_back(gpu, pass, lent);
    gpu.pool = pool;
    let draws = pass.draws.iter().zip(counters);
    PassReport {
        label: pass.label.clone(),
        draws: draws
            .map(|(d, counters)| DrawReport {
                label: d.label.clone(),
                counters,
                counted: match &d.pipeline.fragment {
                    Some(f) => f.0.outputs().counts,
                    None => &[],
                },
            })
            .collect(),
        clear,
        time: std::time::Duration::ZERO,
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
    pass: &'a RenderPass,
    sizes: AccessSizes,
    grid: TileGrid,
    prepared: Vec<Prepared<'a>>,
    recycled: &'a mut Recycled,
    parallel: bool,
}

impl<'a> Executor<'a> {
    fn new(gpu: &'a Gpu, pass: &'a RenderPass, lent: &Lent, recycled: &'a mut Recycled) -> Self {
        let target = Target {
            width: lent.layout.width,
            height: lent.layout.height,
            sizes: lent.sizes,
        };
        let prepared = pass
            .draws
            .iter()
            .map(|d| prepare(gpu, &target, d))
            .collect();
        Self {
            gpu,
            pass,
            sizes: lent.sizes,
            grid: TileGrid::new(
                lent.layout.tile_side(gpu.config.tile),
                lent.layout.width,
                lent.layout.height,
            ),
            prepared,
            recycled,
            parallel: gpu.config.threads != 1,
        }
    }

    fn run(
        mut self,
        lent: &mut Lent,
        mut accesses: Option<&mut Vec<BlockAccess>>,
    ) -> Vec<Counters> {
        let units = self.units();
        let mut counters: Vec<Counters> = self
            .prepared
            .iter()
            .enumerate()
            .map(|(i, p)| vertex_traffic(p.draw, &units, i))
            .collect();
        let threads = if self.parallel {
            rayon::current_num_threads() as u32
        } else {
            1
        };
        let room = if threads == 1 {
            BATCH
        } else {
            SHARED_BATCH.saturating_mul(threads)
        };
        let batches = batches(&units, room);
        let fills = [
            split::loads(self.pass, &self.sizes),
            split::stores(self.pass),
        ];
        let mut tiles = lent.tiles(self.gpu.config.tile);
        let mut shaded: Vec<ShadedVertices> =
            units.iter().map(|_| ShadedVertices::default()).collect();
        let desks = Desks::default();
        let mut ready = 0;
        let last = batches.len() - 1;
        for (b, jobs) in batches.iter().enumerate() {
            let end = jobs.last().map_or(ready, |j| j.unit + 1);
            if ready < end {
                self.shade(&units[ready..end], &mut shaded[ready..end]);
                ready = end;
            }
            let chunks = self.chunks(&units, jobs, &shaded);
            for (job, chunk) in jobs.iter().zip(&chunks) {
                let c = &mut counters[units[job.unit].draw];
                c.add(&Counters {
                    primitives: chunk.counters,
                    ..Counters::default()
                });
            }
            let stage = TileStage {
                gpu: self.gpu,
                grid: self.grid,
                work: draw_work(&units, jobs, &shaded, &chunks, &self.prepared),
                draws: self.prepared.len(),
                sizes: self.sizes,
                before: (b == 0).then_some(&fills[0]),
                after: (b == last).then_some(&fills[1]),
                parallel: self.parallel,
                listening: accesses.is_some(),
                desks: &desks,
            };
            stage.run(&mut tiles);
            self.recycled.chunks.extend(chunks);
            // The next batch may go on with the last unit.
            let done = if b == last {
                end
            } else {
                end.saturating_sub(1)
            };
            for s in &mut shaded[jobs.first().map_or(end, |j| j.unit)..done] {
                self.recycled.shaded.push(core::mem::take(s));
            }
        }
        for desk in desks.into_all() {
            let drawn = counters.iter_mut().zip(&self.prepared);
            for ((c, p), s) in drawn.zip(desk.scratch.counters) {
                c.add(&s.into_counters(&p.config));
            }
            if let Some(all) = &mut accesses {
                all.extend(desk.accesses);
            }
        }
        if let Some(r) = accesses {
            r.par_sort_unstable_by_key(|a| (a.draw, a.primitive, a.piece, a.block[1], a.block[0]));
        }
        for (c, p) in counters.iter_mut().zip(&self.prepared) {
            c.settle(&p.sizes);
        }
        counters
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

    fn into_all(self) -> Vec<Desk> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tile stage of one batch.
struct TileStage<'a> {
    gpu: &'a Gpu,
    grid: TileGrid,
    work: Vec<DrawWork<'a>>,
    draws: usize,
    sizes: AccessSizes,
    before: Option<&'a Fill>,
    after: Option<&'a Fill>,
    parallel: bool,
    listening: bool,
    desks: &'a Desks,
}

impl TileStage<'_> {
    fn run(&self, tiles: &mut [TileTarget<'_>]) {
        if self.parallel {
            let tiles = tiles.par_iter_mut().with_max_len(1);
            tiles.for_each(|tile| {
                let mut desk = self.desks.take(self.draws);
                self.tile(tile, &mut desk);
                self.desks.put(desk);
            });
        } else {
            let mut desk = self.desks.take(self.draws);
            tiles.iter_mut().for_each(|tile| self.tile(tile, &mut desk));
            self.desks.put(desk);
        }
    }

    fn tile(&self, tile: &mut TileTarget<'_>, desk: &mut Desk) {
        if let Some(fill) = self.before {
            fill.apply(tile, &self.sizes);
        }
        let number = (tile.y >> self.grid.shift) * self.grid.across + (tile.x >> self.grid.shift);
        run_tile(
            self.gpu.config.simd,
            &self.work,
            number as usize,
            tile,
            &mut desk.scratch,
            self.listening.then_some(&mut desk.accesses),
        );
        if let Some(fill) = self.after {
            fill.apply(tile, &self.sizes);
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

/// Chunks of all units, in batches; at least one batch, for the load operations.
fn batches(units: &[Unit<'_>], size: u32) -> Vec<Vec<Job>> {
    let mut batches = vec![Vec::new()];
    let mut room = size;
    for (u, unit) in units.iter().enumerate() {
        for first in (0..unit.primitives).step_by(CHUNK as usize) {
            let primitives = CHUNK.min(unit.primitives - first);
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
