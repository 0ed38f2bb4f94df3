//! Paper II's claims about times: one pass, three passes, and paper I beside them.

use super::paper2::BYTES;
use super::paper2_tiles::TECHNIQUE;
use super::tally::{counters, pass_time, ratio};
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use gnomon_pipeline::technique::PassRole;

/// The passes of a light besides ambient, tile depths and lit.
pub(super) const WEDGES: [PassRole; 5] = [
    PassRole::TileClasses,
    PassRole::UmbraCaps,
    PassRole::UmbraStencil,
    PassRole::UmbraCounts,
    PassRole::Wedges,
];

pub(super) fn restructuring(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let runs: [(&str, &[&str]); 3] = [
        ("penumbra-wedges", &[]),
        (TECHNIQUE, &["passes=three", "culling=none"]),
        (TECHNIQUE, &["passes=single", "culling=none"]),
    ];
    let [original, three, single] = lab.race(&scene, runs)?;
    let time = |done| pass_time(done, &WEDGES);
    let pixels = |done| counters(done, &WEDGES).fragment_shader_invocations;
    let measure = |what, done| {
        let ours = time(&original) / time(done);
        Measure::new(what, Theirs::ratio(1.3, 1.4), ours, Unit::Ratio)
    };
    let beside = |what, done| {
        let ours = ratio(pixels(done), pixels(&original));
        Measure::beside(what, "-", ours, Unit::Ratio)
    };
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: "time and shader invocations of the passes between ambient and lit, on the \
            emulated GPU"
            .to_owned(),
        measures: vec![
            measure("paper I's time over three passes'", &three),
            measure("paper I's time over one pass's", &single),
            beside("invocations of three passes over paper I's", &three),
            beside("invocations of one pass over paper I's", &single),
        ],
        reason: "The restructured algorithm saves arithmetic a pixel and rasterises more pixels: \
            umbra boundaries besides front faces of wedges, where our paper I draws back faces \
            once. On 16 lanes arithmetic is cheap and a pixel that is drawn is not. So paper I \
            is the faster one here; on a scalar processor it was the other way."
            .to_owned(),
        charts: Vec::new(),
    })
}

pub(super) fn single_pass_time(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let [three, single] = lab.race(
        &scene,
        [
            (TECHNIQUE, &["passes=three"]),
            (TECHNIQUE, &["passes=single"]),
        ],
    )?;
    let ours = pass_time(&three, &WEDGES) / pass_time(&single, &WEDGES) - 1.0;
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: "time of the passes between ambient and lit, tiles of 8, on the emulated GPU"
            .to_owned(),
        measures: vec![Measure::new(
            "one pass is faster by",
            Theirs::share(0.2, 0.6),
            ours,
            Unit::Share,
        )],
        reason: "Three passes rasterise front planes twice, but two of the passes only count a \
            stencil, which the emulated GPU does for whole blocks; one pass runs the longer \
            shader wherever either part is drawn. With the load of a machine the sign changes."
            .to_owned(),
        charts: Vec::new(),
    })
}

pub(super) fn beside_paper1(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let runs: [(&str, &[&str]); 2] = [("penumbra-wedges", &[]), (TECHNIQUE, &["passes=three"])];
    let [original, three] = lab.race(&scene, runs)?;
    // Depth is texture 0 of both; the reads of zmin and zmax are left out, which the
    // shader makes once a pixel and not once a tile.
    let accesses = |done| {
        let t = counters(done, &WEDGES).traffic;
        t.tex[0].read_accesses + t.stencil.write_accesses + t.color[0].write_accesses
    };
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: format!(
            "time, depth reads and buffer writes of the passes between ambient and lit: {BYTES}"
        ),
        measures: vec![
            Measure::new(
                "paper I's time over ours",
                Theirs::ratio(3.0, 6.0),
                pass_time(&original, &WEDGES) / pass_time(&three, &WEDGES),
                Unit::Ratio,
            ),
            Measure::beside(
                "paper I's depth reads and buffer writes over ours",
                "-",
                ratio(accesses(&original), accesses(&three)),
                Unit::Ratio,
            ),
        ],
        reason: "The six came of culling tiles without running the shader, and of an umbra \
            drawn by a graphics card beside the CPU; the emulated GPU tests a tile at each of \
            its pixels and draws everything itself."
            .to_owned(),
        charts: Vec::new(),
    })
}
