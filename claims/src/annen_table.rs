//! Annen et al. 2008, table 1: time over the number of lights, the size of light
//! views, and how images are prefiltered.

use super::annen::{FILTERS, LIGHTS, SIDES, TECHNIQUE};
use super::scenes::statue_lights;
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;

/// Frames per second in table 1: by filter, side of views and number of lights;
/// `None` where it has no entry.
pub(super) const FPS: [[[Option<f64>; 4]; 4]; 2] = [
    [
        [Some(258.0), Some(48.0), Some(28.0), Some(18.0)],
        [Some(228.0), Some(44.0), Some(25.0), Some(15.0)],
        [Some(189.0), Some(38.0), Some(20.0), Some(13.0)],
        [Some(110.0), Some(24.0), Some(5.0), None],
    ],
    [
        [Some(128.0), Some(15.0), Some(8.8), None],
        [Some(110.0), Some(13.0), Some(7.5), None],
        [Some(89.0), Some(11.0), Some(6.0), None],
        [Some(52.0), Some(3.0), Some(1.5), None],
    ],
];

/// The entry that others are compared with: mip chains of 256x256, one light.
const BASE: [usize; 3] = [0, 1, 0];

/// Sides and numbers of lights, as indices, without `--full`.
const SOME: &[[usize; 2]] = &[[0, 0], [1, 0], [2, 0], [0, 1], [1, 1]];

/// All of them.
fn all() -> Vec<[usize; 2]> {
    let sides = 0..SIDES.len();
    sides
        .flat_map(|s| (0..LIGHTS.len()).map(move |l| [s, l]))
        .collect()
}

/// A measured entry.
struct Entry {
    /// Filter, side, number of lights.
    at: [usize; 3],
    ms: f64,
    bytes: f64,
}

impl Entry {
    fn new(lab: &Lab, at: [usize; 3]) -> Result<Self, ReproduceError> {
        let scene = statue_lights(lab, LIGHTS[at[2]])?;
        let side = format!("map-size={}", SIDES[at[1]]);
        // Long frames make up themselves for what else the machine does.
        let (turns, frames) = match scene.lights.len() {
            1 => (3, 3),
            2..=10 => (2, 2),
            _ => (1, 1),
        };
        let set = [FILTERS[at[0]].0, &*side];
        let done = lab.least(turns, || lab.steady(&scene, TECHNIQUE, &set, frames))?;
        Ok(Self {
            at,
            ms: done.frame_ms,
            bytes: frame_bytes(&done),
        })
    }

    fn name(&self) -> String {
        let [filter, side, lights] = self.at;
        let lights = match LIGHTS[lights] {
            1 => "1 light".to_owned(),
            n => format!("{n} lights"),
        };
        format!("{} {}, {lights}", FILTERS[filter].1, SIDES[side])
    }
}

fn theirs([filter, side, lights]: [usize; 3]) -> Option<f64> {
    FPS[filter][side][lights]
}

fn frame_bytes(done: &Rendered) -> f64 {
    let passes = done.report.passes.iter();
    passes
        .map(|p| p.totals().traffic.total_bytes())
        .sum::<u64>() as f64
}

/// Entries of sides and numbers of lights, each by either filter.
fn entries(lab: &Lab, chosen: &[[usize; 2]]) -> Result<Vec<Entry>, ReproduceError> {
    let both = |&[side, lights]: &[usize; 2]| [0, 1].map(|f| [f, side, lights]);
    let entry = |at| Entry::new(lab, at);
    chosen.iter().flat_map(both).map(entry).collect()
}

fn find(entries: &[Entry], at: [usize; 3]) -> &Entry {
    let found = entries.iter().find(|e| e.at == at);
    found.expect("every selection has the entry")
}

pub(super) fn table(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let chosen = if lab.settings().full {
        all()
    } else {
        SOME.to_vec()
    };
    let all = entries(lab, &chosen)?;
    let base = find(&all, BASE);
    let base_fps = theirs(BASE).unwrap_or(f64::NAN);
    let mut measures = vec![Measure::beside(
        "mip 256, 1 light, which the others are over",
        "4.39 ms",
        base.ms,
        Unit::Milliseconds,
    )];
    for entry in all.iter().filter(|e| e.at != BASE) {
        let theirs = match theirs(entry.at) {
            Some(fps) => Theirs::ratio(base_fps / fps, base_fps / fps),
            None => Theirs::Beside("missing"),
        };
        let ours = entry.ms / base.ms;
        measures.push(Measure::new(entry.name(), theirs, ours, Unit::Ratio));
    }
    Ok(Finding {
        scene: lab.describe("statue of 70,000 triangles, square lights all round"),
        counted: "frame time, emulated: of 20 and 40 lights one frame, else the least of some. The whole table with --full, \
            minutes; else a part of it"
            .to_owned(),
        measures,
        reason:
            "The emulated GPU does each light's work anew, filtering included, and a frame has \
            little else in it: ten lights take ten times as long, where the paper's frame had a \
            share that does not grow with lights. And a texel costs it more beside a pixel, \
            since filtering is many passes over images in memory, the more so in tables of 32 \
            bits: from 512 texels on, times grow faster with the size than the paper's do."
                .to_owned(),
        charts: charts(&all, base, base_fps),
    })
}

