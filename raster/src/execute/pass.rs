//! One render pass: its draws in batches, each through vertices, chunks, tiles.

use rayon::prelude::*;

use super::listen::{self, Listener, Piece};
use super::prepare::{Prepared, Target, prepare};
use super::split::{self, Lent};
use super::tiles::TileStage;
use super::unit::{Job, Unit, batches, units, vertex_traffic};
use crate::command::{Draw, RenderPass};
use crate::counters::Counters;
use crate::error::Error;
use crate::geometry::{Chunk, ChunkInput, ShadedVertices, TileGrid, process_chunk, shade_part};
use crate::gpu::{DrawReport, Gpu, PassReport, Recycled};
use crate::observer::Wants;
use crate::shader::VertexBatch;
use crate::tile::{ChunkRef, DrawWork};

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

/// Into how many chunks a draw is cut.
pub(super) fn chunks_of(d: &Draw) -> usize {
    let primitives = d.count / d.pipeline.primitive.topology.vertices();
    primitives.div_ceil(CHUNK) as usize * d.instances as usize
}

/// Executes a validated pass; a listener is told of its accesses.
pub(super) fn execute(
    gpu: &mut Gpu,
    pass: &RenderPass,
    listener: Option<Listener<'_>>,
) -> Result<PassReport, Error> {
    let mut lent = split::lend(gpu, pass);
    let mut recycled = core::mem::take(&mut gpu.recycled);
    let wants = listener.as_ref().map(|l| l.wants).unwrap_or_default();
    let executor = Executor::new(gpu, pass, &lent, wants, &mut recycled);
    let counters = executor.run(&mut lent, listener);
    gpu.recycled = recycled;
    let clear = lent.clear_traffic();
    split::give_back(gpu, lent);
    let draws = pass.draws.iter().zip(counters?);
    Ok(PassReport {
        label: pass.label.clone(),
        draws: draws.map(|(d, c)| draw_report(d, c)).collect(),
        clear,
        time: std::time::Duration::ZERO,
    })
}

fn draw_report(draw: &Draw, counters: Counters) -> DrawReport {
    let fragment = draw.pipeline.fragment.as_ref();
    DrawReport {
        label: draw.label.clone(),
        counters,
        counted: fragment.map_or(&[], |f| f.0.outputs().counts),
    }
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
        wants: Wants<'_>,
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
            parallel: gpu.parallel,
        }
    }

    /// Batch after batch: its vertices, its chunks, all tiles.
    fn run(
        mut self,
        lent: &mut Lent,
        mut listener: Option<Listener<'_>>,
    ) -> Result<Vec<Counters>, Error> {
        let units = units(&self.prepared)?;
        let mut counters = self.vertex_counters(&units);
        let batches = self.batches(&units, listener.is_some());
        let mut vertices = Vertices::new(units.len());
        let mut stage = TileStage::new(self.gpu, self.grid, self.prepared.len(), lent);
        for (number, jobs) in batches.iter().enumerate() {
            let is_last = number + 1 == batches.len();
            self.shade_for(&units, jobs, &mut vertices)?;
            let chunks = self.chunks(&units, jobs, &vertices.shaded);
            for (job, chunk) in jobs.iter().zip(&chunks) {
                counters[units[job.unit].draw].add(&Counters {
                    primitives: chunk.counters,
                    ..Counters::default()
                });
            }
            let runs = match &listener {
                Some(listener) => listen::runs(&chunks, listener.wants),
                None => vec![Piece::all(&chunks)],
            };
            let last_run = runs.len() - 1;
            for (run_number, run) in runs.iter().enumerate() {
                let ends = is_last && run_number == last_run;
                let run = run.iter().map(|p| (p, jobs[p.chunk], &chunks[p.chunk]));
                let work = draw_work(&units, run, &vertices.shaded, &self.prepared);
                stage.run(&work, ends, listener.as_ref().map(|l| l.wants));
                if let Some(listener) = &mut listener {
                    listener.hear(stage.desks.gathered(), self.parallel);
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
        Ok(counters)
    }

    /// Vertex and index traffic of each draw.
    fn vertex_counters(&self, units: &[Unit<'_>]) -> Vec<Counters> {
        let draws = self.prepared.iter().enumerate();
        draws
            .map(|(i, p)| vertex_traffic(p.draw, units, i))
            .collect()
    }

    fn batches(&self, units: &[Unit<'_>], is_listened_to: bool) -> Vec<Vec<Job>> {
        if is_listened_to {
            return batches(units, CHUNK, LISTENING_BATCH);
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

    /// Shades the vertices of the units up to the last of `jobs`.
    fn shade_for(
        &mut self,
        units: &[Unit<'_>],
        jobs: &[Job],
        vertices: &mut Vertices,
    ) -> Result<(), Error> {
        let end = jobs.last().map_or(0, |j| j.unit + 1);
        let start = vertices.ready;
        if start < end {
            vertices.ready = end;
            self.shade(&units[start..end], &mut vertices.shaded[start..end])?;
        }
        Ok(())
    }

    /// Shades the vertices of `units`, in recycled memory.
    fn shade(&mut self, units: &[Unit<'_>], shaded: &mut [ShadedVertices]) -> Result<(), Error> {
        let mut work = Vec::new();
        for (unit, out) in units.iter().zip(shaded) {
            *out = self.recycled.shaded.pop().unwrap_or_default();
            out.clear();
            let p = &self.prepared[unit.draw];
            let vertices = unit.referenced.vertices.len();
            out.resize(vertices, p.geometry.varyings, &p.draw.label)?;
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
        Ok(())
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

/// Pieces of chunks grouped by draw, in submission order.
fn draw_work<'a, 'c>(
    units: &[Unit<'_>],
    run: impl Iterator<Item = (&'c Piece, Job, &'a Chunk)>,
    shaded: &'a [ShadedVertices],
    prepared: &'a [Prepared<'a>],
) -> Vec<DrawWork<'a>> {
    let mut work: Vec<DrawWork<'a>> = Vec::new();
    let mut first = 0;
    for (piece, job, chunk) in run {
        let draw = units[job.unit].draw;
        let chunk = ChunkRef {
            chunk,
            shaded: &shaded[job.unit],
            triangles: piece.triangles.clone(),
            first,
        };
        first += piece.triangles.len() as u32;
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
