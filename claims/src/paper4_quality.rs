//! Paper IV: overlaps at a pixel, and lights split into smaller ones.

use super::equal_error::cost_of_error;
use super::overlaps::Overlaps;
use super::paper4::TECHNIQUE;
use super::tally::{counters, invocations, pass_time};
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, PassRole};

/// Scenes, and whether they have a complex model, as the claim asks for.
const SCENES: [(&str, bool); 4] = [
    ("cylinder", false),
    ("columns", false),
    ("creature", true),
    ("peer-c", true),
];

pub(super) fn overlap(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    let mut series = Vec::new();
    for (name, is_complex) in SCENES {
        let scene = lab.scene(name)?;
        let found = Overlaps::measure(lab, &scene, &["wedge=paper4"])?;
        let histogram = found.histogram();
        let covered: u64 = histogram.iter().skip(1).sum();
        let beyond: u64 = histogram.iter().skip(17).sum();
        let most = f64::from(found.most());
        let theirs = match is_complex {
            true => Theirs::AtLeast(17.0),
            false => Theirs::Beside("-"),
        };
        let what = format!("{name}: most wedges at a pixel");
        measures.push(Measure::new(what, theirs, most, Unit::Count));
        let done = lab.render(&scene, TECHNIQUE, &["wedge=paper4"])?;
        let lost = counters(&done, &[PassRole::Wedges]).events.blend_saturated;
        let lost = lost.iter().sum::<u64>() as f64;
        // The paper's five bits hold what its models need.
        let what = format!("{name}: channels that saturated");
        measures.push(Measure::new(what, Theirs::AtMost(0.0), lost, Unit::Count));
        measures.push(Measure::beside(
            format!("{name}: pixels beyond 16, of those covered"),
            "some",
            beyond as f64 / covered as f64,
            Unit::Share,
        ));
        series.push(Series::line(name, by_doublings(&histogram)));
    }
    let most = 1.0f64.max(
        series
            .iter()
            .flat_map(|s| &s.points)
            .map(|p| p[1])
            .fold(0.0, f64::max),
    );
    let limit = vec![[16.0, 1.0], [16.0, most]];
    series.push(Series::marked("16 wedges", limit, Mark::Dashed));
    Ok(Finding {
        scene: lab.describe("cylinder and columns, which are simple, creature and peer-c"),
        counted: "wedges that wrote to a pixel, tight wedges, pixels outside skipped; additive \
            and subtractive ones together, as each writes 4 B to both RGBA8 buffers. Either \
            buffer has at least half of them where they are most"
            .to_owned(),
        measures,
        reason:
            "peer-c has so many edges behind one another that channels saturate: five bits are \
            not enough there, and the technique warns of it (coverage-saturated)."
                .to_owned(),
        charts: vec![Chart {
            name: "paper4-overlap".to_owned(),
            title: "Pixels by number of wedges that cover their surface".to_owned(),
            x: Axis::log2("wedges at a pixel, in bins that end at"),
            y: Axis::log10("pixels"),
            series,
        }],
    })
}

/// Pixels with up to 1, 2, 4, 8, ... wedges and more than half as many.
fn by_doublings(histogram: &[u64]) -> Vec<[f64; 2]> {
    let last = histogram.len().saturating_sub(1).next_power_of_two();
    let ends = (0..=last.trailing_zeros()).map(|p| 1usize << p);
    let bin = |end: usize| {
        let pixels = histogram.iter().take(end + 1).skip(end / 2 + 1);
        [end as f64, pixels.sum::<u64>() as f64]
    };
    ends.map(bin).filter(|[_, pixels]| *pixels > 0.0).collect()
}

/// Error and cost of one picture.
struct Point {
    count: f64,
    rmse: f64,
    /// Step height in penumbrae that 99% do not exceed.
    step: f64,
    megabytes: f64,
    time: f64,
}

const SHADOW: [PassRole; 5] = [
    PassRole::Samples,
    PassRole::HardCount,
    PassRole::Wedges,
    PassRole::Combine,
    PassRole::Resolve,
];

fn point(
    lab: &mut Lab,
    name: &str,
    technique: &str,
    setting: &str,
    count: u32,
) -> Result<Point, ReproduceError> {
    let scene = lab.scene(name)?;
    let done: Rendered = lab.least(2, || lab.render(&scene, technique, &[setting]))?;
    let scored = lab.score(&scene, &done)?;
    Ok(Point {
        count: f64::from(count),
        rmse: scored.error.rmse,
        step: scored.banding.p99,
        megabytes: counters(&done, &SHADOW).traffic.total_bytes() as f64 / 1e6,
        time: pass_time(&done, &SHADOW),
    })
}

