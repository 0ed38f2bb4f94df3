//! Paper I's figure 12: one scene under lights of growing size.

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::scene::Scene;

use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper1-light-size",
    "paper I, §7, figure 12",
    Verdict::Counters,
    "The larger the light, the smaller the umbra; shadows are softer farther from what casts \
     them.",
    light_size,
)
.read_from(&[Lines::one(762), Lines::one(842)])];

/// Radii of the light, as far as pots and letters leave an umbra.
const RADII: [f64; 4] = [0.05, 0.15, 0.3, 0.6];

fn with_radius(scene: &Scene, to: f64) -> Scene {
    let mut scene = scene.clone();
    for light in &mut scene.lights {
        if let LightShape::Sphere { radius, .. } = &mut light.shape {
            *radius = to;
        }
    }
    scene
}

/// Pixels in full shadow, and those between.
fn shadows(done: &Rendered) -> [f64; 2] {
    let dark = done.visibility.iter().filter(|v| **v <= 0.0).count();
    let between = (done.visibility.iter()).filter(|v| **v > 0.0 && **v < 1.0);
    [dark as f64, between.count() as f64]
}

/// The greatest of `next / before` of neighbours.
fn greatest_step(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|w| w[1] / w[0].max(1.0));
    steps.fold(0.0, f64::max)
}

fn light_size(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("eg-logo")?;
    let mut found = Vec::new();
    for radius in RADII {
        let scene = with_radius(&scene, radius);
        found.push(shadows(&lab.render(&scene, "penumbra-wedges", &[])?));
    }
    let of = |k: usize| found.iter().map(|f| f[k]).collect::<Vec<f64>>();
    let (dark, between) = (of(0), of(1));
    let shrinking: Vec<f64> = between.iter().rev().copied().collect();
    let mut measures = vec![
        Measure::new(
            "umbra, the next size over the one before, at most",
            Theirs::AtMost(1.0),
            greatest_step(&dark),
            Unit::Ratio,
        ),
        Measure::new(
            "penumbra, the size before over the next, at most",
            Theirs::AtMost(1.0),
            greatest_step(&shrinking),
            Unit::Ratio,
        ),
    ];
    for (k, radius) in RADII.iter().enumerate() {
        let pixels = |what: &str, n: f64| {
            Measure::beside(
                format!("radius {radius}: pixels in {what}"),
                "-",
                n,
                Unit::Count,
            )
        };
        measures.push(pixels("umbra", dark[k]));
        measures.push(pixels("penumbra", between[k]));
    }
    Ok(Finding {
        scene: lab.describe("eg-logo, spheres of four radii"),
        counted: "pixels of visibility 0, and between 0 and 1, by penumbra wedges".to_owned(),
        measures,
        reason: "The scene is ours; only the letters and the balls cast, as in the paper's."
            .to_owned(),
        charts: Vec::new(),
    })
}
