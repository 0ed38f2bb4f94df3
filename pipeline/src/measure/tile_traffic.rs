//! What hardware with tile culling of a given size would move while it draws
//! penumbra wedges (paper II, §4 and §7).
//!
//! The technique `penumbra-wedges-restructured` culls the tiles of penumbrae, so their
//! depth reads and the writes of its buffers are counted by the emulated GPU as that
//! hardware would make them. It tests a tile once for each wedge whose bounds it lies in,
//! hardware once for each triangle that meets it, and it culls umbrae by blocks of its
//! own. This module runs the frame with an observer, takes the pixels that every triangle
//! covers, and repeats the tests once per triangle and tile. Its depth reads of penumbrae
//! must equal the GPU's; a test holds the two together.
//!
//! Counted are triangles, as a rasteriser meets them: a wedge whose two visible
//! faces share a tile tests it twice.

use std::collections::{BTreeMap, BTreeSet};

use gnomon_raster::{
    AccessBatch, AccessObserver, Counters, Gpu, GpuConfig, SubmitReport, Subresource, Wants,
};
use gnomon_shaders::penumbra::plane::ScreenPlane;
use gnomon_shaders::penumbra::tiles::{Culling, OutsideTest, TileTest};

use crate::measure::render::RenderError;
use crate::technique::{Params, Roles};
use crate::techniques::penumbra_wedges_restructured::{Adds, WedgeDraw, WedgeModel, build};
use crate::world::scene::Scene;

/// Accesses of the wedge draws of one frame, all lights together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileTraffic {
    /// Side of a tile in pixels.
    pub tile: u32,
    /// Tiles that some triangle of a wedge meets whose tiles may be culled.
    pub tiles_met: u64,
    /// Pairs of triangle and tile that were tested; 0 without culling.
    pub tested: u64,
    /// Of these, out of reach for all that the triangle adds.
    pub culled: u64,
    /// Of these, wholly inside the wedge: their pixels need no test.
    pub accepted: u64,
    /// Of these, pairs whose penumbra the wedge's range of depth alone rejects, so
    /// that its planes need no test; 0 where the range is not tested.
    pub quickly_rejected: u64,
    /// zmin and zmax values read by these tests.
    pub bound_reads: u64,
    /// Pixels that the triangles cover.
    pub fragments: u64,
    /// Pixels whose depth is read to decide.
    pub depth_reads: u64,
    /// Of these, by draws that add penumbrae and no umbra.
    pub penumbra_depth_reads: u64,
    /// Read-modify-writes of light-intensity buffers.
    pub intensity_writes: u64,
    /// Read-modify-writes of the stencil: the umbra of the three-pass algorithm.
    pub stencil_writes: u64,
}

impl TileTraffic {
    /// Depth reads and stencil and intensity writes: what the paper's figure 7
    /// sums. Reads of zmin and zmax are left out there.
    pub fn accesses(&self) -> u64 {
        self.depth_reads + self.intensity_writes + self.stencil_writes
    }
}

/// The model's counts, and those of the emulated GPU for the same frame.
#[derive(Clone, Debug)]
pub struct Measured {
    /// By the model; writes are the GPU's.
    pub traffic: TileTraffic,
    /// The GPU's counters over the same draws.
    pub gpu: Counters,
    /// Everything that the GPU counted.
    pub report: SubmitReport,
    /// What the passes of the report are for.
    pub roles: Roles,
}

/// Renders a frame of `penumbra-wedges-restructured` and counts what its wedges
/// move. `params` are that technique's.
///
/// # Errors
/// The technique refuses the scene, or the GPU its settings.
pub fn measure(
    scene: &Scene,
    size: [u32; 2],
    params: &Params,
    config: GpuConfig,
) -> Result<Measured, RenderError> {
    let built = build(scene, size, params)?;
    let mut gpu = Gpu::new(config)?;
    gpu.load(&built.frame.recording)?;
    let mut covered = Covered::new(&built.wedge_draws);
    let report =
        gpu.submit_observed(&built.frame.recording.list, Wants::default(), &mut covered)?;
    let depth = gpu
        .texture(built.frame.outputs.depth_stencil)?
        .read_depth(Subresource::default())?;
    let tiles = built.wedge_draws.first().map(|d| d.model.tiles.clone());
    let tiles = tiles.unwrap_or_default();
    let bounds = TileBounds::new(&depth, size, tiles.shift);
    let mut traffic = covered.count(&built.wedge_draws, &bounds);
    traffic.tile = 1 << tiles.shift;
    let mut totals = Counters::default();
    for draw in &built.wedge_draws {
        let [pass, number] = draw.at;
        totals.add(&report.passes[pass].draws[number].counters);
    }
    traffic.intensity_writes = totals.traffic.color[0].write_accesses;
    traffic.stencil_writes = totals.traffic.stencil.write_accesses;
    Ok(Measured {
        traffic,
        gpu: totals,
        report,
        roles: built.frame.roles,
    })
}

