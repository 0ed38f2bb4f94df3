//! Paper I: Akenine-Möller and Assarsson, "Approximate Soft Shadows on Arbitrary
//! Surfaces using Penumbra Wedges", 2002.

use std::ops::{Add, Div, Mul};

use super::scenes::{acute_triangle, cylinders};
use super::tally::{counters, pass_time, ratio};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::PassRole;

const TECHNIQUE: &str = "penumbra-wedges";

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "paper1-extra-wedges",
        "paper I, §4.1",
        Verdict::Times,
        "Six more wedges round acute vertices cost about 20% of the frame rate, since they \
         are long and thin.",
        extra_wedges,
    )
    .read_from(&[Lines::to(702, 707)]),
    Claim::new(
        "paper1-side-planes",
        "paper I, §5",
        Verdict::Times,
        "Leaving out side planes, which cancel, and precomputing constants make wedge \
         rasterisation about 50% faster.",
        side_planes,
    )
    .read_from(&[Lines::to(741, 748)]),
    Claim::new(
        "paper1-cost",
        "paper I, §8",
        Verdict::Counters,
        "The cost is proportional to the number of silhouette edges and the area of wedges.",
        cost,
    )
    .read_from(&[Lines::one(784)]),
    Claim::new(
        "paper1-one-division",
        "paper I, §4.2",
        Verdict::Arithmetic,
        "The intensity inside a wedge can be had with one division instead of four.",
        one_division,
    )
    .read_from(&[Lines::to(729, 735)]),
    Claim::new(
        "paper1-zmax",
        "paper I, §5",
        Verdict::Counters,
        "Culling fragments of front-facing wedge triangles by zmax of 8x8 pixels can gain \
         performance.",
        zmax,
    )
    .read_from(&[Lines::one(750)]),
    Claim::quoted(
        "paper1-frame-rates",
        "paper I, §7, figure 15; thesis, §2.2.2",
        "Athlon at 1.5 GHz: 2 fps in software beside 20 fps of Heckbert and Herf's shadows \
         on a GeForce3; 1.8 fps at 512x512; wedges of 6 to 16 quads in hardware 5 fps.",
    )
    .read_from(&[Lines::one(352), Lines::to(762, 766), Lines::one(852)]),
];

fn wedge_pixels(done: &Rendered) -> u64 {
    counters(done, &[PassRole::Wedges]).fragment_shader_invocations
}

