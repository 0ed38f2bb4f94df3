//! Paper III: Assarsson and Akenine-Möller, "A Geometry-based Soft Shadow Volume
//! Algorithm using Graphics Hardware", 2003: traffic, textures, passes.

use std::time::Instant;

use super::paper3_images as images;
use super::paper3_scaling as scaling;
use super::tally::{bytes_of, counters, draws, ratio};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, PassRole};
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::world::scene::Scene;

pub(super) const TECHNIQUE: &str = "soft-shadow-volumes";

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "paper3-bandwidth",
        "paper III, §5",
        Verdict::Counters,
        "1024 samples move 585 MB of depth, stencil and visibility a frame, 256 samples \
         146 MB, soft shadow volumes 6.0 MB.",
        bandwidth,
    )
    .read_from(&[Lines::one(1463)]),
    Claim::new(
        "paper3-texture-size",
        "paper III, §3.2.3 and §3.3",
        Verdict::Arithmetic,
        "With n = 32 the coverage texture is 1024x1024: 1 MB, and 3 MB in colours.",
        texture_size,
    )
    .read_from(&[Lines::one(1383), Lines::one(1387), Lines::one(1397)]),
    Claim::new(
        "paper3-passes",
        "paper III, §4",
        Verdict::Arithmetic,
        "Without blending of floats each wedge takes four passes: umbra, penumbra, and a copy \
         back after each.",
        passes,
    )
    .read_from(&[Lines::to(1403, 1405)]),
    Claim::new(
        "paper3-filtering",
        "paper III, §3.2.3",
        Verdict::Counters,
        "Filtering the coverage texture is not needed in normal scenes.",
        filtering,
    )
    .read_from(&[Lines::to(1379, 1383)]),
    Claim::new(
        "paper3-table-build",
        "paper III, §3.2.3",
        Verdict::Times,
        "Building a coverage texture takes less than three minutes (Pentium 4 at 1.7 GHz).",
        table_build,
    )
    .read_from(&[Lines::one(1383)]),
    Claim::new(
        "paper3-resolution",
        "paper III, §5",
        Verdict::Times,
        "Fairy: 3, 0.51 and 0.14 fps at 100x100, 256x256 and 512x512: time grows slower than \
         pixels.",
        scaling::resolution,
    )
    .read_from(&[Lines::one(1451)]),
    Claim::new(
        "paper3-light-side",
        "paper III, §5",
        Verdict::Counters,
        "Halving the side of a square light more than doubles the frame rate.",
        scaling::light_side,
    )
    .read_from(&[Lines::one(1461)]),
    Claim::new(
        "paper3-linear",
        "paper III, §5 and §6",
        Verdict::Counters,
        "The cost is linear in silhouette edges, pixels inside wedges, lights and objects.",
        scaling::linear,
    )
    .read_from(&[Lines::one(1465)]),
    Claim::quoted(
        "paper3-frame-rates",
        "paper III, §5",
        "Software on a Pentium 4: fairy 3, 0.51, 0.14 fps; sixteen lights in one texture 0.8 \
         and 0.4 fps at 256x256 and 512x512.",
    )
    .read_from(&[Lines::one(1451), Lines::one(1461)]),
    Claim::new(
        "paper3-inside-penumbrae",
        "paper III, §3.1",
        Verdict::Times,
        "Most of the time is spent on points inside the penumbra volumes themselves, however \
         large wedges are.",
        images::inside_penumbrae,
    )
    .read_from(&[Lines::one(1300)]),
    Claim::new(
        "paper3-sixteen-lights",
        "paper III, §5",
        Verdict::Counters,
        "Sixteen lights in one texture show sampling artefacts; a coverage texture of higher \
         resolution solves it.",
        images::sixteen_lights,
    )
    .read_from(&[Lines::one(1424), Lines::one(1432)]),
];

/// Depth, stencil and colour of the shadow passes, in bytes: what the paper counted.
fn buffer_bytes(done: &Rendered) -> u64 {
    let t = counters(
        done,
        &[PassRole::Samples, PassRole::HardCount, PassRole::Wedges],
    )
    .traffic;
    t.z.bytes() + t.stencil.bytes() + t.color.iter().map(|c| c.bytes()).sum::<u64>()
}