/// Pixels of one block that a triangle covers.
struct Footprint {
    /// Index into the wedge draws, and number of the primitive.
    triangle: (u32, u32),
    block: [u16; 2],
    mask: u64,
}

/// Keeps what wedge draws cover.
struct Covered {
    /// Index of the wedge draw by pass and draw.
    draws: BTreeMap<(usize, u32), u32>,
    footprints: Vec<Footprint>,
}

impl AccessObserver for Covered {
    fn batch(&mut self, pass: usize, batch: &AccessBatch<'_>) {
        for access in batch.blocks {
            if let Some(&draw) = self.draws.get(&(pass, access.draw)) {
                self.footprints.push(Footprint {
                    triangle: (draw, access.primitive),
                    block: access.block,
                    mask: access.covered,
                });
            }
        }
    }
}

impl Covered {
    fn new(draws: &[WedgeDraw]) -> Self {
        let key = |(i, d): (usize, &WedgeDraw)| ((d.at[0], d.at[1] as u32), i as u32);
        Self {
            draws: draws.iter().enumerate().map(key).collect(),
            footprints: Vec::new(),
        }
    }

    fn count(&self, draws: &[WedgeDraw], bounds: &TileBounds) -> TileTraffic {
        let mut pixels: BTreeMap<((u32, u32), [u32; 2]), u64> = BTreeMap::new();
        for f in &self.footprints {
            for (tile, mask) in tiles_of(f.block, f.mask, bounds.shift) {
                *pixels.entry((f.triangle, tile)).or_default() += u64::from(mask.count_ones());
            }
        }
        let mut traffic = TileTraffic::default();
        let mut met = BTreeSet::new();
        for ((triangle, tile), count) in pixels {
            let model = &draws[triangle.0 as usize].model;
            let space = bounds.of(tile, &model.tiles);
            let class = classify(model, space);
            traffic.fragments += count;
            if model.tiles.culling != Culling::None {
                traffic.tested += 1;
                met.insert(tile);
                let quick = space.is_some_and(|t| beyond_any(&model.tiles.range, &t));
                traffic.quickly_rejected += u64::from(quick);
                traffic.culled += u64::from(class == TileClass::Culled);
                traffic.accepted += u64::from(class == TileClass::Accepted);
                let both = model.tiles.culling == Culling::ZminZmax;
                traffic.bound_reads += if both { 2 } else { 1 };
            }
            if class != TileClass::Culled {
                traffic.depth_reads += count;
                let penumbra = model.adds == Adds::Penumbra;
                traffic.penumbra_depth_reads += if penumbra { count } else { 0 };
            }
        }
        traffic.tiles_met = met.len() as u64;
        traffic
    }
}

/// The tiles that a block's pixels lie in, and which pixels are in each.
fn tiles_of([column, row]: [u16; 2], mask: u64, shift: u32) -> Vec<([u32; 2], u64)> {
    let [x, y] = [8 * u32::from(column), 8 * u32::from(row)];
    if shift >= 3 {
        return vec![([x >> shift, y >> shift], mask)];
    }
    let side = 1u32 << shift;
    let line = (1u64 << side) - 1;
    let square = (0..side).fold(0, |m, r| m | line << (8 * r));
    let places = (0..8).step_by(side as usize);
    let all = places
        .clone()
        .flat_map(|dy| places.clone().map(move |dx| (dx, dy)));
    let cut = all.map(|(dx, dy): (u32, u32)| {
        let tile = [(x + dx) >> shift, (y + dy) >> shift];
        (tile, mask & square << (8 * dy + dx))
    });
    cut.filter(|(_, m)| *m != 0).collect()
}