fn extra_wedges(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = acute_triangle()?;
    let runs: [(&str, &[&str]); 2] = [(TECHNIQUE, &[]), (TECHNIQUE, &["extra-wedges=off"])];
    let [on, off] = lab.race(&scene, runs)?;
    let time = |done| pass_time(done, &[PassRole::Wedges]);
    Ok(Finding {
        scene: lab.describe("floating triangle with an angle of 14 degrees, spherical light"),
        counted:
            "time of the pass `wedges`, which was nearly all of the paper's frame, and shader \
            invocations of it"
                .to_owned(),
        measures: vec![
            Measure::new(
                "speed of the wedge pass lost",
                Theirs::share(0.2, 0.2),
                1.0 - time(&off) / time(&on),
                Unit::Share,
            ),
            Measure::beside(
                "shaded wedge pixels, with over without",
                "-",
                ratio(wedge_pixels(&on), wedge_pixels(&off)),
                Unit::Ratio,
            ),
            Measure::beside(
                "wedges, with over without",
                "-",
                ratio(wedge_draws(&on), wedge_draws(&off)),
                Unit::Ratio,
            ),
        ],
        reason: "Three edges get up to eighteen wedges more here, and nothing else is in the \
            picture but a floor: the share of extra wedges is the largest that there can be. \
            In a scene with many blunt vertices it is smaller."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn side_planes(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let [naive, evaluate, cancel] = lab.race(
        &scene,
        [
            (TECHNIQUE, &["side-planes=naive"]),
            (TECHNIQUE, &["side-planes=evaluate"]),
            (TECHNIQUE, &["side-planes=cancel"]),
        ],
    )?;
    let time = |done| pass_time(done, &[PassRole::Wedges]);
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "time of the pass `wedges`: the equation at every entry and exit, at side \
            planes from what neighbours share, and at surfaces inside only; what is constant \
            over a wedge is precomputed in all"
            .to_owned(),
        measures: vec![
            Measure::new(
                "faster than the equation everywhere by",
                Theirs::share(0.5, 0.5),
                time(&naive) / time(&cancel) - 1.0,
                Unit::Share,
            ),
            Measure::beside(
                "faster than evaluated side planes by",
                "-",
                time(&evaluate) / time(&cancel) - 1.0,
                Unit::Share,
            ),
        ],
        reason: "Precomputed constants cannot be turned off here, and on wide registers \
            arithmetic is a smaller share of a pixel's cost than it was."
            .to_owned(),
        charts: Vec::new(),
    })
}

fn zmax(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("columns")?;
    let runs: [(&str, &[&str]); 2] = [
        (TECHNIQUE, &["culling=none"]),
        (TECHNIQUE, &["culling=zmax"]),
    ];
    let [without, with] = lab.race(&scene, runs)?;
    let tiles = counters(&with, &[PassRole::Wedges]).tiles;
    let time = |done| pass_time(done, &[PassRole::Wedges]);
    Ok(Finding {
        scene: lab.describe("columns"),
        counted: "shader invocations of the pass `wedges`, whose faces towards the eye are \
            tested by the emulated GPU's zmax of 8x8 pixels"
            .to_owned(),
        measures: vec![
            Measure::new(
                "invocations without over with zmax",
                Theirs::AtLeast(1.05),
                ratio(wedge_pixels(&without), wedge_pixels(&with)),
                Unit::Ratio,
            ),
            Measure::beside(
                "blocks culled, of those tested",
                "-",
                ratio(tiles.culled, tiles.tested),
                Unit::Share,
            ),
            Measure::beside(
                "time without over with zmax",
                "can gain",
                time(&without) / time(&with),
                Unit::Ratio,
            ),
        ],
        reason: "Nothing in the picture lies before the wedges.".to_owned(),
        charts: Vec::new(),
    })
}

/// Draws of wedges: front face and others.
fn wedge_draws(done: &Rendered) -> u64 {
    let passes = done.report.passes.iter().zip(done.roles.passes());
    let wedges = passes.filter(|(_, role)| **role == PassRole::Wedges);
    wedges.map(|(p, _)| p.draws.len() as u64).sum()
}

/// One scene's wedges.
struct Sample {
    edges: f64,
    /// Millions.
    pixels: f64,
    /// Milliseconds.
    time: f64,
}

fn cost(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut all = Vec::new();
    for side in [0.5, 1.0, 2.0] {
        for count in [2, 4, 8, 16] {
            let done = lab.timed(&cylinders(count, side)?, TECHNIQUE, &[])?;
            all.push(Sample {
                edges: wedge_draws(&done) as f64,
                pixels: wedge_pixels(&done) as f64 / 1e6,
                time: pass_time(&done, &[PassRole::Wedges]),
            });
        }
    }
    // Light of side 1: 2 and 16 cylinders.
    let (first, last) = (&all[4], &all[7]);
    let growth = (last.pixels / first.pixels) / (last.edges / first.edges);
    let fit = Fit::of(&all);
    let points = all.iter().map(|s| [fit.time(s), s.time]).collect();
    let longest = all.iter().map(|s| s.time).fold(0.0, f64::max);
    Ok(Finding {
        scene: lab.describe("2 to 16 cylinders apart, lights of side 0.5, 1 and 2"),
        counted: "wedges, shader invocations and time of the pass `wedges`, and the share of \
            the variance of time that the best sum of a time per wedge and a time per pixel \
            explains"
            .to_owned(),
        measures: vec![
            Measure::new(
                "growth of pixels over growth of wedges",
                Theirs::None {
                    neutral: 1.0,
                    within: 0.25,
                },
                growth,
                Unit::Ratio,
            ),
            Measure::beside(
                "variance of time explained",
                "-",
                fit.explained(&all),
                Unit::Share,
            ),
            Measure::beside("microseconds a wedge", "-", 1e3 * fit.edge, Unit::Number),
            Measure::beside("nanoseconds a pixel", "-", fit.pixel, Unit::Number),
        ],
        reason: "Wedges at the picture's edge are cut off, and cylinders farther from the eye \
            have smaller ones."
            .to_owned(),
        charts: vec![Chart {
            name: "paper1-cost".to_owned(),
            title: "Time of wedges against the best sum over edges and pixels".to_owned(),
            x: Axis::linear("milliseconds by the sum"),
            y: Axis::linear("milliseconds measured"),
            series: vec![
                Series::marked("scenes", points, Mark::Dots),
                Series::marked("equal", vec![[0.0, 0.0], [longest; 2]], Mark::Dashed),
            ],
        }],
    })
}

/// Time as `edge` times the edges and `pixel` times the pixels: least squares.
struct Fit {
    edge: f64,
    pixel: f64,
}

impl Fit {
    fn of(all: &[Sample]) -> Self {
        let sum = |f: fn(&Sample) -> f64| all.iter().map(f).sum::<f64>();
        let (ee, ep, pp) = (
            sum(|s| s.edges * s.edges),
            sum(|s| s.edges * s.pixels),
            sum(|s| s.pixels * s.pixels),
        );
        let (et, pt) = (sum(|s| s.edges * s.time), sum(|s| s.pixels * s.time));
        let determinant = ee * pp - ep * ep;
        Self {
            edge: (et * pp - pt * ep) / determinant,
            pixel: (ee * pt - ep * et) / determinant,
        }
    }

    fn time(&self, sample: &Sample) -> f64 {
        self.edge * sample.edges + self.pixel * sample.pixels
    }

    fn explained(&self, all: &[Sample]) -> f64 {
        let mean = all.iter().map(|s| s.time).sum::<f64>() / all.len() as f64;
        let square = |v: f64| v * v;
        let left: f64 = all.iter().map(|s| square(s.time - self.time(s))).sum();
        let whole: f64 = all.iter().map(|s| square(s.time - mean)).sum();
        1.0 - left / whole
    }
}

/// A number that knows how many divisions made it.
#[derive(Clone, Copy)]
pub(super) struct Divided {
    value: f64,
    divisions: u32,
}

impl Divided {
    pub(super) fn of(value: f64) -> Self {
        let divisions = 0;
        Self { value, divisions }
    }

    pub(super) fn divisions(self) -> u32 {
        self.divisions
    }

    fn joined(self, other: Self, value: f64, more: u32) -> Self {
        let divisions = self.divisions + other.divisions + more;
        Self { value, divisions }
    }
}

impl Add for Divided {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.joined(o, self.value + o.value, 0)
    }
}

