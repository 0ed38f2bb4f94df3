//! Paper II's figure 7: memory accesses against the size of culled tiles.

use super::lab::parsed;
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Series};
use crate::tile_traffic::{TileTraffic, measure};

pub(super) const TECHNIQUE: &str = "penumbra-wedges-restructured";

const TILES: [u32; 8] = [2, 4, 8, 16, 32, 64, 128, 256];
const SCENES: [&str; 2] = ["columns", "fractal"];
const PASSES: [&str; 2] = ["three", "single"];

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

    fn series(&self, what: &str, accesses: impl Fn(&TileTraffic) -> u64) -> Series {
        let point = |t: &TileTraffic| [f64::from(t.tile), accesses(t) as f64 / 1e6];
        let label = format!("{}, {}{what}", self.scene, self.passes);
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
    let mut measures = Vec::new();
    let (mut without, mut with) = (Vec::new(), Vec::new());
    for (scene, passes) in pairs() {
        let sweep = Sweep::new(lab, scene, passes, &TILES)?;
        let best = |what: &str, theirs, tile| {
            let name = format!("{scene}, {passes}: best tile{what}");
            Measure::new(name, theirs, tile, Unit::Count)
        };
        measures.push(best(
            ", zmin and zmax reads counted",
            Theirs::Within(8.0, 32.0),
            sweep.best(with_bounds),
        ));
        measures.push(Measure::beside(
            format!("{scene}, {passes}: best tile, as the paper counts"),
            "8 to 32",
            sweep.best(TileTraffic::accesses),
            Unit::Count,
        ));
        without.push(sweep.series("", TileTraffic::accesses));
        with.push(sweep.series("", with_bounds));
    }
    let chart = |name: &str, title: &str, series| Chart {
        name: name.to_owned(),
        title: title.to_owned(),
        x: Axis::log2("side of a tile, pixels"),
        y: Axis::linear("million accesses a frame"),
        series,
    };
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: "depth reads (4 B), stencil writes (1 B) and light-intensity writes (2 B) of \
            all wedge draws, and apart from them the zmin and zmax values (4 B each) that tests \
            of (triangle, tile) read, two for each"
            .to_owned(),
        measures,
        reason: "Without the tests' own reads smaller tiles are never worse, since they cull \
            all that larger ones do: the paper's sum, taken strictly, is least at the smallest \
            tile. The optimum of its figure 7 needs a cost of the test, which its figure 8 \
            has as time."
            .to_owned(),
        charts: vec![
            chart(
                "paper2-tile-size",
                "Accesses with the reads of zmin and zmax (paper II, figure 7)",
                with,
            ),
            chart(
                "paper2-tile-size-without-bounds",
                "Accesses as the paper counts them (paper II, figure 7)",
                without,
            ),
        ],
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
    }
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: "depth reads (4 B) and writes of stencil (1 B) and light-intensity buffer (2 B) \
            of all wedge draws, tiles of 8, 16 and 32 together; the pass that adds the \
            stencil's counts to the light-intensity buffer is left out"
            .to_owned(),
        measures,
        reason: "What is saved are front faces of the umbra's boundary under which there is \
            penumbra too; a scene whose wedges mostly hang in front of the surface has few."
            .to_owned(),
        charts: Vec::new(),
    })
}
