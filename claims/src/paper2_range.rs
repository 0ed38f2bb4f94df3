//! Paper II, §4: the quick rejection test of tiles, the wedge's range of depth.

use super::lab::parsed;
use super::paper2_tiles::TECHNIQUE;
use super::tally::ratio;
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use gnomon_pipeline::measure::tile_traffic::{self, TileTraffic};

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper2-depth-range",
    "paper II, §4",
    Verdict::Counters,
    "Testing a wedge's range of depth first gains hardly anything beside its planes; that \
     range alone is significantly worse.",
    depth_range,
)
.read_from(&[Lines::one(1018), Lines::one(1025)])];

fn modelled(lab: &Lab, scene: &str, axes: &str) -> Result<TileTraffic, ReproduceError> {
    let scene = lab.scene(scene)?;
    let axes = format!("separating-axis={axes}");
    let (_, params) = parsed(TECHNIQUE, &["passes=three", &axes])?;
    let settings = lab.settings();
    let measured = tile_traffic::measure(&scene, settings.size, &params, settings.gpu)?;
    Ok(measured.traffic)
}

fn depth_range(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["columns", "fractal"] {
        let of = |axes| modelled(lab, name, axes);
        let (planes, both, alone) = (of("faces")?, of("range-faces")?, of("range")?);
        measures.extend([
            Measure::new(
                format!("{name}: depth reads that the range saves beside the planes"),
                Theirs::None {
                    neutral: 0.0,
                    within: 0.1,
                },
                1.0 - ratio(both.depth_reads, planes.depth_reads),
                Unit::Share,
            ),
            Measure::new(
                format!("{name}: depth reads, range alone over planes"),
                Theirs::AtLeast(1.1),
                ratio(alone.depth_reads, planes.depth_reads),
                Unit::Ratio,
            ),
            Measure::beside(
                format!("{name}: tile tests that end with the range"),
                "-",
                ratio(both.quickly_rejected, both.tested),
                Unit::Share,
            ),
        ]);
    }
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: "depth reads of all wedge draws, 4 B each, three passes, tiles of 8; pairs of \
            triangle and tile whose penumbra the range alone rejects, so that the four planes \
            need no test"
            .to_owned(),
        measures,
        reason: "Wedges here run to infinity, so that their range of depth ends at the far end; \
            the paper cut them at a bottom plane."
            .to_owned(),
        charts: Vec::new(),
    })
}
