//! Paper IV: Assarsson, Dougherty, Mounier and Akenine-Möller, "An Optimized Soft
//! Shadow Volume Algorithm with Real-Time Performance", 2003: cost and memory.

use super::paper3_scaling as scaling;
use super::paper4_quality as quality;
use super::shader_work::{
    paper3_exact, paper3_table, paper4_arithmetic, paper4_sphere, paper4_tables, paper4_textured,
    published,
};
use super::tally::{bytes_of, counters, invocations, pass_time, ratio};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict, paper3};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, PassRole};
use gnomon_pipeline::world::scene::Scene;
use gnomon_raster::shader::Operations;
use gnomon_shaders::split_volumes::{CAPACITY, FULL, SPLIT_ENTRIES};

pub(super) const TECHNIQUE: &str = "soft-shadow-volumes-optimised";

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "paper4-instructions",
        "paper IV, §6",
        Verdict::Counters,
        "The shaders have 59+4, 61+2 and 60+5 instructions and texture loads instead of 250: \
         3.8-4.0 times fewer.",
        instructions,
    )
    .read_from(&[Lines::one(1724), Lines::one(1730)]),
    Claim::new(
        "paper4-speed-up",
        "thesis, §2.5.3; paper IV, §6",
        Verdict::Counters,
        "All optimisations together are worth 15-20 times: counted shader work.",
        speed_up,
    )
    .read_from(&[Lines::one(442), Lines::one(1730)]),
    Claim::new(
        "paper4-speed-up-time",
        "thesis, §2.5.3; paper IV, §6",
        Verdict::Times,
        "All optimisations together are worth 15-20 times: time.",
        speed_up_time,
    )
    .read_from(&[Lines::one(442), Lines::one(1730)]),
    Claim::new(
        "paper4-tight-wedges",
        "paper IV, §4.1 and §6",
        Verdict::Counters,
        "Tight wedges for rectangles gain 1.2-2 times.",
        tight_wedges,
    )
    .read_from(&[Lines::one(1732)]),
    Claim::new(
        "paper4-culling",
        "paper IV, §4.4 and §6",
        Verdict::Times,
        "Culling pixels outside the wedges by depth and stencil gains about 5%.",
        culling,
    )
    .read_from(&[Lines::one(1732)]),
    Claim::new(
        "paper4-table-memory",
        "paper IV, §6",
        Verdict::Arithmetic,
        "Look-up textures take about 324 KB for spheres and about 270 KB for rectangles.",
        table_memory,
    )
    .read_from(&[Lines::one(1734), Lines::one(1736)]),
    Claim::new(
        "paper4-overlap",
        "paper IV, §4.3",
        Verdict::Counters,
        "On complex models more than 16 wedges overlap at a pixel, so that 5 bits are kept \
         for carries, which hold them.",
        quality::overlap,
    )
    .read_from(&[Lines::one(1664)]),
    Claim::new(
        "paper4-figure-9",
        "paper IV, §6",
        Verdict::Times,
        "On the complex scene of figure 9a tight wedges make frames 1.5 times as fast.",
        quality::tight_frames,
    )
    .read_from(&[Lines::one(1732)]),
    Claim::new(
        "paper4-precision",
        "paper IV, §4.3 and §6",
        Verdict::Arithmetic,
        "12 bits of coverage over four channels of 8 leave 5 for carries, room for 32 overlaps; \
         a map of 1024 entries splits them.",
        precision,
    )
    .read_from(&[Lines::one(1659), Lines::one(1664), Lines::one(1734)]),
    Claim::new(
        "paper4-sub-lights",
        "paper IV, §5.2",
        Verdict::Counters,
        "n small lights for one are less than n times as expensive, since wedges are thinner.",
        quality::sub_lights,
    )
    .read_from(&[Lines::one(1718)]),
    Claim::new(
        "paper4-splits",
        "paper IV, §5.2",
        Verdict::Counters,
        "Splitting a light into 2x2 or 3x3 comes near to the reference, with two orders of \
         magnitude fewer samples than point samples need.",
        quality::splits,
    )
    .read_from(&[Lines::one(1716)]),
    Claim::quoted(
        "paper4-frame-rates",
        "paper IV, §6 and §7",
        "ATI 9700: cylinder above 150 fps, alien about 50 fps; paper III's code 8-10 and 3-4 \
         fps.",
    )
    .read_from(&[Lines::one(1563), Lines::one(1730), Lines::one(1740)]),
];

/// Paper III as published: wedges round spheres, copied back.
const PAPER3: [&str; 2] = ["wedge=paper3", "copy-back=on"];
/// Paper IV as published: tight wedges, tables.
const PAPER4: [&str; 3] = ["wedge=paper4", "coverage=lut", "split-bits=lut"];

