//! Paper II: Assarsson and Akenine-Möller, "Interactive Rendering of Soft Shadows
//! using an Optimized and Generalized Penumbra Wedge Algorithm", 2002; §4, §6, §7.
//!
//! Its scenes are a colonnade and a fractal landscape at 640x427; ours are the
//! built-in `columns` and `fractal`. Its evaluation was a software rasteriser that
//! counted accesses, and so is this.

use super::lab::parsed;
use super::paper2_ending::{self, penumbra_reads};
use super::paper2_tiles::{self, TECHNIQUE};
use super::paper2_time;
use super::tally::{pass_time, ratio};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::measure::tile_traffic::{self, Measured};
use gnomon_pipeline::technique::PassRole;

/// What an access is.
pub(super) const BYTES: &str = "depth 4 B (float texture), zmin or zmax 4 B, light-intensity buffer 2 B, \
    stencil 1 B an access; ratios are of accesses";

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "paper2-restructuring",
        "paper II, §7",
        Verdict::Times,
        "Umbra and penumbra apart, without culling: 1.3-1.4 times as fast as paper I.",
        paper2_time::restructuring,
    )
    .read_from(&[Lines::one(1085)]),
    Claim::new(
        "paper2-culling",
        "paper II, §4 and §7",
        Verdict::Counters,
        "Culling tiles by zmin and zmax makes penumbra rasterisation 3-4 times as fast.",
        culling,
    )
    .read_from(&[Lines::to(1005, 1009), Lines::one(1025), Lines::one(1101)]),
    Claim::new(
        "paper2-zmax-only",
        "paper II, §7",
        Verdict::Counters,
        "With zmax alone nothing is gained: columns fall from 7.0 to 2.6 fps, depth reads \
         grow by 50%, stencil writes stay as they are.",
        zmax_only,
    )
    .read_from(&[Lines::to(1101, 1103)]),
    Claim::new(
        "paper2-tile-size",
        "paper II, §7, figure 7",
        Verdict::Counters,
        "Of tiles of 2 to 256 pixels those of 8 to 32 need fewest memory accesses.",
        paper2_tiles::tile_size,
    )
    .read_from(&[Lines::to(1090, 1097)]),
    Claim::new(
        "paper2-tile-size-as-counted",
        "paper II, §7, figure 7",
        Verdict::Counters,
        "The same, the sum being of depth reads and stencil writes alone, as the text says.",
        paper2_tiles::tile_size_as_counted,
    )
    .read_from(&[Lines::to(1090, 1092)]),
    Claim::new(
        "paper2-single-pass",
        "paper II, §7",
        Verdict::Counters,
        "At tiles of 8 to 32 one pass instead of three saves about 5% of stencil writes, \
         30-60% of depth reads, 20-30% of all accesses.",
        paper2_tiles::single_pass,
    )
    .read_from(&[Lines::one(1099)]),
    Claim::new(
        "paper2-single-pass-time",
        "paper II, §7",
        Verdict::Times,
        "One pass is 20-60% faster than three, all in software.",
        paper2_time::single_pass_time,
    )
    .read_from(&[Lines::one(1099)]),
    Claim::new(
        "paper2-further-tests",
        "paper II, §4",
        Verdict::Counters,
        "Testing tiles against the wedge's planes is enough: its depth range and further \
         separating axes gain hardly anything.",
        further_tests,
    )
    .read_from(&[Lines::to(1014, 1020), Lines::one(1025)]),
    Claim::new(
        "paper2-test-share",
        "paper II, §4",
        Verdict::Counters,
        "The culling test takes about 1.5% of the execution time.",
        test_share,
    )
    .read_from(&[Lines::one(1025)]),
    Claim::new(
        "paper2-beside-paper1",
        "paper II, §7",
        Verdict::Times,
        "Three passes with culling are up to six times as fast as paper I on columns.",
        paper2_time::beside_paper1,
    )
    .read_from(&[Lines::one(1105)]),
    Claim::new(
        "paper2-overlaps",
        "paper I, §4.2; paper II, §6",
        Verdict::Arithmetic,
        "A signed 16-bit light-intensity buffer holds at least 256 overlapping wedges (paper I), \
         at least 127 overlapping shadow volumes (paper II).",
        overlaps,
    )
    .read_from(&[Lines::to(643, 647), Lines::one(952), Lines::to(1063, 1065)]),
    Claim::quoted(
        "paper2-frame-rates",
        "paper II, §7",
        "Pentium 4 at 1.7 GHz and GeForce3, three passes: columns 7 fps (2.6 with zmax alone), \
         fractal 1.75 where it has 2.3 without soft shadows, 2002 3.6, Venus 1; with the umbra \
         in hardware 60-80% faster than paper I.",
    )
    .read_from(&[
        Lines::one(915),
        Lines::one(1085),
        Lines::one(1103),
        Lines::to(1177, 1183),
    ]),
];