fn sampled(lab: &Lab, scene: &Scene, count: u32) -> Result<u64, ReproduceError> {
    let set = format!("samples={count}");
    let done = lab.render(scene, "sampled-shadow-volumes", &[&set])?;
    Ok(buffer_bytes(&done))
}

fn bandwidth(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("fairy")?;
    let counts = [16, 64, 256, 1024];
    let bytes: Vec<u64> = counts
        .iter()
        .map(|n| sampled(lab, &scene, *n))
        .collect::<Result<_, _>>()?;
    let soft = lab.render(&scene, TECHNIQUE, &["wedge=paper3"])?;
    let positions = counters(&soft, &[PassRole::HardCount, PassRole::Wedges])
        .traffic
        .tex[0]
        .read_bytes;
    let soft = buffer_bytes(&soft);
    let points = counts.iter().zip(&bytes);
    let points = points.map(|(n, b)| [f64::from(*n), *b as f64 / 1e6]);
    let measures = vec![
        Measure::new(
            "1024 samples over soft shadow volumes",
            // docs/papers.md, claims: scene and bytes an access are not stated.
            Theirs::Effect {
                low: 50.0,
                high: 200.0,
                neutral: 1.0,
                slack: 1.0,
            },
            ratio(bytes[3], soft),
            Unit::Ratio,
        ),
        Measure::new(
            "1024 samples over 256",
            Theirs::None {
                neutral: 4.0,
                within: 0.04,
            },
            ratio(bytes[3], bytes[2]),
            Unit::Ratio,
        ),
        Measure::new(
            "bytes a sample, 1024 against 16: off by",
            Theirs::None {
                neutral: 0.0,
                within: 0.01,
            },
            ratio(bytes[3], bytes[0]) / 64.0 - 1.0,
            Unit::Share,
        ),
        Measure::beside("1024 samples", "585 MB", bytes[3] as f64, Unit::Bytes),
        Measure::beside("256 samples", "146 MB", bytes[2] as f64, Unit::Bytes),
        Measure::beside("soft shadow volumes", "6.0 MB", soft as f64, Unit::Bytes),
        Measure::beside(
            "positions read besides, as a texture",
            "depth",
            positions as f64,
            Unit::Bytes,
        ),
    ];
    Ok(Finding {
        scene: lab.describe("fairy, of our own making"),
        counted: "depth (3 B), stencil (1 B) and float visibility (4 B) accesses of the shadow \
            passes, clears left out, with blocks of pixels decided by zmin/zmax not counted \
            as depth reads; wedges as in paper III"
            .to_owned(),
        measures,
        reason: "A sample here is a whole hard shadow image and its addition to a float \
            buffer; of the paper's scene, format and bytes nothing is stated."
            .to_owned(),
        charts: vec![Chart {
            name: "paper3-bandwidth".to_owned(),
            title: "Buffer traffic of shadow passes against samples, fairy".to_owned(),
            x: Axis::log2("samples of the light"),
            y: Axis::log10("megabytes a frame"),
            series: vec![
                Series::line("N samples", points.collect()),
                Series::marked(
                    "soft shadow volumes",
                    vec![[16.0, soft as f64 / 1e6], [1024.0, soft as f64 / 1e6]],
                    Mark::Dashed,
                ),
            ],
        }],
    })
}

fn table_bytes(lab: &Lab, set: &[&str]) -> Result<u64, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let made = lab.textures(&scene, TECHNIQUE, set)?;
    let tables = made.iter().filter(|t| t.label == "coverage");
    Ok(tables.map(bytes_of).sum())
}

fn texture_size(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let white = table_bytes(lab, &["backend=texture4d"])?;
    let bytes = table_bytes(lab, &["light-image=halves", "texture-bits=8"])?;
    let halves = table_bytes(lab, &["light-image=halves"])?;
    let mib = f64::from(1 << 20);
    Ok(Finding {
        scene: "cylinder; textures that the technique creates".to_owned(),
        counted: "bytes of the texture `coverage`: 1 B a texel; 4 B in colours of 8 bits, of \
            which one is not used, and 8 B in half floats"
            .to_owned(),
        measures: vec![
            Measure::new(
                "one colour",
                Theirs::Exactly(mib),
                white as f64,
                Unit::Bytes,
            ),
            Measure::new(
                "three colours of 8 bits, where 24 bits are stored in 32 (its footnote 1)",
                Theirs::Exactly(4.0 * mib),
                bytes as f64,
                Unit::Bytes,
            ),
            Measure::beside(
                "three colours, by default",
                "3 MB",
                halves as f64,
                Unit::Bytes,
            ),
        ],
        reason: "The texture has another number of texels.".to_owned(),
        charts: Vec::new(),
    })
}

