//! Chan and Durand, "Rendering Fake Soft Shadows with Smoothies", 2003, by its course
//! notes. Its cylinder on a floor is the built-in one; its flamingo and elephant are not to
//! be had.

use glam::DVec3;
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::truth::metrics::roughness::roughness;
use gnomon_pipeline::world::scene::Scene;

use super::scenes::{TURN, TURNED_EDGE, turned_plate, with_lights_scaled};
use super::tally::counters;
use super::{Claim, Finding, Lab, Measure, ReproduceError, Theirs, Unit, Verdict};

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "smoothies-umbra",
        "Chan and Durand, limits of the method",
        Verdict::Counters,
        "Umbrae stay as large as lights grow, where those of a ray tracer shrink.",
        umbra,
    ),
    Claim::new(
        "smoothies-aliasing",
        "Chan and Durand, results at 256x256 and 1024x1024",
        Verdict::Counters,
        "Edges of a shadow map are jagged at 256x256 and, still, at 1024x1024, where those of \
         smoothies are smooth; bicubic filtering is in between.",
        aliasing,
    ),
    Claim::new(
        "smoothies-cost",
        "Chan and Durand, results at 256x256",
        Verdict::Counters,
        "Percentage-closer filtering with a bicubic kernel takes 16 samples, and considerably \
         more time than smoothies.",
        cost,
    ),
    Claim::quoted(
        "smoothies-samples",
        "Chan and Durand, introduction",
        "Filtering and stochastic sampling need at least 64 samples to be free of noise and \
         bands.",
    ),
];

const TECHNIQUE: &str = "smoothies";

fn umbra(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let set = ["fit=receivers", "map-size=512"];
    let small = with_lights_scaled(lab.scene("cylinder")?, 0.25);
    let large = with_lights_scaled(lab.scene("cylinder")?, 1.0);
    let mut ours = [0.0; 2];
    let mut truth = [0.0; 2];
    for (k, scene) in [small, large].into_iter().enumerate() {
        let done = lab.render(&scene, TECHNIQUE, &set)?;
        let exact = lab.truth(&scene, &done)?;
        // What is turned away is dark in the truth whatever the light.
        let floor = |k: &usize| exact.values[*k].is_finite();
        let pixels = (0..done.visibility.len()).filter(floor);
        ours[k] = done.visibility.iter().filter(|v| **v == 0.0).count() as f64;
        truth[k] = pixels.filter(|k| exact.values[*k] < 1e-6).count() as f64;
    }
    let ratio = |[small, large]: [f64; 2]| large / small.max(1.0);
    Ok(Finding {
        scene: lab.describe("cylinder, a quarter of its light and all of it"),
        counted: "pixels that see nothing of the light".to_owned(),
        measures: vec![
            Measure::new(
                "umbra under the large light over the small one",
                Theirs::None {
                    neutral: 1.0,
                    within: 0.01,
                },
                ratio(ours),
                Unit::Ratio,
            ),
            Measure::new(
                "the same of the exact truth",
                Theirs::AtMost(1.0),
                ratio(truth),
                Unit::Ratio,
            ),
        ],
        reason: "The picture from the light was fitted to smoothies.".to_owned(),
        charts: Vec::new(),
    })
}

/// Width of a strip along an edge, world units.
const STRIP: f64 = 0.004;

/// Roughness of the edge of [`turned_plate`]'s shadow.
fn edge_roughness(
    lab: &Lab,
    scene: &Scene,
    technique: &str,
    set: &[&str],
) -> Result<f64, ReproduceError> {
    let done = lab.render(scene, technique, set)?;
    let [width, height] = done.size;
    let rays = scene.camera.eye_rays(width, height);
    let edge = DVec3::new(libm::cos(TURN), 0.0, -libm::sin(TURN));
    let values = done.visibility.iter().enumerate().filter_map(|(k, seen)| {
        let pixel = [k as u32 % width, k as u32 / width].map(|c| f64::from(c) + 0.5);
        let ray = rays.direction(pixel[0], pixel[1]);
        let at = rays.origin - ray * (rays.origin.y / ray.y);
        let distance = at.dot(edge) - TURNED_EDGE;
        let along = at.dot(edge.cross(DVec3::Y));
        let near = along.abs() < 0.8 && (-0.16..0.48).contains(&distance);
        near.then_some([distance, f64::from(*seen)])
    });
    Ok(roughness(values, STRIP))
}

fn aliasing(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = turned_plate()?;
    let mut found = [[0.0; 3]; 2];
    for (k, size) in ["map-size=256", "map-size=1024"].into_iter().enumerate() {
        let of = |technique: &str, more: &[&str]| {
            let set = [more, &["fit=receivers", size]].concat();
            edge_roughness(lab, &scene, technique, &set)
        };
        found[k] = [
            of("shadow-map", &[])?,
            of("pcf", &["kernel=bicubic"])?,
            of(TECHNIQUE, &[])?,
        ];
    }
    let [coarse, fine] = found;
    let smoother = |what: &str, rough: f64, smooth: f64| {
        Measure::new(what, Theirs::AtLeast(1.0), rough / smooth, Unit::Ratio)
    };
    let plain = |what: &str, ours: f64| Measure::new(what, Theirs::Beside("-"), ours, Unit::Number);
    Ok(Finding {
        scene: lab.describe("a plate's straight shadow edge, turned against the map"),
        counted: "roughness: by how much visibility differs along the edge, root mean square"
            .to_owned(),
        measures: vec![
            smoother("256: shadow map over bicubic filter", coarse[0], coarse[1]),
            smoother("256: shadow map over smoothies", coarse[0], coarse[2]),
            smoother("1024: shadow map over smoothies", fine[0], fine[2]),
            smoother("1024: bicubic filter over smoothies", fine[1], fine[2]),
            plain("256: smoothies", coarse[2]),
            plain("1024: smoothies", fine[2]),
        ],
        reason: "Texels of the map are much smaller than pixels.".to_owned(),
        charts: Vec::new(),
    })
}

fn cost(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("cylinder")?;
    let [soft, cubic] = lab.race(
        &scene,
        [
            (TECHNIQUE, &["map-size=256"][..]),
            ("pcf", &["kernel=bicubic", "map-size=256"]),
        ],
    )?;
    let fetches = |done| {
        let looked = counters(done, &[PassRole::LookUp]);
        looked.traffic.tex_fetches[1..4].iter().sum::<u64>() as f64
    };
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "API-level fetches of the pass `look-up` beyond positions and planes; whole \
            frames"
            .to_owned(),
        measures: vec![
            Measure::new(
                "fetches, bicubic filtering over smoothies",
                Theirs::AtLeast(3.0),
                fetches(&cubic) / fetches(&soft),
                Unit::Ratio,
            ),
            Measure::new(
                "time, bicubic filtering over smoothies",
                Theirs::AtLeast(1.0),
                cubic.frame_ms / soft.frame_ms,
                Unit::Ratio,
            ),
        ],
        reason: "Pictures of surfaces and smoothies cost more here than 13 look-ups fewer gain."
            .to_owned(),
        charts: Vec::new(),
    })
}
