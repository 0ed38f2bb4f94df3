//! The thesis's introduction: soft shadow volumes beside point samples of the light.

use super::equal_error::cost_of_error;
use super::lab::Scored;
use super::tally::{counters, pass_time};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::world::scene::Scene;

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "thesis-samples",
        "thesis, §1.3 and §2",
        Verdict::Counters,
        "256 levels of softness need 256 samples of the light or more; artefacts were seen at \
         512, none at 1024.",
        samples,
    )
    .read_from(&[Lines::one(317)]),
    Claim::new(
        "thesis-two-orders",
        "thesis, §1.1 and §1.3",
        Verdict::Counters,
        "Point samples move two orders of magnitude more bytes, and take one to two orders \
         more time, than soft shadow volumes of the same quality.",
        two_orders,
    )
    .read_from(&[Lines::one(234), Lines::one(270)]),
    Claim::quoted(
        "thesis-hardware",
        "thesis, §1, §1.2.1 and §2.2.3",
        "Hardware of 2003 draws about a million triangles at 50 fps; paper I runs at 1-10 fps \
         in software; point samples need some seven more years of hardware that doubles every \
         year to be real-time even for simple scenes.",
    )
    .read_from(&[Lines::one(160), Lines::to(234, 236), Lines::one(333)]),
];

const SAMPLED: &str = "sampled-shadow-volumes";
/// Sample counts; 484 is the square nearest to 512.
const SAMPLES: [u32; 5] = [16, 64, 256, 484, 1024];
/// Shades that a display of 8 bits tells apart.
const LEVELS: f64 = 255.0;

/// Passes of a technique's shadow.
const SHADOW: [PassRole; 3] = [PassRole::Samples, PassRole::HardCount, PassRole::Wedges];

struct Sample {
    count: u32,
    scored: Scored,
    done: Rendered,
}

