//! Paper III: how the cost grows with pixels, lights and objects.

use super::paper3::TECHNIQUE;
use super::scenes::{cylinders, lights, with_lights_scaled};
use super::tally::{counters, invocations, pass_time, ratio, written};
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use crate::chart::{Axis, Chart, Mark, Series};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{DrawRole, PassRole};
use gnomon_pipeline::world::scene::Scene;

const SHADOW: [PassRole; 2] = [PassRole::HardCount, PassRole::Wedges];

fn shaded(done: &Rendered) -> u64 {
    invocations(done, DrawRole::Coverage)
}

pub(super) fn resolution(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("creature")?;
    let render = |side: u32| lab.timed_at(&scene, TECHNIQUE, &[], [side; 2]);
    let done = [render(100)?, render(256)?, render(512)?];
    let time = done.each_ref().map(|d| pass_time(d, &SHADOW));
    let pixels = done.each_ref().map(shaded);
    let slower = |published: f64, pixels: f64| Theirs::Effect {
        low: published,
        high: published,
        neutral: pixels,
        slack: super::SLACK,
    };
    Ok(Finding {
        scene: "creature (for the fairy), 100x100, 256x256 and 512x512".to_owned(),
        counted: "time of the shadow passes, and shader invocations of wedges; the direction is \
            less than the growth of pixels"
            .to_owned(),
        measures: vec![
            Measure::new(
                "time, 512 over 100 (26.2x the pixels)",
                slower(3.0 / 0.14, 26.2144),
                time[2] / time[0],
                Unit::Ratio,
            ),
            Measure::new(
                "time, 512 over 256 (4x the pixels)",
                slower(0.51 / 0.14, 4.0),
                time[2] / time[1],
                Unit::Ratio,
            ),
            Measure::beside(
                "wedge pixels, 512 over 256",
                "-",
                ratio(pixels[2], pixels[1]),
                Unit::Ratio,
            ),
        ],
        reason: "Each wedge is a draw of its own with a cost of its own, whatever the size of \
            the picture; small pictures are mostly that."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// Pixels on which paper III's shader runs: those of front faces of wedges that pass
/// the depth test, which a draw of its own notes; all of them where the eye is in a
/// wedge, which has no such draw.
pub(super) fn behind_front(done: &Rendered) -> u64 {
    let mut around_eye = 0;
    for (number, pass) in done.report.passes.iter().enumerate() {
        let role = |draw| done.roles.of_draw(number, draw);
        let alone = |k: usize| k == 0 || role(k - 1) != DrawRole::Note;
        for (k, draw) in pass.draws.iter().enumerate() {
            if role(k) == DrawRole::Coverage && alone(k) {
                around_eye += draw.counters.fragment_shader_invocations;
            }
        }
    }
    written(done, DrawRole::Note) + around_eye
}

pub(super) fn light_side(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["creature", "spheres"] {
        let scene = lab.scene(name)?;
        let half = with_lights_scaled(scene.clone(), 0.5);
        let [whole, halved] = [&scene, &half].map(|s| lab.timed(s, TECHNIQUE, &["wedge=paper3"]));
        let (whole, halved) = (whole?, halved?);
        measures.push(Measure::new(
            format!("{name}: pixels behind front faces of wedges, whole over half"),
            Theirs::AtLeast(2.0),
            ratio(behind_front(&whole), behind_front(&halved)),
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: time of shadow passes, whole over half"),
            "> 2x (frame)",
            pass_time(&whole, &SHADOW) / pass_time(&halved, &SHADOW),
            Unit::Ratio,
        ));
        let [whole, halved] = [&scene, &half].map(|s| lab.render(s, TECHNIQUE, &[]));
        measures.push(Measure::beside(
            format!("{name}: pixels of penumbrae (exact wedges)"),
            "-",
            ratio(shaded(&whole?), shaded(&halved?)),
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("creature and spheres, light of side 1 and 1/2"),
        counted: "pixels whose surface is behind a front face of paper III's wedges, which its \
            shader has to look at, shader invocations in exact wedges, and time of the shadow \
            passes"
            .to_owned(),
        measures,
        reason: "A wedge is as wide as the light and as long as its edge's shadow: half the \
            light is half the pixels where wedges are long and thin. What all wedges have \
            whatever the light, the hard shadow quads in them, does not shrink."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// Work of one scene.
struct Cost {
    draws: u64,
    pixels: u64,
    bytes: u64,
    time: f64,
}

fn cost(lab: &Lab, scene: &Scene) -> Result<Cost, ReproduceError> {
    let done = lab.timed(scene, TECHNIQUE, &[])?;
    Ok(Cost {
        draws: super::tally::draws(&done, DrawRole::Coverage) as u64,
        pixels: shaded(&done),
        bytes: counters(&done, &SHADOW).traffic.total_bytes(),
        time: pass_time(&done, &SHADOW),
    })
}

pub(super) fn linear(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let objects: Vec<Cost> = [2, 4, 8, 16]
        .into_iter()
        .map(|n| cost(lab, &cylinders(n, 4.0)?))
        .collect::<Result<_, _>>()?;
    let by_lights: Vec<Cost> = [1, 2, 4]
        .into_iter()
        .map(|n| cost(lab, &lights(n)?))
        .collect::<Result<_, _>>()?;
    let linear = |what: &str, by: f64, ours: f64| {
        let theirs = Theirs::None {
            neutral: 1.0,
            within: 0.25,
        };
        Measure::new(
            format!("{what}, over {by} times"),
            theirs,
            ours / by,
            Unit::Ratio,
        )
    };
    let [first, last] = [&objects[0], &objects[3]];
    let [one, four] = [&by_lights[0], &by_lights[2]];
    let per_pixel = |c: &Cost| c.time / c.pixels as f64;
    let points = |costs: &[Cost]| {
        let point = |c: &Cost| [c.pixels as f64 / 1e3, c.time];
        costs.iter().map(point).collect()
    };
    Ok(Finding {
        scene: lab.describe("2 to 16 cylinders apart, and one with 1 to 4 lights"),
        counted: "draws of wedges, shader invocations, bytes and time of the shadow passes, \
            each as growth over the growth of objects or lights: 1 is linear"
            .to_owned(),
        measures: vec![
            linear(
                "8 times the objects: edges",
                8.0,
                ratio(last.draws, first.draws),
            ),
            linear(
                "8 times the objects: pixels",
                8.0,
                ratio(last.pixels, first.pixels),
            ),
            linear(
                "8 times the objects: bytes",
                8.0,
                ratio(last.bytes, first.bytes),
            ),
            linear(
                "4 times the lights: pixels",
                4.0,
                ratio(four.pixels, one.pixels),
            ),
            linear(
                "4 times the lights: bytes",
                4.0,
                ratio(four.bytes, one.bytes),
            ),
            Measure::beside(
                "time per pixel, 16 objects over 2",
                "1x",
                per_pixel(last) / per_pixel(first),
                Unit::Ratio,
            ),
        ],
        reason: "Lights that stand in different places cast shadows of different size, and \
            every pass reads and writes some bytes whatever it draws."
            .to_owned(),
        charts: vec![Chart {
            name: "paper3-linear".to_owned(),
            title: "Time of shadow passes against wedge pixels".to_owned(),
            x: Axis::linear("thousand wedge pixels shaded"),
            y: Axis::linear("milliseconds of the shadow passes"),
            series: vec![
                Series::line("2 to 16 objects", points(&objects)),
                Series::marked("1 to 4 lights", points(&by_lights), Mark::Line),
            ],
        }],
    })
}