impl Mul for Divided {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        self.joined(o, self.value * o.value, 0)
    }
}

impl Div for Divided {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        self.joined(o, self.value / o.value, 1)
    }
}

/// Intensity by equations (2) and (3), as they are written.
fn as_written([front, back, first, second]: [Divided; 4], [k, m, r]: [Divided; 3]) -> Divided {
    let at_first = back / (front * k + back);
    let at_second = back / (front * m + back);
    let both = first + second * r;
    (second * r / both) * at_first + (first / both) * at_second
}

/// The same as the shader has it: `gnomon_shaders::penumbra::intensity`.
pub(super) fn rearranged(
    [front, back, first, second]: [Divided; 4],
    [k, m, r]: [Divided; 3],
) -> Divided {
    let (at_first, at_second) = (front * k + back, front * m + back);
    let second = second * r;
    back * (second * at_second + first * at_first) / (at_first * at_second * (first + second))
}

fn one_division(_: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut worst: f64 = 0.0;
    let mut divisions = [0; 2];
    let steps = [0.01, 0.3, 1.0, 2.5];
    for (i, a) in steps.into_iter().enumerate() {
        for (j, b) in steps.into_iter().enumerate() {
            for c in steps {
                let distances = [a, b, c, steps[(i + j) % 4]].map(Divided::of);
                let rates = [0.5 + a, 1.5 * b, 0.25 + c].map(Divided::of);
                let both = [as_written(distances, rates), rearranged(distances, rates)];
                worst = worst.max((both[0].value - both[1].value).abs());
                divisions = both.map(|d| d.divisions);
            }
        }
    }
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "divisions of the two forms of the equations, which the shader has in the \
            second form (`gnomon_shaders::penumbra::intensity`), and their largest difference \
            in f64 at 64 places inside a wedge"
            .to_owned(),
        measures: vec![
            Measure::new(
                "divisions as written",
                Theirs::Exactly(4.0),
                f64::from(divisions[0]),
                Unit::Count,
            ),
            Measure::new(
                "divisions rearranged",
                Theirs::Exactly(1.0),
                f64::from(divisions[1]),
                Unit::Count,
            ),
            Measure::new(
                "largest difference of the forms",
                Theirs::AtMost(1e-12),
                worst,
                Unit::Number,
            ),
        ],
        reason: "The forms are not the same.".to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_finds_what_made_the_times() {
        let sample = |edges: f64, pixels: f64| Sample {
            edges,
            pixels,
            time: 0.01 * edges + 5.0 * pixels,
        };
        let mut all = vec![sample(64.0, 0.1), sample(128.0, 0.3), sample(256.0, 0.2)];
        let fit = Fit::of(&all);
        assert!((fit.edge - 0.01).abs() < 1e-9 && (fit.pixel - 5.0).abs() < 1e-9);
        assert!((fit.explained(&all) - 1.0).abs() < 1e-9);
        all[0].time = 20.0;
        assert!(Fit::of(&all).explained(&all) < 0.9);
    }
}
