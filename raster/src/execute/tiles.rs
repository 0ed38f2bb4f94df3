//! The tile stage of a pass: its tiles, what is done to them at both ends, and the
//! workers' desks.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::split::{Fill, Lent};
use crate::counters::AccessSizes;
use crate::geometry::TileGrid;
use crate::gpu::Gpu;
use crate::observer::Wants;
use crate::simd::SimdLevel;
use crate::tile::{DrawWork, Gathered, Scratch, TileTarget, run_tile};

/// What a worker needs beside the tile itself; what it counts and finds.
pub(super) struct Desk {
    pub(super) scratch: Scratch,
    gathered: Gathered,
}

/// Desks of a pass. A worker takes any free one for a tile: all that they gather
/// is sums, and lists that are sorted in the end.
#[derive(Default)]
pub(super) struct Desks(Mutex<Vec<Desk>>);

impl Desks {
    fn take(&self, draws: usize) -> Desk {
        let free = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        free.unwrap_or_else(|| Desk {
            scratch: Scratch::new(draws),
            gathered: Gathered::default(),
        })
    }

    fn put(&self, desk: Desk) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(desk);
    }

    /// What the workers have gathered.
    pub(super) fn gathered(&mut self) -> impl Iterator<Item = &mut Gathered> {
        let all = self.0.get_mut().unwrap_or_else(PoisonError::into_inner);
        all.iter_mut().map(|d| &mut d.gathered)
    }

    pub(super) fn into_all(self) -> Vec<Desk> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tiles of a pass, and who works on them.
pub(super) struct TileStage<'a> {
    gpu: &'a Gpu,
    grid: TileGrid,
    sizes: AccessSizes,
    tiles: Vec<TileTarget<'a>>,
    /// What the load operations store, until they have.
    loads: Option<Fill>,
    stores: Fill,
    draws: usize,
    parallel: bool,
    pub(super) desks: Desks,
}

impl<'a> TileStage<'a> {
    /// The attachments' tiles, for `draws` draws.
    pub(super) fn new(gpu: &'a Gpu, grid: TileGrid, draws: usize, lent: &'a mut Lent) -> Self {
        Self {
            gpu,
            grid,
            sizes: lent.sizes,
            loads: Some(lent.loads()),
            stores: lent.stores(),
            tiles: lent.tiles(gpu.config.tile),
            draws,
            parallel: gpu.parallel,
            desks: Desks::default(),
        }
    }

    /// Runs `work` on all tiles, after the load operations the first time, and before
    /// the store operations where the pass `ends`; gathers what a listener wants.
    pub(super) fn run(&mut self, work: &[DrawWork<'_>], ends: bool, wants: Option<Wants<'_>>) {
        let loads = self.loads.take();
        let visit = Visit {
            level: self.gpu.config.simd,
            grid: self.grid,
            work,
            sizes: &self.sizes,
            before: loads.as_ref(),
            after: ends.then_some(&self.stores),
            wants,
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
    wants: Option<Wants<'a>>,
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
            self.wants.map(|w| (w, &mut desk.gathered)),
            self.after.is_some(),
        );
        if let Some(fill) = self.after {
            fill.apply(tile, self.sizes);
        }
    }
}
