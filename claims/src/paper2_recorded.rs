//! Paper II's figure 7 from recordings, under the memory that it describes: no caches, and a
//! test of zmin and zmax for each triangle in each tile, of a size that varies.

use super::paper2_tiles::{PASSES, SCENES, TECHNIQUE, TILES};
use super::recorded::{Level, Recorded, uncached};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Series};
use gnomon_pipeline::technique::PassRole;
use gnomon_raster::state::CompareFunction;
use gnomon_traces::DrawShape;

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper2-tile-size-recorded",
    "paper II, §7, figure 7",
    Verdict::Counters,
    "Of tiles of 2 to 256 pixels those of 8 to 32 need fewest memory accesses: from \
     recordings, without caches.",
    tile_size,
)
.read_from(&[Lines::to(1090, 1097)])];

const WEDGES: [PassRole; 2] = [PassRole::UmbraStencil, PassRole::Wedges];

/// Accesses of the wedge draws of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Accesses {
    pub(super) depth_reads: u64,
    /// Of these, by shaders of penumbrae.
    pub(super) penumbra_reads: u64,
    pub(super) stencil_writes: u64,
    pub(super) intensity_writes: u64,
    /// Pairs of triangle and tile; each reads zmin and zmax.
    pub(super) tested: u64,
}

impl Accesses {
    /// Of a frame whose tiles have `tile` pixels a side.
    pub(super) fn of(
        lab: &Lab,
        scene: &str,
        passes: &str,
        tile: u32,
    ) -> Result<Self, ReproduceError> {
        let set = [format!("passes={passes}"), format!("tile={tile}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let scene = lab.scene(scene)?;
        let frame = Recorded::new(lab, &scene, (TECHNIQUE, &set), lab.size())?;
        let traffic = frame.judge(&uncached()?)?;
        let moved = frame.moved(&traffic, &WEDGES, Level::Asked);
        // What the depth test has read is not counted again where a shader reads it too.
        let by_test = |d: &DrawShape| d.depth_stencil.depth.compare != CompareFunction::Always;
        let of = |wanted: &dyn Fn(&DrawShape) -> bool| {
            frame.moved_by(&traffic, &WEDGES, Level::Asked, wanted)
        };
        let (tested, shaded) = (of(&by_test), of(&|d| !by_test(d)));
        // A stencil count reads its byte besides three of depth.
        let [read, written] = tested.depth_stencil;
        let penumbra_reads = shaded.texture / frame.texel_bytes(&[PassRole::Wedges]);
        Ok(Self {
            depth_reads: (read - written) / 3 + penumbra_reads,
            penumbra_reads,
            stencil_writes: moved.depth_stencil[1],
            intensity_writes: moved.color[1] / frame.color_bytes(&[PassRole::Wedges]),
            tested: frame.tiles_met(&[PassRole::Wedges], tile.ilog2())?,
        })
    }

    /// As the paper's text names them.
    fn named(&self) -> u64 {
        self.depth_reads + self.stencil_writes + self.intensity_writes
    }

    /// With the reads of zmin and zmax.
    fn all(&self) -> u64 {
        self.named() + 2 * self.tested
    }
}

/// The tile of fewest accesses, the smallest of several.
fn best(sweep: &[(u32, Accesses)], accesses: impl Fn(&Accesses) -> u64) -> f64 {
    let least = sweep.iter().min_by_key(|(_, a)| accesses(a));
    least.map_or(f64::NAN, |(tile, _)| f64::from(*tile))
}

fn tile_size(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let (mut measures, mut series) = (Vec::new(), Vec::new());
    for (scene, passes) in SCENES.into_iter().flat_map(|s| PASSES.map(|p| (s, p))) {
        let of = |tile: &u32| Ok((*tile, Accesses::of(lab, scene, passes, *tile)?));
        let sweep: Result<Vec<_>, ReproduceError> = TILES.iter().map(of).collect();
        let sweep = sweep?;
        let name = format!("{scene}, {passes}");
        measures.push(Measure::new(
            format!("{name}: best tile"),
            Theirs::Within(8.0, 32.0),
            best(&sweep, Accesses::all),
            Unit::Count,
        ));
        measures.push(Measure::beside(
            format!("{name}: best tile, reads of zmin and zmax left out"),
            "8-32",
            best(&sweep, Accesses::named),
            Unit::Count,
        ));
        let point = |(tile, a): &(u32, Accesses)| [f64::from(*tile), a.all() as f64 / 1e6];
        series.push(Series::line(&name, sweep.iter().map(point).collect()));
    }
    Ok(Finding {
        scene: lab.describe("columns, fractal and text-2002"),
        counted: "accesses of the wedge draws, from recordings under the profile `naive`: depth \
            reads by the depth test or, where there is none, by shaders; stencil writes, \
            light-intensity writes, and two reads of zmin and zmax for each pair of triangle \
            and tile in the recorded accesses of penumbrae. Depth tests of umbrae read every \
            pixel: a recording knows no zmax"
            .to_owned(),
        measures,
        reason: "The best size moves with the size of the picture and of its wedges.".to_owned(),
        charts: vec![Chart {
            name: "paper2-tile-size-recorded".to_owned(),
            title: "Accesses from recordings (paper II, figure 7)".to_owned(),
            x: Axis::log2("side of a tile, pixels"),
            y: Axis::linear("million accesses a frame"),
            series,
        }],
    })
}

#[cfg(test)]
mod tests {
    use super::super::lab::parsed;
    use super::super::tests::lab;
    use super::*;
    use gnomon_pipeline::measure::tile_traffic::measure;

    /// What recordings tell is what the model of tiles counts live, for every size.
    #[test]
    fn recorded_accesses_are_those_of_the_model() {
        let lab = lab();
        for (scene, passes) in [("columns", "three"), ("columns", "single")] {
            for tile in TILES {
                let told = Accesses::of(&lab, scene, passes, tile).unwrap();
                let set = [format!("passes={passes}"), format!("tile={tile}")];
                let set: Vec<&str> = set.iter().map(String::as_str).collect();
                let (_, params) = parsed(TECHNIQUE, &set).unwrap();
                let built = lab.scene(scene).unwrap();
                let live = measure(&built, lab.size(), &params, lab.settings().gpu);
                let live = live.unwrap().traffic;
                // One pass culls its umbra by tiles too, which no depth test does.
                let depth_reads = match passes {
                    "three" => live.depth_reads,
                    _ => told.depth_reads,
                };
                let expected = Accesses {
                    depth_reads,
                    penumbra_reads: live.penumbra_depth_reads,
                    stencil_writes: live.stencil_writes,
                    intensity_writes: live.intensity_writes,
                    tested: live.tested,
                };
                assert_eq!(told, expected, "{scene} {passes} {tile}");
                assert!(told.tested > 0 && told.depth_reads > 0);
            }
        }
    }

    #[test]
    fn reads_of_bounds_make_small_tiles_dear() {
        let lab = lab();
        let of = |tile| Accesses::of(&lab, "columns", "three", tile).unwrap();
        let sweep = [2, 8, 256].map(|tile| (tile, of(tile)));
        assert_eq!(best(&sweep, Accesses::all), 8.0, "{sweep:?}");
        assert_eq!(best(&sweep, Accesses::named), 2.0, "{sweep:?}");
    }
}
