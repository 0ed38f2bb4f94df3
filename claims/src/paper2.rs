//! Paper II: Assarsson and Akenine-Möller, "Interactive Rendering of Soft Shadows
//! using an Optimized and Generalized Penumbra Wedge Algorithm", 2002; §4, §6, §7.
//!
//! Its scenes are a colonnade and a fractal landscape at 640x427; ours are the
//! built-in `columns` and `fractal`. Its evaluation was a software rasteriser that
//! counted accesses, and so is this.

use super::lab::parsed;
use super::paper2_tiles::{self, TECHNIQUE};
use super::paper2_time;
use super::tally::{counters, pass_time, ratio};
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
        "A signed 16-bit light-intensity buffer holds 256 overlapping penumbrae (paper I), \
         an 8-bit stencil 127 nested umbrae (paper II).",
        overlaps,
    )
    .read_from(&[Lines::to(643, 647), Lines::one(952), Lines::to(1063, 1065)]),
    Claim::quoted(
        "paper2-frame-rates",
        "paper II, §7",
        "Pentium 4 at 1.7 GHz and GeForce3: columns 7, fractal 2.3 (single pass 1.75), 2002 \
         3.6, Venus 1 fps; the umbra in hardware gains 60-80%.",
    )
    .read_from(&[
        Lines::one(915),
        Lines::one(1085),
        Lines::one(1103),
        Lines::to(1177, 1183),
    ]),
];

/// Reads of depth by penumbrae, which the three-pass algorithm has apart.
fn penumbra_reads(done: &Rendered) -> u64 {
    counters(done, &[PassRole::Wedges]).traffic.tex[0].read_accesses
}

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
        let time = |done| pass_time(done, &[PassRole::Wedges]);
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
             of an emulator that runs the tile test once a pixel, not once a tile, and shades \
             16 pixels at a time: culling saves it reads, hardly instructions"
        ),
        measures,
        reason: "Reads are not all of the time that the paper measured. And our wedges go on to \
            infinity, below the floor, where zmax alone culls most of their pixels (see \
            paper2-zmax-only); of what zmax leaves, zmin culls about as much as published."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn zmax_only(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let [none, zmax, both] = lab.race(
        &scene,
        [
            (TECHNIQUE, &["passes=three", "culling=none"]),
            (TECHNIQUE, &["passes=three", "culling=zmax"]),
            (TECHNIQUE, &["passes=three", "culling=zminmax"]),
        ],
    )?;
    let traffic =
        |culling: &str| Ok::<_, ReproduceError>(modelled(lab, &["passes=three", culling])?.traffic);
    let (with_zmax, with_both) = (traffic("culling=zmax")?, traffic("culling=zminmax")?);
    let writes = |t: &tile_traffic::TileTraffic| t.stencil_writes + t.intensity_writes;
    let saved = 1.0 - ratio(penumbra_reads(&zmax), penumbra_reads(&none));
    let measures = vec![
        Measure::new(
            "penumbra depth reads that zmax saves",
            Theirs::None {
                neutral: 0.0,
                within: 0.1,
            },
            saved,
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
        Measure::new(
            "penumbra depth reads, zmax over both",
            Theirs::ratio(7.0 / 2.6, 7.0 / 2.6),
            ratio(penumbra_reads(&zmax), penumbra_reads(&both)),
            Unit::Ratio,
        ),
        Measure::beside(
            "penumbra time, zmax over both",
            "2.7x frame",
            pass_time(&zmax, &[PassRole::Wedges]) / pass_time(&both, &[PassRole::Wedges]),
            Unit::Ratio,
        ),
    ];
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: format!(
            "depth reads, and writes of stencil and light-intensity buffer, of all wedge draws, \
             three passes, tiles of 8: {BYTES}"
        ),
        measures,
        reason: "zmax culls what is wholly behind a tile's surfaces. Our wedges go on to infinity \
            and are mostly there, below the floor; the paper says that almost nothing in its \
            scenes hides the shadows, which suggests that its wedges end near the receivers. \
            Against zmin and zmax together, zmax alone reads about as much more as published."
            .to_owned(),
        charts: Vec::new(),
    })
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
             passes. The emulated GPU tests a tile at each of its pixels, so its times say \
             nothing of this"
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
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "arithmetic: the largest signed value over what one overlap adds (255 in the \
            light-intensity buffer, 1 in the stencil)"
            .to_owned(),
        measures: vec![
            Measure::new(
                "penumbrae in 16 signed bits",
                Theirs::AtLeast(256.0),
                f64::from(i16::MAX / 255),
                Unit::Count,
            ),
            Measure::new(
                "umbrae in 8 signed bits",
                Theirs::Exactly(127.0),
                f64::from(i8::MAX),
                Unit::Count,
            ),
        ],
        reason: "32767 / 255 is 128: paper I counted as if the buffer had no sign. Paper II's \
            127 is right."
            .to_owned(),
        charts: Vec::new(),
    })
}
