//! Paper IV: overlaps at a pixel, and lights split into smaller ones.

use super::lab::{counters, pass_time};
use super::overlaps::Overlaps;
use super::paper4::TECHNIQUE;
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Mark, Series};
use crate::render::Rendered;

const SCENES: [&str; 3] = ["cylinder", "creature", "columns"];

pub(super) fn overlap(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    let mut series = Vec::new();
    for name in SCENES {
        let scene = lab.scene(name)?;
        let found = Overlaps::measure(lab, &scene, &["wedge=paper4"])?;
        let histogram = found.histogram();
        let covered: u64 = histogram.iter().skip(1).sum();
        let beyond: u64 = histogram.iter().skip(17).sum();
        let most = f64::from(found.most());
        // A cylinder is not complex: shown, not judged.
        measures.push(match name {
            "cylinder" => Measure::beside(
                format!("{name}: most wedges at a pixel"),
                "-",
                most,
                Unit::Count,
            ),
            _ => Measure::new(
                format!("{name}: most wedges at a pixel"),
                Theirs::AtLeast(17.0),
                most,
                Unit::Count,
            ),
        });
        measures.push(Measure::beside(
            format!("{name}: pixels beyond 16, of those covered"),
            "some",
            beyond as f64 / covered as f64,
            Unit::Share,
        ));
        let point = |(wedges, pixels): (usize, &u64)| [wedges as f64, *pixels as f64];
        let shown = histogram
            .iter()
            .enumerate()
            .skip(1)
            .filter(|(_, p)| **p > 0);
        series.push(Series::line(name, shown.map(point).collect()));
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
        scene: lab.describe("cylinder, creature and columns"),
        counted: "wedges that wrote to a pixel, tight wedges, pixels outside skipped; additive \
            and subtractive ones together, as each writes 4 B to both RGBA8 buffers. Either \
            buffer has at least half of them where they are most"
            .to_owned(),
        measures,
        reason: "The model has too few edges behind one another at this size.".to_owned(),
        charts: vec![Chart {
            name: "paper4-overlap".to_owned(),
            title: "Pixels by number of wedges that cover their surface".to_owned(),
            x: Axis::linear("wedges at a pixel"),
            y: Axis::log10("pixels"),
            series,
        }],
    })
}

/// Error and cost of one picture.
struct Point {
    count: f64,
    rmse: f64,
    megabytes: f64,
    time: f64,
}

const SHADOW: [&str; 5] = ["samples", "quads", "wedges", "combine", "resolve"];

fn point(
    lab: &mut Lab,
    name: &str,
    technique: &str,
    setting: &str,
    count: u32,
) -> Result<Point, ReproduceError> {
    let scene = lab.scene(name)?;
    let done: Rendered = lab.render(&scene, technique, &[setting])?;
    Ok(Point {
        count: f64::from(count),
        rmse: lab.score(&scene, &done)?.error.rmse,
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
        let equal = |p: &Point| samples_for(&sampled, p.rmse) / p.count;
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
        reason: "The paper compares by eye with 1024 samples, whose own banding is smooth \
            splitting's advantage; by RMSE a few dozen samples are as near as 3x3 splits, \
            since what is left of the single silhouette and of overlap is concentrated in few \
            pixels and large there."
            .to_owned(),
        charts,
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

/// How many samples have the error `rmse`: the last crossing, by interpolation in
/// logarithms; the greatest count tried where even that is worse.
fn samples_for(sampled: &[Point], rmse: f64) -> f64 {
    let pairs = sampled.windows(2).rev();
    let mut crossings = pairs.filter(|w| w[0].rmse >= rmse && w[1].rmse < rmse);
    match (crossings.next(), sampled.first(), sampled.last()) {
        (Some([a, b]), ..) => {
            let ln = |v: f64| libm::log(v);
            let t = (ln(a.rmse) - ln(rmse)) / (ln(a.rmse) - ln(b.rmse));
            libm::exp(ln(a.count) + t * (ln(b.count) - ln(a.count)))
        }
        (_, Some(first), _) if first.rmse < rmse => first.count,
        (_, _, Some(last)) => last.count,
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_error_is_found_between_samples() {
        let point = |count: f64, rmse: f64| Point {
            count,
            rmse,
            megabytes: 0.0,
            time: 0.0,
        };
        let falling = [point(10.0, 0.1), point(1000.0, 0.001)];
        assert!((samples_for(&falling, 0.01) - 100.0).abs() < 1e-9);
        assert_eq!(samples_for(&falling, 0.5), 10.0);
        assert_eq!(samples_for(&falling, 1e-5), 1000.0);
        assert!(samples_for(&[], 0.1).is_nan());
    }
}