fn passes(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let done = lab.render(&scene, TECHNIQUE, &["copy-back=on", "wedge=paper3"])?;
    let of = |role: PassRole| {
        let all = done.report.passes.iter().zip(done.roles.passes());
        // Clearing visibility is a pass of its own, without draws.
        all.filter(|(pass, r)| **r == role && !pass.draws.is_empty())
            .count() as f64
    };
    let wedges = draws(&done, DrawRole::CoverageAside) as f64;
    let [umbra, penumbra] = [PassRole::HardCount, PassRole::Wedges].map(of);
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "render passes that draw, into floats without blending (copy-back=on)".to_owned(),
        measures: vec![
            Measure::new(
                "passes per wedge",
                Theirs::Exactly(4.0),
                (umbra + penumbra) / wedges,
                Unit::Count,
            ),
            Measure::beside(
                "of these, umbra and its copy",
                "2",
                umbra / wedges,
                Unit::Count,
            ),
            Measure::beside("penumbra and its copy", "2", penumbra / wedges, Unit::Count),
        ],
        reason: "Another number of wedges than of hard shadow quads, where edges touch a light \
            or its plane."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn filtering(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["cylinder", "creature", "parallel-plates"] {
        let scene = lab.scene(name)?;
        let mut figures = |set: &[&str]| {
            let done = lab.render(&scene, TECHNIQUE, set)?;
            let scored = lab.score(&scene, &done)?;
            Ok::<_, ReproduceError>((scored.error.rmse, done))
        };
        let nearest = figures(&["backend=texture4d"])?;
        let linear = figures(&["backend=texture4d", "texture-filter=quadlinear"])?;
        let exact = figures(&[])?;
        let growth = nearest.0 / linear.0;
        let none = Theirs::None {
            neutral: 1.0,
            within: 0.1,
        };
        // The plates' penumbra has no other error, and is as wide as the picture.
        let theirs = match name {
            "parallel-plates" => Theirs::Beside("-"),
            _ => none,
        };
        let what = format!("{name}: RMSE without filter over with");
        measures.push(Measure::new(what, theirs, growth, Unit::Ratio));
        measures.push(Measure::beside(
            format!("{name}: 99% of pixels within, of the closed form, 255ths"),
            "-",
            255.0 * difference(&nearest.1, &exact.1),
            Unit::Number,
        ));
    }
    Ok(Finding {
        scene: lab.describe("cylinder and creature; parallel-plates for the worst case"),
        counted: "RMSE of float visibility against the exact oracle, 4D texture of 32 entries an \
            axis, nearest and quadlinear; and how far nearest is from the closed form, over \
            pixels that differ at all"
            .to_owned(),
        measures,
        reason: "The nearest of 32 entries along each axis moves a clipped end by up to 1/64 of \
            the light, and the coverage by up to 0.065 (docs/papers.md, paper III)."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// What 99% of the differences of two visibilities do not exceed, equal pixels left
/// out.
fn difference(a: &Rendered, b: &Rendered) -> f64 {
    let pairs = a.visibility.iter().zip(&b.visibility);
    let differences = pairs
        .map(|(a, b)| f64::from(a - b))
        .filter(|d| d.abs() > 0.0);
    let differences: Vec<f64> = differences.collect();
    ErrorSummary::of(&differences).map_or(0.0, |e| e.p99)
}

fn table_build(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let build = |set: &[&str]| {
        let start = Instant::now();
        lab.textures(&scene, TECHNIQUE, set)?;
        Ok::<_, ReproduceError>(start.elapsed().as_secs_f64() * 1e3)
    };
    let without = build(&[])?;
    let with = build(&["backend=texture4d"])?;
    Ok(Finding {
        scene: "cylinder".to_owned(),
        counted: "time to build a frame with the texture, less that without; one thread, in \
            f64 by polygon clipping"
            .to_owned(),
        measures: vec![Measure::new(
            "one coverage texture, n = 32",
            Theirs::AtMost(180_000.0),
            with - without,
            Unit::Milliseconds,
        )],
        reason: "A million entries took longer than that.".to_owned(),
        charts: Vec::new(),
    })
}
