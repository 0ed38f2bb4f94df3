//! Paper II's figure 7: memory accesses against the size of culled tiles.

use super::lab::parsed;
use super::tally::ratio;
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Series};
use gnomon_pipeline::measure::tile_traffic::{TileTraffic, measure};
use gnomon_pipeline::technique::PassRole;

pub(super) const TECHNIQUE: &str = "penumbra-wedges-restructured";

pub(super) const TILES: [u32; 8] = [2, 4, 8, 16, 32, 64, 128, 256];
pub(super) const SCENES: [&str; 3] = ["columns", "fractal", "text-2002"];
pub(super) const PASSES: [&str; 2] = ["three", "single"];

/// Counts of one scene and algorithm over tile sizes.
struct Sweep {
    scene: &'static str,
    passes: &'static str,
    traffic: Vec<TileTraffic>,
}

impl Sweep {
    fn new(
        lab: &Lab,
        scene: &'static str,
        passes: &'static str,
        tiles: &[u32],
    ) -> Result<Self, ReproduceError> {
        let built = lab.scene(scene)?;
        let settings = lab.settings();
        let of = |tile: &u32| {
            let set = [format!("passes={passes}"), format!("tile={tile}")];
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            let (_, params) = parsed(TECHNIQUE, &set)?;
            Ok(measure(&built, settings.size, &params, settings.gpu)?.traffic)
        };
        Ok(Self {
            scene,
            passes,
            traffic: tiles
                .iter()
                .map(of)
                .collect::<Result<_, ReproduceError>>()?,
        })
    }

    /// The tile size of fewest accesses, the smallest of several.
    fn best(&self, accesses: impl Fn(&TileTraffic) -> u64) -> f64 {
        let least = self.traffic.iter().min_by_key(|t| accesses(t));
        least.map_or(f64::NAN, |t| f64::from(t.tile))
    }

    fn series(&self, accesses: impl Fn(&TileTraffic) -> u64) -> Series {
        let point = |t: &TileTraffic| [f64::from(t.tile), accesses(t) as f64 / 1e6];
        let label = format!("{}, {}", self.scene, self.passes);
        Series::line(&label, self.traffic.iter().map(point).collect())
    }

    fn sum(&self, part: impl Fn(&TileTraffic) -> u64) -> f64 {
        self.traffic.iter().map(part).sum::<u64>() as f64
    }
}

/// Depth reads and buffer writes, and the zmin and zmax values read by tests.
fn with_bounds(t: &TileTraffic) -> u64 {
    t.accesses() + t.bound_reads
}

pub(super) fn tile_size(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    Ok(Finding {
        scene: lab.describe("columns, fractal and text-2002"),
        counted: "depth reads (4 B), stencil writes (1 B) and light-intensity writes (2 B) of \
            all wedge draws, and two reads of zmin and zmax (4 B each) for each (triangle, \
            tile) that is tested"
            .to_owned(),
        reason: "The best size moves with the size of the picture and of its wedges.".to_owned(),
        ..figure7(
            lab,
            "paper2-tile-size",
            "Accesses, reads of zmin and zmax counted (paper II, figure 7)",
            with_bounds,
        )?
    })
}

pub(super) fn tile_size_as_counted(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    Ok(Finding {
        scene: lab.describe("columns, fractal and text-2002"),
        counted: "depth reads (4 B), stencil writes (1 B) and light-intensity writes (2 B) of \
            all wedge draws, as the text of the paper names them"
            .to_owned(),
        reason: "Without the reads of the tests themselves smaller tiles are never worse, since \
            they cull all that larger ones do: this sum is least at the smallest tile. The \
            paper's curve, which rises there, must have a cost of the test in it."
            .to_owned(),
        ..figure7(
            lab,
            "paper2-tile-size-as-counted",
            "Accesses, as the text of paper II counts them (figure 7)",
            TileTraffic::accesses,
        )?
    })
}

/// The figure, and the best tile of each of its curves.
fn figure7(
    lab: &Lab,
    name: &str,
    title: &str,
    accesses: fn(&TileTraffic) -> u64,
) -> Result<Finding, ReproduceError> {
    let (mut measures, mut series) = (Vec::new(), Vec::new());
    for (scene, passes) in pairs() {
        let sweep = Sweep::new(lab, scene, passes, &TILES)?;
        measures.push(Measure::new(
            format!("{scene}, {passes}: best tile"),
            Theirs::Within(8.0, 32.0),
            sweep.best(accesses),
            Unit::Count,
        ));
        series.push(sweep.series(accesses));
    }
    Ok(Finding {
        scene: String::new(),
        counted: String::new(),
        measures,
        reason: String::new(),
        charts: vec![Chart {
            name: name.to_owned(),
            title: title.to_owned(),
            x: Axis::log2("side of a tile, pixels"),
            y: Axis::linear("million accesses a frame"),
            series,
        }],
    })
}

fn pairs() -> impl Iterator<Item = (&'static str, &'static str)> {
    SCENES
        .into_iter()
        .flat_map(|scene| PASSES.map(|passes| (scene, passes)))
}

pub(super) fn single_pass(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for scene in SCENES {
        let three = Sweep::new(lab, scene, "three", &TILES[2..5])?;
        let single = Sweep::new(lab, scene, "single", &TILES[2..5])?;
        let mut saved = |what: &str, theirs, part: fn(&TileTraffic) -> u64| {
            measures.push(Measure::new(
                format!("{scene}: {what} saved"),
                theirs,
                1.0 - single.sum(part) / three.sum(part),
                Unit::Share,
            ));
        };
        saved("buffer writes", Theirs::share(0.05, 0.05), |t| {
            t.stencil_writes + t.intensity_writes
        });
        saved("depth reads", Theirs::share(0.3, 0.6), |t| t.depth_reads);
        saved(
            "all accesses",
            Theirs::share(0.2, 0.3),
            TileTraffic::accesses,
        );
        measures.push(Measure::beside(
            format!("{scene}: penumbrae's share of three passes' depth reads"),
            "-",
            penumbra_share(lab, scene)?,
            Unit::Share,
        ));
    }
    Ok(Finding {
        scene: lab.describe("columns, fractal and text-2002"),
        counted: "depth reads (4 B) and writes of stencil (1 B) and light-intensity buffer (2 B) \
            of all wedge draws, tiles of 8, 16 and 32 together; the pass that adds the \
            stencil's counts to the light-intensity buffer is left out"
            .to_owned(),
        measures,
        reason: "At most the penumbra's share of the depth reads can be saved. Here culling \
            leaves the penumbra fewer of them than the paper's does (see paper2-culling), and \
            the umbra keeps its own."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// Reads of depth by penumbrae, of all by wedges, tiles of 8.
fn penumbra_share(lab: &Lab, scene: &str) -> Result<f64, ReproduceError> {
    let scene = lab.scene(scene)?;
    let (_, params) = parsed(TECHNIQUE, &["passes=three"])?;
    let settings = lab.settings();
    let measured = measure(&scene, settings.size, &params, settings.gpu)?;
    let passes = measured.report.passes.iter().zip(measured.roles.passes());
    let wedges = passes.filter(|(_, role)| **role == PassRole::Wedges);
    let reads = wedges.map(|(p, _)| p.totals().traffic.tex[0].read_accesses);
    Ok(ratio(reads.sum(), measured.traffic.depth_reads))
}