fn culling(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["columns", "fractal"] {
        let scene = lab.scene(name)?;
        let [without, with] = lab.race(
            &scene,
            [
                (TECHNIQUE, &["passes=three", "culling=none"]),
                (TECHNIQUE, &["passes=three", "culling=zminmax"]),
            ],
        )?;
        measures.push(Measure::new(
            format!("{name}: penumbra depth reads, without over with"),
            Theirs::ratio(3.0, 4.0),
            ratio(penumbra_reads(&without), penumbra_reads(&with)),
            Unit::Ratio,
        ));
        let time = penumbra_time;
        measures.push(Measure::beside(
            format!("{name}: penumbra time, without over with"),
            "3-4x",
            time(&without) / time(&with),
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: frame time, without over with"),
            "up to 3x",
            without.frame_ms / with.frame_ms,
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: format!(
            "depth reads of the pass `penumbra`, three passes, tiles of 8: {BYTES}. Times are \
             of the passes that classify tiles and draw penumbrae; a pixel in a culled tile \
             still runs a shader, that reads the tile's class and ends"
        ),
        measures,
        reason: "Reads are not all of the time that the paper measured. Of the reads saved, most \
            are saved by zmax already (see paper2-zmax-only), which the paper found to save \
            none; zmin halves what zmax leaves."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// How far shadows of `columns` reach behind their silhouettes before all of them lies
/// below the floor.
const LENGTH: &str = "wedge-length=3.5";

fn zmax_only(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let runs: [(&str, &[&str]); 4] = [
        (TECHNIQUE, &["passes=three", LENGTH, "culling=none"]),
        (TECHNIQUE, &["passes=three", LENGTH, "culling=zmax"]),
        (TECHNIQUE, &["passes=three", LENGTH, "culling=zminmax"]),
        (TECHNIQUE, &["passes=three", "culling=zminmax"]),
    ];
    let [none, zmax, both, endless] = lab.race(&scene, runs)?;
    let set = |culling| ["passes=three", LENGTH, culling];
    let traffic = |culling| Ok::<_, ReproduceError>(modelled(lab, &set(culling))?.traffic);
    let (with_zmax, with_both) = (traffic("culling=zmax")?, traffic("culling=zminmax")?);
    let writes = |t: &tile_traffic::TileTraffic| t.stencil_writes + t.intensity_writes;
    let saved = |done| 1.0 - ratio(penumbra_reads(done), penumbra_reads(&none));
    let other = both.visibility.iter().zip(&endless.visibility);
    let other = other.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    let mut measures = vec![
        Measure::new(
            "penumbra depth reads that zmax saves",
            Theirs::None {
                neutral: 0.0,
                within: 0.1,
            },
            saved(&zmax),
            Unit::Share,
        ),
        Measure::beside(
            "penumbra depth reads that both save",
            "-",
            saved(&both),
            Unit::Share,
        ),
        Measure::new(
            "more depth reads with zmax than with both",
            Theirs::share(0.5, 0.5),
            ratio(with_zmax.depth_reads, with_both.depth_reads) - 1.0,
            Unit::Share,
        ),
        Measure::new(
            "buffer writes that differ",
            Theirs::Exactly(0.0),
            writes(&with_zmax).abs_diff(writes(&with_both)) as f64,
            Unit::Count,
        ),
        Measure::beside(
            "penumbra depth reads, zmax over both",
            "2.7x frame",
            ratio(penumbra_reads(&zmax), penumbra_reads(&both)),
            Unit::Ratio,
        ),
        Measure::beside(
            "penumbra time, zmax over both",
            "2.7x frame",
            penumbra_time(&zmax) / penumbra_time(&both),
            Unit::Ratio,
        ),
        Measure::new(
            "pixels that endless shadows change, of all",
            Theirs::AtMost(1e-3),
            other as f64 / both.visibility.len() as f64,
            Unit::Share,
        ),
    ];
    measures.extend(paper2_ending::text(lab)?);
    Ok(Finding {
        scene: lab.describe(
            "columns, shadows that end 3.5 units behind their silhouettes, and text-2002, 2.2 units",
        ),
        counted: format!(
            "depth reads, and writes of stencil and light-intensity buffer, of all wedge draws, \
             three passes, tiles of 8: {BYTES}"
        ),
        measures,
        reason: ZMAX_REASON.to_owned(),
        charts: Vec::new(),
    })
}

const ZMAX_REASON: &str = "What zmax saves is what of a wedge lies behind surfaces: of \
    text-2002, whose wedges end at the floor, a third, where it saves four fifths of endless \
    ones; and zmin then saves as much more as the paper says. Of columns shadows that end \
    change little: most of a wedge is drawn over the floor that it goes below and over \
    columns between it and the eye, which is low, while almost nothing occludes the \
    shadows of the paper's. Pixels of columns differ from endless shadows where those of \
    the nearest go on behind the end.";

/// Time of the classes of tiles and of the wedges that use them.
fn penumbra_time(done: &Rendered) -> f64 {
    pass_time(done, &[PassRole::TileClasses, PassRole::Wedges])
}

/// What the model of tiles counts on columns.
fn modelled(lab: &Lab, set: &[&str]) -> Result<Measured, ReproduceError> {
    let scene = lab.scene("columns")?;
    let (_, params) = parsed(TECHNIQUE, set)?;
    let settings = lab.settings();
    Ok(tile_traffic::measure(
        &scene,
        settings.size,
        &params,
        settings.gpu,
    )?)
}

fn further_tests(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let faces = modelled(lab, &["passes=three"])?.traffic;
    let full = modelled(lab, &["passes=three", "separating-axis=full"])?.traffic;
    let saved = 1.0 - ratio(full.depth_reads, faces.depth_reads);
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: format!(
            "depth reads of all wedge draws, three passes, tiles of 8: {BYTES}. The further \
             tests are the wedge's range of depth and the axes of edge pairs, together; the \
             range alone, of which the paper says that it is much worse, is measured by \
             paper2-depth-range"
        ),
        measures: vec![
            Measure::new(
                "depth reads that all further tests save",
                Theirs::None {
                    neutral: 0.0,
                    within: 0.1,
                },
                saved,
                Unit::Share,
            ),
            Measure::beside(
                "tiles culled more, of those tested",
                "hardly any",
                ratio(full.culled - faces.culled, faces.tested),
                Unit::Share,
            ),
        ],
        reason: "Long thin wedges pass tiles at an angle, where planes alone do not \
            separate them."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// Operations of a tile test: four planes, each with the corners of a box that are
/// nearest and farthest, three products and three sums a corner.
const TEST_OPERATIONS: u64 = 4 * 2 * 6;
/// Operations a pixel: four planes and the intensity, with its conversion.
const PIXEL_OPERATIONS: u64 = 4 * 6 + 20;

fn test_share(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let share = |tile: &str| {
        let t = modelled(lab, &["passes=three", tile])?.traffic;
        let tests = t.tested * TEST_OPERATIONS;
        Ok::<_, ReproduceError>(ratio(tests, tests + t.depth_reads * PIXEL_OPERATIONS))
    };
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: format!(
            "operations: {TEST_OPERATIONS} for each (triangle, tile) tested, \
             {PIXEL_OPERATIONS} for each pixel whose depth is read, all wedge draws, three \
             passes"
        ),
        measures: vec![
            Measure::new(
                "share of the test, tiles of 8",
                Theirs::share(0.015, 0.015),
                share("tile=8")?,
                Unit::Share,
            ),
            Measure::new(
                "share of the test, tiles of 32",
                Theirs::share(0.015, 0.015),
                share("tile=32")?,
                Unit::Share,
            ),
        ],
        reason: "The paper's share is of all of a frame's time on its processor, with \
            rasterisation and memory in it; here it is of the wedges' arithmetic alone, and \
            so larger the smaller the tiles are."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn overlaps(_: &mut Lab) -> Result<Finding, ReproduceError> {
    // Volumes take 255 each off a buffer that starts at 255.
    let (start, each) = (255, 255);
    let below = (i32::from(i16::MIN) - start).abs() / each;
    let above = (i32::from(i16::MAX) - start) / each;
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "arithmetic: how many times 255 can be taken off the buffer's first value of \
            255, or added to it, within 16 signed bits; and the counts of an 8-bit stencil"
            .to_owned(),
        measures: vec![
            Measure::new(
                "paper I: wedges in 16 signed bits",
                Theirs::AtLeast(256.0),
                f64::from(below.min(above)),
                Unit::Count,
            ),
            Measure::new(
                "paper II: volumes in 16 signed bits",
                Theirs::Exactly(127.0),
                f64::from(below.min(above)),
                Unit::Count,
            ),
            Measure::beside(
                "umbrae in a stencil of 8 signed bits",
                "usually suffices",
                f64::from(i8::MAX),
                Unit::Count,
            ),
        ],
        reason: "(32767 - 255) / 255 is 127 and a half: paper I counted as if the buffer had no \
            sign and did not start at full light. Paper II's 127 is right, and is of this \
            buffer; of its stencil it says only that 8 bits usually suffice."
            .to_owned(),
        charts: Vec::new(),
    })
}
