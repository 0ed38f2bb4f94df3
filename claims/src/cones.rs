//! Bavoil and Silva, "Real-Time Soft Shadows with Cone Culling", 2006.
//!
//! Its wireframe and opaque models are not named; ours are the built-in `wireframe`, a ball
//! of 1,920 wires, and `creature` under a sphere.

use glam::DVec3;
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::scene::Scene;

use super::tally::counters;
use super::{Claim, Finding, Lab, Measure, ReproduceError, Theirs, Unit, Verdict};

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "cone-culling-samples",
        "Bavoil and Silva, figure 1",
        Verdict::Arithmetic,
        "88 samples a pixel are looked up, whatever the scene.",
        samples,
    ),
    Claim::new(
        "cone-culling-overlap",
        "Bavoil and Silva, abstract and §3",
        Verdict::Counters,
        "Results compare favourably to ray tracing where shadows do not overlap; where they \
         do, light leaks.",
        overlap,
    ),
    Claim::new(
        "cone-culling-umbra",
        "Bavoil and Silva, §3",
        Verdict::Counters,
        "Bounding spheres make umbrae too large.",
        umbra,
    ),
    Claim::new(
        "cone-culling-time",
        "Bavoil and Silva, figure 1",
        Verdict::Times,
        "On a CPU, cone culling by an octree takes 5.0 s, ray tracing with 1,000 shadow rays a \
         pixel 7.38 min: 88.6 times as long.",
        time,
    ),
    Claim::quoted(
        "cone-culling-frame-rates",
        "Bavoil and Silva, figure 1",
        "GeForce 7800 GTX, 800x600, shadow map of 1024x1024: 15.2 fps for a wireframe model, \
         15.8 fps for an opaque one.",
    ),
];

const TECHNIQUE: &str = "cone-culling";

/// A built-in scene under a sphere in the place of its first light.
fn under_a_sphere(lab: &Lab, name: &str, radius: f64) -> Result<Scene, ReproduceError> {
    let mut scene = lab.scene(name)?;
    let centre = match &scene.lights[0].shape {
        LightShape::Rectangle { centre, .. } | LightShape::Sphere { centre, .. } => *centre,
        _ => DVec3::new(1.5, 5.0, 1.0),
    };
    scene.lights.truncate(1);
    scene.lights[0].shape = LightShape::Sphere { centre, radius };
    scene.name = format!("{name} under a sphere");
    Ok(scene)
}

fn samples(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["wireframe", "creature"] {
        let scene = under_a_sphere(lab, name, 0.25)?;
        let done = lab.render(&scene, TECHNIQUE, &["map-size=128"])?;
        let looked = counters(&done, &[PassRole::LookUp]);
        let receivers = done.visibility.iter().filter(|v| !v.is_nan()).count();
        measures.push(Measure::new(
            format!("{name}: patches looked up a receiver"),
            Theirs::Exactly(88.0),
            looked.traffic.tex_fetches[1] as f64 / receivers as f64,
            Unit::Count,
        ));
    }
    Ok(Finding {
        scene: lab.describe("wireframe and creature under a sphere"),
        counted: "API-level fetches of patches, 16 bytes each, over pixels that show a surface"
            .to_owned(),
        measures,
        reason: "Some surfaces took no shadow.".to_owned(),
        charts: Vec::new(),
    })
}

/// With rectangles, found by the tree: what is left is the method's own error.
const EXACT: [&str; 2] = ["method=octree", "map-size=256"];

fn overlap(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut error = |name: &str| -> Result<f64, ReproduceError> {
        let scene = under_a_sphere(lab, name, 0.4)?;
        let done = lab.render(&scene, TECHNIQUE, &EXACT)?;
        Ok(lab.score(&scene, &done)?.error.rmse)
    };
    let (apart, overlapping) = (error("parallel-plates")?, error("overlap")?);
    Ok(Finding {
        scene: lab.describe("parallel-plates and overlap under a sphere"),
        counted: "visibility against the exact truth, root mean square".to_owned(),
        measures: vec![
            Measure::beside("one plate: RMSE", "-", apart, Unit::Number),
            Measure::beside("crossing bars: RMSE", "-", overlapping, Unit::Number),
            Measure::new(
                "crossing bars over one plate",
                Theirs::AtLeast(1.0),
                overlapping / apart,
                Unit::Ratio,
            ),
        ],
        reason: "Patches behind each other were not summed twice.".to_owned(),
        charts: Vec::new(),
    })
}

fn umbra(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = under_a_sphere(lab, "parallel-plates", 0.25)?;
    let exact = lab.render(&scene, TECHNIQUE, &EXACT)?;
    let truth = lab.truth(&scene, &exact)?.values;
    // Where the truth is known under the picture.
    let dark = |values: &mut dyn Iterator<Item = f64>| {
        let known = values.zip(&truth).filter(|(_, t)| !t.is_nan());
        known.filter(|(v, _)| *v < 0.02).count() as f64
    };
    let by = |lab: &Lab, form: &str| -> Result<f64, ReproduceError> {
        let done = lab.render(&scene, TECHNIQUE, &[&EXACT[..], &[form]].concat())?;
        Ok(dark(&mut done.visibility.iter().map(|v| f64::from(*v))))
    };
    let spheres = by(lab, "patches=spheres")?;
    let rectangles = by(lab, "patches=rectangles")?;
    let known = dark(&mut truth.iter().copied());
    Ok(Finding {
        scene: lab.describe("parallel-plates under a sphere"),
        counted: "pixels that see less than 2% of the light".to_owned(),
        measures: vec![
            Measure::new(
                "umbra by spheres over that by rectangles",
                Theirs::AtLeast(1.05),
                spheres / rectangles.max(1.0),
                Unit::Ratio,
            ),
            Measure::beside(
                "umbra by rectangles over the exact truth's",
                "-",
                rectangles / known.max(1.0),
                Unit::Ratio,
            ),
        ],
        reason: "Spheres' solid angles were not larger than patches'.".to_owned(),
        charts: Vec::new(),
    })
}

fn time(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("wireframe")?;
    let [cones, rays] = lab.race(
        &scene,
        [
            (TECHNIQUE, &["method=octree", "map-size=1024"][..]),
            ("ray-traced", &["samples=1024"]),
        ],
    )?;
    Ok(Finding {
        scene: lab.describe("wireframe"),
        counted: "whole frames, on one machine; 1,024 shadow rays a pixel in place of 1,000"
            .to_owned(),
        measures: vec![
            Measure::beside("by the tree", "5.0 s", cones.frame_ms, Unit::Milliseconds),
            Measure::beside(
                "by 1,024 rays",
                "7.38 min",
                rays.frame_ms,
                Unit::Milliseconds,
            ),
            Measure::new(
                "rays over cones",
                Theirs::Effect {
                    low: 88.6,
                    high: 88.6,
                    neutral: 1.0,
                    slack: super::SLACK,
                },
                rays.frame_ms / cones.frame_ms,
                Unit::Ratio,
            ),
        ],
        reason: "Rays and the tree are both gone through for 16 pixels at a time, through \
            hierarchies in textures."
            .to_owned(),
        charts: Vec::new(),
    })
}