pub(super) fn splits(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    let mut charts = Vec::new();
    for name in ["columns", "creature"] {
        let split = [1u32, 2, 3, 4, 6, 8]
            .map(|k| point(lab, name, TECHNIQUE, &format!("split={k}"), k * k));
        let split = split.into_iter().collect::<Result<Vec<Point>, _>>()?;
        let sampled = [4u32, 9, 16, 36, 64, 144, 256, 576, 1024].map(|n| {
            point(
                lab,
                name,
                "sampled-shadow-volumes",
                &format!("samples={n}"),
                n,
            )
        });
        let sampled = sampled.into_iter().collect::<Result<Vec<Point>, _>>()?;
        for (k, pair) in [(2, &split[0..2]), (3, &split[1..3])] {
            measures.push(Measure::new(
                format!("{name}: RMSE of {k}x{k} over the split before"),
                Theirs::AtMost(1.0),
                pair[1].rmse / pair[0].rmse,
                Unit::Ratio,
            ));
        }
        let curve = |error: fn(&Point) -> f64| -> Vec<[f64; 2]> {
            sampled.iter().map(|p| [p.count, error(p)]).collect()
        };
        let equal = |p: &Point| cost_of_error(&curve(|p| p.rmse), p.rmse) / p.count;
        let equal_step = cost_of_error(&curve(|p| p.step), split[2].step) / split[2].count;
        measures.push(Measure::new(
            format!("{name}: samples for the error of 3x3, over 9"),
            Theirs::ratio(100.0, 100.0),
            equal(&split[2]),
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: samples for the error of 2x2, over 4"),
            "-",
            equal(&split[1]),
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: samples for the steps of 3x3, over 9"),
            "-",
            equal_step,
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: RMSE of 3x3"),
            "-",
            split[2].rmse,
            Unit::Number,
        ));
        charts.extend(charts_of(name, &split, &sampled));
    }
    Ok(Finding {
        scene: lab.describe("columns and creature, square light of side 1"),
        counted: "RMSE of float visibility against the exact oracle; samples of a grid, between \
            the counts tried by a straight line in logarithms; bytes and time of the shadow \
            passes"
            .to_owned(),
        measures,
        reason: "The paper judges by eye, with 1024 samples as the picture to reach. Against the \
            exact oracle a few dozen samples have the error of 3x3 splits: what splitting leaves \
            of the single silhouette and of overlap is in few pixels and large there, while the \
            error of samples is small and everywhere."
            .to_owned(),
        charts,
    })
}

/// Invocations of the wedge shader and time of lights in n parts, over those of one.
pub(super) fn sub_lights(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["columns", "creature"] {
        let scene = lab.scene(name)?;
        let shaded = |k: u32| {
            let done = lab.render(&scene, TECHNIQUE, &[&*format!("split={k}")])?;
            Ok::<_, ReproduceError>(invocations(&done, DrawRole::Coverage) as f64)
        };
        let one = shaded(1)?;
        for k in [2u32, 3] {
            measures.push(Measure::new(
                format!("{name}: shaded pixels of {k}x{k} over one, per part"),
                Theirs::AtMost(1.0),
                shaded(k)? / one / f64::from(k * k),
                Unit::Ratio,
            ));
        }
    }
    Ok(Finding {
        scene: lab.describe("columns and creature, square light of side 1"),
        counted: "invocations of the wedge shader".to_owned(),
        measures,
        reason: "Wedges of a part are as thin as it is narrow.".to_owned(),
        charts: Vec::new(),
    })
}

/// Frames with wedges round spheres over those with wedges round rectangles.
pub(super) fn tight_frames(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("creature")?;
    let runs: [(&str, &[&str]); 2] = [
        (TECHNIQUE, &["wedge=paper3"]),
        (TECHNIQUE, &["wedge=paper4"]),
    ];
    let done = lab.race(&scene, runs)?;
    let [wide, tight] = done.each_ref().map(|d| pass_time(d, &SHADOW));
    Ok(Finding {
        scene: lab.describe("creature, for the model of figure 9"),
        counted: "time of frames, and of their shadow passes alone".to_owned(),
        measures: vec![
            Measure::new(
                "frames",
                Theirs::ratio(1.5, 1.5),
                done[0].frame_ms / done[1].frame_ms,
                Unit::Ratio,
            ),
            Measure::beside("shadow passes", "-", wide / tight, Unit::Ratio),
        ],
        reason: "Part of a frame is no wedge, and a wedge's cost here is as much in the blocks \
            that are tested as in the pixels that are shaded."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn charts_of(name: &str, split: &[Point], sampled: &[Point]) -> [Chart; 3] {
    let chart = |suffix: &str, label: &str, x: fn(&Point) -> f64| {
        let points = |all: &[Point]| all.iter().map(|p| [x(p), p.rmse]).collect();
        Chart {
            name: format!("paper4-splits-{name}{suffix}"),
            title: format!("Error against {label}, {name}"),
            x: Axis::log10(label),
            y: Axis::log10("RMSE of visibility"),
            series: vec![
                Series::line("light split k x k", points(split)),
                Series::line("N samples, grid", points(sampled)),
            ],
        }
    };
    [
        chart("", "silhouettes", |p| p.count),
        chart("-bytes", "megabytes of shadow passes", |p| p.megabytes),
        chart("-time", "milliseconds of shadow passes", |p| p.time),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_hold_every_covered_pixel() {
        let histogram = [100, 5, 3, 2, 1, 0, 0, 4];
        let bins = by_doublings(&histogram);
        assert_eq!(bins, [[1.0, 5.0], [2.0, 3.0], [4.0, 3.0], [8.0, 4.0]]);
        assert!(by_doublings(&[7]).is_empty());
    }
}