fn instructions(_: &mut Lab) -> Result<Finding, ReproduceError> {
    let fewer = |before: Operations, after: Operations| ratio(before.operations, after.operations);
    let [exact, table] = [paper3_exact(), paper3_table()];
    let [computed, tables, sphere] = [paper4_arithmetic(), paper4_tables(), paper4_sphere()];
    let textured = paper4_textured();
    let count = |what: &str, theirs: &'static str, ours: u64| {
        Measure::beside(format!("our {what}"), theirs, ours as f64, Unit::Count)
    };
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "operations on single floats and look-ups of one fragment, counted by running \
            the shaders on lanes that count. The papers count instructions on up to four floats"
            .to_owned(),
        measures: vec![
            Measure::new(
                "our operations, paper III exact over IV tables",
                Theirs::ratio(3.8, 4.0),
                fewer(exact, tables),
                Unit::Ratio,
            ),
            Measure::beside(
                "our operations, III table over IV computed",
                "-",
                fewer(table, computed),
                Unit::Ratio,
            ),
            count("operations, III exact", "250", exact.operations),
            count("operations, III table", "-", table.operations),
            count("operations, IV computed", "-", computed.operations),
            count("operations, IV tables, rectangle", "60", tables.operations),
            count("operations, IV tables, sphere", "59", sphere.operations),
            count("operations, IV textured", "61", textured.operations),
            count("look-ups, textured", "2", textured.look_ups),
            count("look-ups, rectangle", "5", tables.look_ups),
            count("look-ups, sphere", "4", sphere.look_ups),
            Measure::beside(
                "their instructions, rectangle",
                "250 to 60+5",
                ratio(published::PAPER3, published::PAPER4),
                Unit::Ratio,
            ),
        ],
        reason: "Both of our shaders clip and integrate in the short way: paper III's is no \
            longer than paper IV's. The paper went from code compiled from Cg to assembler \
            written by hand, with the transformations lifted out to the vertices; none of \
            that is in the algorithm. A closed form costs us no more than the tables that replace \
            it. For spheres we look the split up too."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn speed_up(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let [long, short] = [paper3_exact().operations, paper4_tables().operations];
    let mut measures = Vec::new();
    for name in ["cylinder", "creature"] {
        let scene = lab.scene(name)?;
        let three = lab.render(&scene, paper3::TECHNIQUE, &PAPER3)?;
        let all = lab.render(&scene, paper3::TECHNIQUE, &["wedge=paper3", "skip=off"])?;
        let four = lab.render(&scene, TECHNIQUE, &PAPER4)?;
        let before = scaling::behind_front(&three);
        let after = invocations(&four, DrawRole::Coverage);
        let beside = |what: &str, theirs, ours| {
            Measure::beside(format!("{name}: {what}"), theirs, ours, Unit::Ratio)
        };
        measures.extend([
            Measure::new(
                format!("{name}: shader work"),
                Theirs::ratio(15.0, 20.0),
                ratio(before * long, after * short),
                Unit::Ratio,
            ),
            beside("invocations alone", "-", ratio(before, after)),
            beside(
                "invocations, if nothing were skipped before",
                "-",
                ratio(invocations(&all, DrawRole::Coverage), after),
            ),
            beside(
                "bytes of shadow passes, III with copies over IV",
                "-",
                ratio(shadow_bytes(&three), shadow_bytes(&four)),
            ),
        ]);
    }
    Ok(Finding {
        scene: lab.describe("cylinder and creature (for the alien)"),
        counted: format!(
            "invocations of the wedge shader times the operations of one, {long} for paper III, \
             at pixels whose surface is behind a front face of its wedges, and {short} for paper \
             IV, at those in front of back faces too. Copies and quads are left out, but for \
             bytes"
        ),
        measures,
        reason: "Invocations fall by as much as wedges and skipping promise. The paper's shader \
            became four times as short besides; our own for paper III is as short as that for \
            paper IV (paper4-instructions), so that part of the factor is missing."
            .to_owned(),
        charts: Vec::new(),
    })
}

const SHADOW: [PassRole; 4] = [
    PassRole::HardCount,
    PassRole::Wedges,
    PassRole::Combine,
    PassRole::Resolve,
];

fn shadow_bytes(done: &Rendered) -> u64 {
    counters(done, &SHADOW).traffic.total_bytes()
}