/// Times over the number of lights, a chart for each filter: ours, and theirs for the
/// least and the largest views.
fn charts(all: &[Entry], base: &Entry, base_fps: f64) -> Vec<Chart> {
    let of = |f: usize, s: usize, figure: &dyn Fn(&Entry) -> Option<f64>| {
        let of = all.iter().filter(|e| e.at[..2] == [f, s]);
        let points = of.filter_map(|e| Some([LIGHTS[e.at[2]] as f64, figure(e)?]));
        points.collect::<Vec<_>>()
    };
    let chart = |f: usize| {
        let mut series = Vec::new();
        for (s, side) in SIDES.into_iter().enumerate() {
            let ours = of(f, s, &|e| Some(e.ms / base.ms));
            series.push(Series::line(&format!("{side}: ours"), ours));
        }
        for s in [0, SIDES.len() - 1] {
            let points = (0..LIGHTS.len())
                .filter_map(|l| Some([LIGHTS[l] as f64, base_fps / theirs([f, s, l])?]));
            let label = format!("{}: theirs", SIDES[s]);
            series.push(Series::marked(&label, points.collect(), Mark::Dashed));
        }
        series.retain(|s| !s.points.is_empty());
        let name = FILTERS[f].1;
        Chart {
            name: format!("annen-table1-{}", name.to_lowercase()),
            title: format!("Table 1, {name}: times over mip 256 with one light"),
            x: Axis::log10("lights"),
            y: Axis::log10("times mip 256 with one light"),
            series,
        }
    };
    (0..FILTERS.len()).map(chart).collect()
}

pub(super) fn threefold(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let lights: &[usize] = match lab.settings().full {
        true => &[0, 1, 2],
        false => &[0, 1],
    };
    let chosen: Vec<[usize; 2]> = lights.iter().map(|l| [1, *l]).collect();
    let all = entries(lab, &chosen)?;
    let mut measures = Vec::new();
    for &light in lights {
        let [mip, sat] = [0, 1].map(|filter| find(&all, [filter, 1, light]));
        let row = |what: &str, theirs, ours| {
            let what = format!("lights {}: {what}", LIGHTS[light]);
            Measure::new(what, theirs, ours, Unit::Ratio)
        };
        let fps = |entry: &Entry| theirs(entry.at).unwrap_or(f64::NAN);
        let least = || Theirs::AtLeast(3.0);
        measures.push(row(
            "tables over mip, by their table 1",
            least(),
            fps(mip) / fps(sat),
        ));
        measures.push(row(
            "bytes, tables over mip",
            least(),
            sat.bytes / mip.bytes,
        ));
        measures.push(row(
            "time, tables over mip",
            Theirs::Beside("> 3x"),
            sat.ms / mip.ms,
        ));
    }
    Ok(Finding {
        scene: lab.describe("statue of 70,000 triangles, square lights all round"),
        counted: "all bytes of the frame, and its time; views of 256x256".to_owned(),
        measures,
        reason:
            "The paper's own table has 228 and 110 fps with one light, 2.1 times; only from 10 \
            lights on it is more than three. In bytes it is more than that here whatever the \
            number of lights; time follows bytes only in part, since look-ups cost arithmetic."
                .to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LabSettings;

    #[test]
    fn the_table_is_the_paper_s() {
        let all = FPS.as_flattened().as_flattened();
        assert_eq!(all.iter().flatten().count(), 27);
        let falls = |row: &[Option<f64>; 4]| row.iter().flatten().is_sorted_by(|a, b| a > b);
        assert!(FPS.as_flattened().iter().all(falls));
        let chosen = super::all();
        assert!(chosen.len() == 16 && SOME.iter().all(|e| chosen.contains(e)));
        assert!(SOME.contains(&[BASE[1], BASE[2]]));
    }

    /// Tables move more, and charts show what was measured.
    #[test]
    fn entries_are_measured_and_drawn() {
        let settings = LabSettings {
            size: [48, 36],
            repeat: 1,
            ..LabSettings::default()
        };
        let lab = Lab::new(settings, None);
        let all = entries(&lab, &[[0, 0], [1, 0]]).unwrap();
        let bytes = |at| find(&all, at).bytes;
        assert!(bytes([1, 1, 0]) > 3.0 * bytes([0, 1, 0]));
        assert!(bytes([1, 1, 0]) > bytes([1, 0, 0]));
        assert_eq!(all[1].name(), "SAT 128, 1 light");
        let drawn = charts(&all, find(&all, BASE), 228.0);
        assert_eq!(drawn.len(), 2);
        let base = &drawn[0].series[1];
        assert_eq!(base.label, "256: ours");
        assert_eq!(base.points, [[1.0, 1.0]]);
    }
}
