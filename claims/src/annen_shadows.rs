//! Annen et al. 2008, figures 7 to 9: shadows of one light against the exact truth.

use glam::DVec3;

use super::annen::TECHNIQUE;
use super::lab::Scored;
use super::scenes::{WALL_BACK, wall, with_lights_scaled};
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use gnomon_pipeline::measure::comparison::facing;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::world::scene::Scene;

/// Scenes that figures are taken on: a closed form, and casters with self-shadow.
const SCENES: [&str; 3] = ["parallel-plates", "spheres", "creature"];

const STEPS: &str = "step height: the jump of the error between neighbouring penumbra pixels that \
    99% of the pairs do not exceed";

fn scored(
    lab: &mut Lab,
    scene: &Scene,
    technique: &str,
    set: &[&str],
) -> Result<Scored, ReproduceError> {
    let mut done = lab.render(scene, technique, set)?;
    // Others are dark whatever is visible from them.
    let faces = facing(scene, 0, done.size);
    let turned = done.visibility.iter_mut().zip(&faces);
    turned
        .filter(|(_, faces)| !**faces)
        .for_each(|(v, _)| *v = f32::NAN);
    lab.score(scene, &done)
}

pub(super) fn mip_quality(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    let scenes = SCENES.map(|name| lab.scene(name));
    let large = lab.scene("creature").map(|s| with_lights_scaled(s, 3.0));
    for scene in scenes.into_iter().chain([large]) {
        let scene = scene?;
        let name = &scene.name;
        let mip = scored(lab, &scene, TECHNIQUE, &["filter=mip"])?;
        let sat = scored(lab, &scene, TECHNIQUE, &["filter=sat-u32"])?;
        measures.push(Measure::new(
            format!("{name}: RMSE, mip chains over tables"),
            Theirs::AtLeast(1.0),
            mip.error.rmse / sat.error.rmse,
            Unit::Ratio,
        ));
        measures.push(Measure::beside(
            format!("{name}: step height, mip chains over tables"),
            "> 1x",
            mip.banding.p99 / sat.banding.p99,
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: lab.describe("parallel-plates, spheres, creature, and that under a light of side 3"),
        counted: format!(
            "RMSE of float visibility against the exact oracle where surfaces face the light; {STEPS}; views of 512x512, M = 4, \
             tables in exact integers"
        ),
        measures,
        reason: "Levels are chosen finer than the kernel (mip-sharper=0.8), which leaves less of \
            their steps, and trilinear look-ups smooth the rest; what errs is the same in both: \
            blockers of several depths."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// How far behind the wall is its contact, and from where on penumbrae are wide; its
/// shadow is 1.2 long and more.
const CONTACT: f64 = 0.3;
const FAR: f64 = 0.9;

/// Points that pixels show.
fn points(scene: &Scene, done: &Rendered) -> Vec<Option<DVec3>> {
    let [width, height] = done.size;
    let rays = scene.camera.eye_rays(width, height);
    let point = |(i, depth): (usize, &f32)| {
        let [x, y] = [i as u32 % width, i as u32 / width].map(|c| f64::from(c) + 0.5);
        let away = scene.camera.near / (1.0 - f64::from(*depth));
        (*depth < 1.0).then(|| rays.origin + rays.direction(x, y) * away)
    };
    done.depth.iter().enumerate().map(point).collect()
}

/// Errors and changes of visibility on the floor behind the wall, without sharpening
/// and with.
struct Sharpened {
    /// At the contact, where the truth is below 1/2: mean and RMSE.
    leak: [f64; 2],
    contact: [f64; 2],
    /// In the penumbra far behind: RMSE, and RMS of what sharpening changes.
    far: [f64; 2],
    change: f64,
    /// Of either set.
    pixels: [usize; 2],
}

impl Sharpened {
    fn new(lab: &mut Lab) -> Result<Self, ReproduceError> {
        let scene = wall()?;
        let [without, with] = ["a=0", "a=30"].map(|a| {
            let set = [a, "b=20", "filter=sat-u32"];
            lab.render(&scene, TECHNIQUE, &set)
        });
        let (without, with) = (without?, with?);
        let truth = lab.truth(&scene, &with)?;
        let places = points(&scene, &with);
        let chosen = |at: &dyn Fn(f64, f64) -> bool| -> Vec<usize> {
            let fits = |&i: &usize| {
                let floor = places[i].filter(|p| p.y.abs() < 0.01);
                floor.is_some_and(|p| at(WALL_BACK - p.x, truth.values[i]))
            };
            (0..places.len()).filter(fits).collect()
        };
        let near = chosen(&|behind, truth| behind > 0.0 && behind < CONTACT && truth < 0.5);
        let far = chosen(&|behind, truth| behind > FAR && truth > 0.0 && truth < 1.0);
        let error = |done: &Rendered, i: usize| f64::from(done.visibility[i]) - truth.values[i];
        let both = [&without, &with];
        Ok(Self {
            leak: both.map(|done| mean(near.iter().map(|&i| error(done, i)))),
            contact: both.map(|done| rms(near.iter().map(|&i| error(done, i)))),
            far: both.map(|done| rms(far.iter().map(|&i| error(done, i)))),
            change: rms(far.iter().map(|&i| error(&with, i) - error(&without, i))),
            pixels: [near.len(), far.len()],
        })
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    mean(values.map(|v| v * v)).sqrt()
}

pub(super) fn contact(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let found = Sharpened::new(lab)?;
    let shown = |what: &str, ours| Measure::beside(what, "-", ours, Unit::Number);
    let [near, far] = found.pixels;
    Ok(Finding {
        scene: lab.describe("a thin wall on a floor, lit from the side"),
        counted: format!(
            "float visibility against the exact oracle with A = 30, B = 20 and with A = 0: {near} \
             floor pixels up to {CONTACT} behind the wall whose truth is below 1/2, and {far} in \
             the penumbra from {FAR} behind on. M = 4, views of 512x512, tables in exact integers"
        ),
        measures: vec![
            Measure::new(
                "RMSE at the contact, without over with",
                Theirs::AtLeast(1.0),
                found.contact[0] / found.contact[1],
                Unit::Ratio,
            ),
            Measure::new(
                "change of large penumbrae over their error",
                Theirs::AtMost(0.1),
                found.change / found.far[0],
                Unit::Ratio,
            ),
            shown("contact: mean error without", found.leak[0]),
            shown("contact: mean error with", found.leak[1]),
            shown("large penumbrae: RMSE without", found.far[0]),
            shown("large penumbrae: RMSE with", found.far[1]),
        ],
        reason: "B is of depths over the range of the light view, which is fitted to casters and \
            receivers here: what counts as a contact grows and shrinks with the scene."
            .to_owned(),
        charts: Vec::new(),
    })
}

pub(super) fn banding(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in SCENES {
        let scene = lab.scene(name)?;
        let ours = scored(lab, &scene, TECHNIQUE, &["filter=sat-u32"])?;
        let few = scored(lab, &scene, "pcss", &[])?;
        let row = |what: &str, theirs, other: &Scored| {
            let ratio = other.banding.p99 / ours.banding.p99;
            Measure::new(format!("{name}: {what}"), theirs, ratio, Unit::Ratio)
        };
        measures.push(row(
            "steps of 36 samples over ours",
            Theirs::AtLeast(1.0),
            &few,
        ));
        if lab.settings().full {
            let all = scored(lab, &scene, "pcss", &["sampling=all"])?;
            let beside = Theirs::Beside("-");
            measures.push(row("steps of all texels over ours", beside, &all));
        }
    }
    Ok(Finding {
        scene: lab.describe("parallel-plates, spheres and creature"),
        counted: format!(
            "{STEPS}; PCSS with 16 points that look for blockers and 36 that compare, and, with \
             --full, with every texel; views of 512x512, M = 4, tables in exact integers"
        ),
        measures,
        reason: "Ours has steps of its own, from texels of the light view and from the depth \
            that blockers are averaged to."
            .to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LabSettings;

    /// The series leaks at the contact, and sharpening takes it away there only.
    #[test]
    fn sharpening_is_for_contacts() {
        let settings = LabSettings {
            size: [120, 90],
            ..LabSettings::default()
        };
        let found = Sharpened::new(&mut Lab::new(settings, None)).unwrap();
        let [near, far] = found.pixels;
        assert!(near > 50 && far > 1000, "{near} {far}");
        assert!(found.leak[0] > 0.2 && found.contact[1] < 0.8 * found.contact[0]);
        assert!(found.change < 0.1 * found.far[0]);
    }
}