fn sampled(lab: &mut Lab, scene: &Scene, pattern: &str) -> Result<Vec<Sample>, ReproduceError> {
    let one = |count: u32| {
        let set = [format!("samples={count}"), format!("pattern={pattern}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        // Long frames: two are enough for the least time.
        let done = lab.least(2, || lab.render(scene, SAMPLED, &set))?;
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
    let step: fn(&Sample) -> f64 = |s| s.scored.banding.p99 * LEVELS;
    let at = |all: &[Sample], count: u32, figure: fn(&Sample) -> f64| {
        let found = all.iter().find(|s| s.count == count);
        found.map_or(f64::NAN, figure)
    };
    let whole = |s: &Sample| (s.scored.banding.p99 * LEVELS).round();
    let enough = grid.iter().find(|s| s.scored.banding.levels >= 256);
    let curve = |label: &str, all: &[Sample]| {
        let points = all.iter().map(|s| [f64::from(s.count), step(s)]);
        Series::line(label, points.collect())
    };
    let limit = vec![[16.0, 1.0], [1024.0, 1.0]];
    let measures = vec![
        Measure::new(
            "fewest samples tried that give 256 levels",
            Theirs::AtLeast(256.0),
            enough.map_or(f64::NAN, |s| f64::from(s.count)),
            Unit::Count,
        ),
        Measure::new(
            "steps at 484 samples, whole 255ths",
            Theirs::AtLeast(2.0),
            at(&grid, 484, whole),
            Unit::Count,
        ),
        Measure::new(
            "steps at 1024 samples, whole 255ths",
            Theirs::AtMost(1.0),
            at(&grid, 1024, whole),
            Unit::Count,
        ),
        Measure::beside(
            "484 samples, grid, 255ths",
            "-",
            at(&grid, 484, step),
            Unit::Number,
        ),
        Measure::beside(
            "1024 samples, grid, 255ths",
            "-",
            at(&grid, 1024, step),
            Unit::Number,
        ),
        Measure::beside(
            "1024 samples, rotated grid, 255ths",
            "-",
            at(&rotated, 1024, step),
            Unit::Number,
        ),
    ];
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "distinct visibilities in the exact penumbra; step height: the jump of the \
            error between neighbouring penumbra pixels that 99% of the pairs do not exceed. A \
            picture of 8 bits has steps of 1/255 wherever it is smooth, so 2 is an artefact"
            .to_owned(),
        measures,
        reason: "A grid of 32 x 32 has 32 samples along an edge that is parallel to it, and a \
            step of up to 1/32 there (docs/papers.md, baselines): how many pixels show it depends on \
            the scene."
            .to_owned(),
        charts: vec![Chart {
            name: "thesis-samples".to_owned(),
            title: "Step height in penumbrae against samples, cylinder".to_owned(),
            x: Axis::log2("samples of the light"),
            y: Axis::log10("step height (99%), in 255ths"),
            series: vec![
                curve("grid", &grid),
                curve("rotated grid", &rotated),
                Series::marked("1/255", limit, Mark::Dashed),
            ],
        }],
    })
}

/// Soft shadow volumes beside samples, on one scene.
struct Beside {
    scene: &'static str,
    /// RMSE, megabytes and milliseconds.
    soft: [f64; 3],
    /// The same of all sample counts.
    sampled: Vec<[f64; 3]>,
}

const RMSE: usize = 0;
const MEGABYTES: usize = 1;
const TIME: usize = 2;

impl Beside {
    fn new(lab: &mut Lab, scene: &'static str) -> Result<Self, ReproduceError> {
        let built = lab.scene(scene)?;
        let soft = lab.timed(&built, "soft-shadow-volumes", &[])?;
        let figures = |done: &Rendered, scored: &Scored| {
            let bytes = counters(done, &SHADOW).traffic.total_bytes();
            let time = pass_time(done, &SHADOW);
            [scored.error.rmse, bytes as f64 / 1e6, time]
        };
        let scored = lab.score(&built, &soft)?;
        let soft = figures(&soft, &scored);
        let sampled = sampled(lab, &built, "grid")?;
        Ok(Self {
            scene,
            soft,
            sampled: sampled
                .iter()
                .map(|s| figures(&s.done, &s.scored))
                .collect(),
        })
    }

    /// 1024 samples over soft shadow volumes.
    fn most(&self, figure: usize) -> f64 {
        self.sampled[self.sampled.len() - 1][figure] / self.soft[figure]
    }

    /// Samples of the same error over soft shadow volumes; those of 1024 where even
    /// that is worse.
    fn equal(&self, figure: usize) -> f64 {
        let curve = self.sampled.iter().map(|s| [s[figure], s[RMSE]]);
        let curve: Vec<[f64; 2]> = curve.collect();
        cost_of_error(&curve, self.soft[RMSE]) / self.soft[figure]
    }

    fn chart(&self, figure: usize, suffix: &str, what: &str) -> Chart {
        let points = self.sampled.iter().map(|s| [s[figure], s[RMSE]]);
        let ours = vec![[self.soft[figure], self.soft[RMSE]]];
        Chart {
            name: format!("thesis-error-{}-{suffix}", self.scene),
            title: format!("Error against {what}, {}", self.scene),
            x: Axis::log10(what),
            y: Axis::log10("RMSE of visibility"),
            series: vec![
                Series::line("16 to 1024 samples, grid", points.collect()),
                Series::marked("soft shadow volumes", ours, Mark::Dots),
            ],
        }
    }
}

/// An order of magnitude is a factor of the root of ten either way.
fn orders(low: f64, high: f64) -> Theirs {
    Theirs::Effect {
        low,
        high,
        neutral: 1.0,
        slack: 10f64.sqrt(),
    }
}

fn two_orders(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let (mut measures, mut charts) = (Vec::new(), Vec::new());
    for scene in ["parallel-plates", "cylinder"] {
        let beside = Beside::new(lab, scene)?;
        let ratio = |what: &str, theirs, ours| {
            Measure::new(format!("{scene}: {what}"), theirs, ours, Unit::Ratio)
        };
        measures.extend([
            ratio(
                "bytes of 1024 samples over ours",
                orders(100.0, 100.0),
                beside.most(MEGABYTES),
            ),
            ratio(
                "time of 1024 samples over ours",
                orders(10.0, 100.0),
                beside.most(TIME),
            ),
            ratio(
                "RMSE of 1024 samples over ours",
                Theirs::Beside("-"),
                beside.most(RMSE),
            ),
            ratio(
                "bytes of samples of our RMSE over ours",
                orders(100.0, 100.0),
                beside.equal(MEGABYTES),
            ),
            ratio(
                "time of samples of our RMSE over ours",
                orders(10.0, 100.0),
                beside.equal(TIME),
            ),
        ]);
        charts.push(beside.chart(MEGABYTES, "bytes", "megabytes of shadow passes"));
        charts.push(beside.chart(TIME, "time", "milliseconds of shadow passes"));
    }
    Ok(Finding {
        scene: lab.describe("parallel-plates and cylinder, square lights"),
        counted: "all bytes of the shadow passes: depth 3 B, stencil 1 B, float visibility 4 B, \
            position 16 B, zmin/zmax 8 B an access, and vertices; their time; RMSE of float \
            visibility against the exact oracle, 16 to 1024 samples; where 1024 are still \
            worse they stand for those of our RMSE, where 16 are better, those"
            .to_owned(),
        measures,
        reason: "Beside 1024 samples, which the thesis takes for the same quality, soft shadow \
            volumes are as much cheaper as it says, or more. By error they are so only where \
            the silhouette is the same for all of the light, as on the plates; on the cylinder \
            a single silhouette is wrong by more than 16 samples are."
            .to_owned(),
        charts,
    })
}