fn speed_up_time(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["cylinder", "creature"] {
        let scene = lab.scene(name)?;
        let runs: [(&str, &[&str]); 3] = [
            (paper3::TECHNIQUE, &PAPER3),
            (TECHNIQUE, &PAPER4),
            (TECHNIQUE, &["wedge=paper4"]),
        ];
        let done = lab.race(&scene, runs)?;
        let [three, tables, computed] = done.each_ref().map(|d| pass_time(d, &SHADOW));
        measures.push(Measure::new(
            format!("{name}: shadow passes, III with copies over IV with tables"),
            Theirs::ratio(15.0, 20.0),
            three / tables,
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: shadow passes, III with copies over IV computed"),
            "-",
            three / computed,
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("cylinder and creature (for the alien)"),
        counted: "time of the shadow passes on the emulated GPU".to_owned(),
        measures,
        reason: "The causes are not there: a long shader, wedges that wait for one another's \
            copies, float formats that cannot blend. What is there costs: paper IV writes two \
            buffers instead of one, looks up five texels, and reads both buffers over the whole \
            screen at the end."
            .to_owned(),
        charts: Vec::new(),
    })
}

const TIGHT: [&str; 4] = ["cylinder", "creature", "columns", "spheres"];

fn tight_wedges(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in TIGHT {
        let scene = lab.scene(name)?;
        let pixels = |wedge: &str, skip: &str| {
            let done = lab.render(&scene, TECHNIQUE, &[wedge, skip])?;
            Ok::<_, ReproduceError>(invocations(&done, DrawRole::Coverage))
        };
        let shaded = |skip: &str| {
            Ok::<_, ReproduceError>(ratio(
                pixels("wedge=paper3", skip)?,
                pixels("wedge=paper4", skip)?,
            ))
        };
        measures.push(Measure::new(
            format!("{name}: shaded pixels, paper III's over IV's"),
            Theirs::ratio(1.2, 2.0),
            shaded("skip=on")?,
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: the same without skipping"),
            "-",
            shaded("skip=off")?,
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("cylinder, creature, columns and spheres, square lights"),
        counted: "invocations of the wedge shader".to_owned(),
        measures,
        reason: "Wedges that reach to the picture's edge are cut there, whatever their width."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn culling(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["cylinder", "creature"] {
        let scene = lab.scene(name)?;
        let [on, off] = lab.race(
            &scene,
            [
                (TECHNIQUE, &["wedge=paper4", "skip=on"]),
                (TECHNIQUE, &["wedge=paper4", "skip=off"]),
            ],
        )?;
        measures.push(Measure::new(
            format!("{name}: frame rate gained"),
            Theirs::share(0.05, 0.05),
            off.frame_ms / on.frame_ms - 1.0,
            Unit::Share,
        ));
        measures.push(Measure::beside(
            format!("{name}: invocations, without over with"),
            "-",
            ratio(
                invocations(&off, DrawRole::Coverage),
                invocations(&on, DrawRole::Coverage),
            ),
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: pixels behind front faces, over those shaded"),
            "-",
            ratio(
                scaling::behind_front(&on),
                invocations(&on, DrawRole::Coverage),
            ),
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("cylinder and creature"),
        counted: "frame time, and invocations of the wedge shader".to_owned(),
        measures,
        reason: "What an invocation costs beside the tests decides. The emulated GPU rejects \
            whole 8x8 blocks before it shades, and so gains more than the Radeon where wedges \
            are mostly elsewhere; where frames are short the second draw for each wedge may \
            cost as much as it saves."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn table_memory(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let set = ["coverage=lut", "split-bits=lut"];
    let tables = |scene: &Scene| {
        let made = lab.textures(scene, TECHNIQUE, &set)?;
        let tables = made
            .iter()
            .filter(|t| ["angles", "areas", "split"].contains(&&*t.label));
        Ok::<_, ReproduceError>(tables.map(bytes_of).sum::<u64>() as f64)
    };
    let square = lab.scene("cylinder")?;
    let mut round = square.clone();
    round.lights[0].shape = gnomon_pipeline::world::light::LightShape::Sphere {
        centre: glam::DVec3::new(1.6, 4.0, 1.0),
        radius: 0.5,
    };
    let kib = 1024.0;
    Ok(Finding {
        scene: "cylinder under a sphere and under a square; textures that the technique creates"
            .to_owned(),
        counted: "bytes of `angles` (6 x 128 x 128 x 2), `areas` (256 x 256 x 2 for spheres, x 1 \
            for rectangles) and `split` (1024 x 4)"
            .to_owned(),
        measures: vec![
            Measure::new(
                "sphere",
                Theirs::Exactly(324.0 * kib),
                tables(&round)?,
                Unit::Bytes,
            ),
            Measure::new(
                "rectangle",
                Theirs::Exactly(260.0 * kib),
                tables(&square)?,
                Unit::Bytes,
            ),
            Measure::beside(
                "rectangle, as printed",
                "about 270 KB",
                tables(&square)?,
                Unit::Bytes,
            ),
        ],
        reason: "The paper's own formats make 260 KiB, which is 266 thousand bytes.".to_owned(),
        charts: Vec::new(),
    })
}

fn precision(_: &mut Lab) -> Result<Finding, ReproduceError> {
    let bits = |levels: u32| f64::from(levels.ilog2());
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "what channels of the buffers hold, and entries of the map that splits".to_owned(),
        measures: vec![
            Measure::new(
                "bits stored",
                Theirs::Exactly(12.0),
                bits(FULL as u32 + 1),
                Unit::Number,
            ),
            Measure::new(
                "full contributions that fit for certain",
                Theirs::AtLeast(32.0),
                f64::from(CAPACITY),
                Unit::Count,
            ),
            Measure::beside(
                "bits that the map of 1024 entries leaves",
                "12 implied",
                bits(SPLIT_ENTRIES),
                Unit::Number,
            ),
        ],
        reason: "36 of 7 are 252 of 255. The paper counts 2^5.".to_owned(),
        charts: Vec::new(),
    })
}
