//! The thesis's introduction: soft shadow volumes beside point samples of the light.

use super::lab::{Scored, counters, pass_time};
use super::{Claim, Finding, Lab, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Mark, Series};
use crate::render::Rendered;
use crate::scene::Scene;

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "thesis-samples",
        "thesis, §1.3 and §2",
        Verdict::Counters,
        "256 levels of softness need 256 samples of the light or more; artefacts were seen at \
         512, none at 1024.",
        samples,
    ),
    Claim::new(
        "thesis-two-orders",
        "thesis, §1.1 and §1.3",
        Verdict::Counters,
        "Point samples move two orders of magnitude more bytes, and take one to two orders \
         more time, than soft shadow volumes of the same quality.",
        two_orders,
    ),
];

const SAMPLED: &str = "sampled-shadow-volumes";
/// Sample counts; 484 is the square nearest to 512.
const SAMPLES: [u32; 5] = [16, 64, 256, 484, 1024];
/// Shades that a display of 8 bits tells apart.
const LEVELS: f64 = 255.0;

/// Passes of a technique's shadow.
const SHADOW: [&str; 3] = ["samples", "quads", "wedges"];

struct Sample {
    count: u32,
    scored: Scored,
    done: Rendered,
}

fn sampled(lab: &mut Lab, scene: &Scene, pattern: &str) -> Result<Vec<Sample>, ReproduceError> {
    let one = |count: u32| {
        let set = [format!("samples={count}"), format!("pattern={pattern}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let done = lab.render(scene, SAMPLED, &set)?;
        let scored = lab.score(scene, &done)?;
        Ok(Sample {
            count,
            scored,
            done,
        })
    };
    SAMPLES.into_iter().map(one).collect()
}

fn samples(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let grid = sampled(lab, &scene, "grid")?;
    let rotated = sampled(lab, &scene, "rotated-grid")?;
    let soft = lab.render(&scene, "soft-shadow-volumes", &[])?;
    let soft = lab.score(&scene, &soft)?.banding.p99 * LEVELS;
    let step = |s: &Sample| s.scored.banding.p99 * LEVELS;
    let at = |all: &[Sample], count: u32| {
        let found = all.iter().find(|s| s.count == count);
        found.map_or(f64::NAN, step)
    };
    let enough = grid.iter().find(|s| s.scored.banding.levels >= 256);
    let curve = |label: &str, all: &[Sample]| {
        let points = all.iter().map(|s| [f64::from(s.count), step(s)]);
        Series::line(label, points.collect())
    };
    let flat =
        |label: &str, y: f64| Series::marked(label, vec![[16.0, y], [1024.0, y]], Mark::Dashed);
    let measures = vec![
        Measure::new(
            "fewest samples tried that give 256 levels",
            Theirs::AtLeast(256.0),
            enough.map_or(f64::NAN, |s| f64::from(s.count)),
            Unit::Count,
        ),
        Measure::new(
            "steps at 484 samples, grid, in 255ths",
            Theirs::AtLeast(1.0),
            at(&grid, 484),
            Unit::Number,
        ),
        Measure::new(
            "steps at 1024 samples, grid, in 255ths",
            Theirs::AtMost(1.0),
            at(&grid, 1024),
            Unit::Number,
        ),
        Measure::beside(
            "steps at 1024 samples, rotated grid, in 255ths",
            "-",
            at(&rotated, 1024),
            Unit::Number,
        ),
        Measure::beside(
            "steps of soft shadow volumes, in 255ths",
            "none",
            soft,
            Unit::Number,
        ),
    ];
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "distinct visibilities in the exact penumbra; step height: the jump of the \
            error between neighbouring penumbra pixels that 99% of the pairs do not exceed. A \
            step of 1/255 is taken for what can be seen"
            .to_owned(),
        measures,
        reason: "A grid of 32 x 32 has 32 samples along an edge that is parallel to it, and a \
            step of up to 1/32 there (IMPLEMENTING §0.6): 1024 samples are no ground truth \
            where shadows are wide enough on the screen."
            .to_owned(),
        charts: vec![Chart {
            name: "thesis-samples".to_owned(),
            title: "Step height in penumbrae against samples, cylinder".to_owned(),
            x: Axis::log2("samples of the light"),
            y: Axis::log10("step height (99%), in 255ths"),
            series: vec![
                curve("grid", &grid),
                curve("rotated grid", &rotated),
                flat("soft shadow volumes", soft),
                flat("1/255", 1.0),
            ],
        }],
    })
}

fn two_orders(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let soft = lab.timed(&scene, "soft-shadow-volumes", &[])?;
    let error = lab.score(&scene, &soft)?.error.rmse;
    let many = sampled(lab, &scene, "grid")?;
    let last = &many[many.len() - 1];
    let bytes = |done: &Rendered| counters(done, &SHADOW).traffic.total_bytes() as f64;
    let time = |done: &Rendered| pass_time(done, &SHADOW);
    let point = |scored: &Scored, cost: f64| [cost, scored.error.rmse];
    let curve = |cost: &dyn Fn(&Rendered) -> f64| {
        let points = many.iter().map(|s| point(&s.scored, cost(&s.done)));
        Series::line("N samples, grid", points.collect())
    };
    let ours = |cost: f64| Series::marked("soft shadow volumes", vec![[cost, error]], Mark::Dots);
    let chart = |name: &str, what: &str, curve: Series, cost: f64| Chart {
        name: name.to_owned(),
        title: format!("Error against {what}, cylinder"),
        x: Axis::log10(what),
        y: Axis::log10("RMSE of visibility"),
        series: vec![curve, ours(cost)],
    };
    let megabytes = |done: &Rendered| bytes(done) / 1e6;
    let measures = vec![
        Measure::new(
            "bytes, 1024 samples over ours",
            Theirs::ratio(100.0, 100.0),
            bytes(&last.done) / bytes(&soft),
            Unit::Ratio,
        ),
        Measure::new(
            "time, 1024 samples over ours",
            Theirs::ratio(10.0, 100.0),
            time(&last.done) / time(&soft),
            Unit::Ratio,
        ),
        Measure::new(
            "RMSE of 1024 samples over ours",
            Theirs::AtLeast(1.0),
            last.scored.error.rmse / error,
            Unit::Ratio,
        ),
    ];
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "all bytes of the shadow passes: depth 3 B, stencil 1 B, float visibility 4 B, \
            position 16 B, zmin/zmax 8 B an access, and vertices; their time; RMSE of float \
            visibility against the exact oracle. Samples are compared at 1024, where their \
            error is still the larger one"
            .to_owned(),
        measures,
        reason: "The emulated GPU throws whole blocks of hard volumes away by zmin/zmax and \
            counts stencil at many pixels at once, which makes samples cheaper than on the \
            hardware of the time."
            .to_owned(),
        charts: vec![
            chart(
                "thesis-error-bytes",
                "megabytes of shadow passes",
                curve(&megabytes),
                megabytes(&soft),
            ),
            chart(
                "thesis-error-time",
                "milliseconds of shadow passes",
                curve(&time),
                time(&soft),
            ),
        ],
    })
}