/// zmin and zmax of all tiles, as the pass `tile depths` finds them.
struct TileBounds {
    shift: u32,
    size: [u32; 2],
    columns: u32,
    /// Least and greatest depth of surfaces; `None` without any.
    depth: Vec<Option<[f32; 2]>>,
}

impl TileBounds {
    fn new(depth: &[f32], [width, height]: [u32; 2], shift: u32) -> Self {
        let [columns, rows] = [width, height].map(|s| s.div_ceil(1 << shift));
        let mut all: Vec<Option<[f32; 2]>> = vec![None; (columns * rows) as usize];
        for (i, &z) in depth.iter().enumerate().filter(|(_, z)| **z < 1.0) {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let known = &mut all[((y >> shift) * columns + (x >> shift)) as usize];
            let [low, high] = known.unwrap_or([z, z]);
            *known = Some([
                if z < low { z } else { low },
                if z > high { z } else { high },
            ]);
        }
        Self {
            shift,
            size: [width, height],
            columns,
            depth: all,
        }
    }

    /// The box of a tile in x, y and 1 - depth; `None` without surface.
    fn of(&self, [column, row]: [u32; 2], test: &TileTest) -> Option<[[f32; 2]; 3]> {
        let [least, greatest] = self.depth[(row * self.columns + column) as usize]?;
        let extent = |tile: u32, size: u32| {
            let first = (tile << self.shift) as f32 + 0.5;
            let last = first + ((1u32 << self.shift) - 1) as f32;
            let end = size as f32 - 0.5;
            [first, if last < end { last } else { end }]
        };
        let nearest = match test.culling {
            Culling::ZminZmax => 1.0 - least,
            _ => 1.0,
        };
        let [width, height] = self.size;
        Some([
            extent(column, width),
            extent(row, height),
            [1.0 - greatest, nearest],
        ])
    }
}

/// What becomes of a triangle in a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TileClass {
    Culled,
    Accepted,
    Crossing,
}

/// The test of a tile, for one box: the penumbra's as the shader has it.
fn classify(model: &WedgeModel, tile: Option<[[f32; 2]; 3]>) -> TileClass {
    if model.tiles.culling == Culling::None {
        return TileClass::Crossing;
    }
    let Some(tile) = tile else {
        return TileClass::Culled;
    };
    let [front, back, first, second] = model.wedge.planes.map(|p| p.range_in(&tile));
    let margin = model.wedge.front_margin;
    let eye_inside = model.wedge.planes[0].eye_is_inside();
    let umbra_culled = if eye_inside == model.depth_fail {
        front[1] < -margin
    } else {
        front[0] >= margin
    };
    let bottom = model.wedge.bottom.map(|p| p.range_in(&tile));
    let [below, partly] = [1, 0].map(|k| bottom.is_some_and(|b| b[k] < 0.0));
    let by_planes = model.tiles.outside == OutsideTest::Planes
        && (below || front[1] < -margin || back[1] < 0.0 || first[1] < 0.0 || second[1] <= 0.0);
    let penumbra_culled =
        by_planes || beyond_any(&model.tiles.range, &tile) || beyond_any(&model.tiles.axes, &tile);
    let inside =
        !partly && front[0] >= margin && back[0] >= 0.0 && first[0] >= 0.0 && second[0] > 0.0;
    let culled = match model.adds {
        Adds::Umbra => umbra_culled,
        Adds::Penumbra => penumbra_culled,
        Adds::Both => umbra_culled && penumbra_culled,
    };
    match culled {
        true => TileClass::Culled,
        false if inside && model.adds != Adds::Umbra => TileClass::Accepted,
        false => TileClass::Crossing,
    }
}

/// Whether the box lies beyond one of the planes by more than its margin.
fn beyond_any(planes: &[(ScreenPlane, f32)], tile: &[[f32; 2]; 3]) -> bool {
    let beyond = |(plane, margin): &(ScreenPlane, f32)| plane.range_in(tile)[1] < -margin;
    planes.iter().any(beyond)
}

#[cfg(test)]
mod tests;
