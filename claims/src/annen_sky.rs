//! Annen et al. 2008, figures 10 and 11: lights fitted to a map beside sampled
//! directions, and beside many shadow maps.

use super::annen::TECHNIQUE;
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use gnomon_pipeline::measure::comparison::RadianceScore;
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::oracle::environment::samples;
use gnomon_pipeline::world::environment::{
    AmbientForm, Environment, FitSettings, LightPlace, MapSettings, SKY,
};
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::environment::place;

/// Directions of the reference; the paper has 1000.
pub(super) const DIRECTIONS: usize = 1024;
/// Shadow maps of brute force.
const MAPS: usize = 500;
/// Moves the directions of brute force off those of the reference.
const SEED: u64 = 2;
/// Size of light views.
const VIEWS: &str = "map-size=256";
/// Largest picture without `--full`: the reference takes a ray a pixel and direction.
const SMALL: [u32; 2] = [128, 96];

/// The statue and the map that lights it.
struct Sky {
    /// Under no lights of its own.
    scene: Scene,
    map: Environment,
    size: [u32; 2],
}

impl Sky {
    fn new(lab: &Lab, scene: &str) -> Result<Self, ReproduceError> {
        Self::under(lab, scene, SKY)
    }

    fn under(lab: &Lab, scene: &str, map: &str) -> Result<Self, ReproduceError> {
        let [width, height] = lab.size();
        Ok(Self {
            scene: lab.scene(scene)?,
            map: Environment::open(map, MapSettings::default())?,
            size: match lab.settings().full {
                true => [width, height],
                false => [width.min(SMALL[0]), height.min(SMALL[1])],
            },
        })
    }

    fn describe(&self) -> String {
        let [width, height] = self.size;
        let (name, faces) = (&self.scene.name, self.scene.triangle_count());
        format!("{name} ({faces} triangles) under the built-in sky, {width}x{height}")
    }

    /// Under so many fitted lights, as published: over their texels, all else ambient light
    /// without direction.
    fn fitted(&self, lights: usize) -> Result<Scene, ReproduceError> {
        self.lit(FitSettings {
            lights,
            place: LightPlace::Texels,
            ambient: AmbientForm::Even,
            ..FitSettings::default()
        })
    }

    fn lit(&self, settings: FitSettings) -> Result<Scene, ReproduceError> {
        let mut scene = self.scene.clone();
        place(&mut scene, &self.map, self.map.fit(&settings)?)?;
        Ok(scene)
    }

    /// `fitted` under a point light for each of many directions instead, as far away.
    fn points(&self, fitted: &Scene, count: usize) -> Scene {
        let mut scene = fitted.clone();
        let Some(placed) = scene.environment.take() else {
            return scene;
        };
        let light = |sample: gnomon_pipeline::truth::oracle::environment::Sample| Light {
            shape: LightShape::Point {
                position: placed.centre + sample.towards * placed.reach,
            },
            colour: sample.energy.map(|e| (e / std::f64::consts::PI) as f32),
        };
        let directions = samples(&self.map.source, count, SEED);
        scene.lights = directions.into_iter().map(light).collect();
        scene.ambient = [0.0; 3];
        scene
    }

    fn score(&self, lab: &mut Lab, done: &Rendered) -> Result<RadianceScore, ReproduceError> {
        // The background of what is placed under the map.
        let scene = self.fitted(30)?;
        let reference = lab.sky(&scene, &self.map, self.size, DIRECTIONS);
        Ok(RadianceScore::measure(reference, done)?)
    }

    fn drawn(&self, lab: &Lab, scene: &Scene, set: &[&str]) -> Result<Rendered, ReproduceError> {
        lab.plain(scene, TECHNIQUE, &[set, &[VIEWS]].concat(), self.size)
    }
}

const COUNTED: &str = "RMSE of linear light in red, green and blue, as a share of the mean of 1024 \
    directions in proportion to the map's luminance with a shadow ray each";

pub(super) fn numbers_of_lights(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    const COUNTS: [usize; 3] = [30, 45, 60];
    let sky = Sky::new(lab, "statue")?;
    let mut found = fitted_lights(lab, &sky, COUNTS)?;
    let maps = real_maps();
    for (name, path) in &maps {
        let under = Sky::under(lab, "statue", path)?;
        let own = fitted_lights(lab, &under, COUNTS)?;
        found
            .measures
            .extend(own.measures.into_iter().map(|m| Measure {
                what: format!("{name}: {}", m.what),
                ..m
            }));
    }
    let count = maps.len();
    found.scene += &format!("; {count} real maps of GNOMON_DATA");
    Ok(found)
}

/// Names and paths of the maps in the folder `env` of the data folder, if there is one.
fn real_maps() -> Vec<(String, String)> {
    let Ok(folder) = std::env::var("GNOMON_DATA") else {
        return Vec::new();
    };
    let entries = std::fs::read_dir(std::path::Path::new(&folder).join("env"));
    let paths = entries
        .into_iter()
        .flatten()
        .filter_map(|e| Some(e.ok()?.path()));
    let named = |path: std::path::PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let is_map = path.extension().is_some_and(|e| e == "hdr" || e == "exr");
        is_map.then_some((name, path.to_str()?.to_owned()))
    };
    let mut maps: Vec<_> = paths.filter_map(named).collect();
    maps.sort();
    maps
}

fn fitted_lights(lab: &mut Lab, sky: &Sky, counts: [usize; 3]) -> Result<Finding, ReproduceError> {
    let mut scores = Vec::new();
    for lights in counts {
        let scene = sky.fitted(lights)?;
        let done = sky.drawn(lab, &scene, &["filter=mip"])?;
        scores.push((lights, sky.score(lab, &done)?));
    }
    let without = lab.plain(&sky.fitted(counts[2])?, "unshadowed", &[], sky.size)?;
    let without = sky.score(lab, &without)?;
    let error = |k: usize| scores[k].1.relative_rmse;
    let between = |k: usize| {
        format!(
            "error of {} lights over that of {}",
            counts[k],
            counts[k - 1]
        )
    };
    let falls = |what, ours| Measure::new(what, Theirs::AtMost(1.0), ours, Unit::Ratio);
    let mut measures = vec![
        falls(between(1), error(1) / error(0)),
        falls(between(2), error(2) / error(1)),
    ];
    for (lights, score) in &scores {
        let row = |what: &str, ours, unit| {
            Measure::beside(format!("{lights} lights: {what}"), "-", ours, unit)
        };
        measures.push(row("RMSE", score.relative_rmse, Unit::Share));
        measures.push(row("FLIP", score.flip, Unit::Number));
    }
    let moved = sky.lit(FitSettings {
        lights: counts[0],
        ..FitSettings::default()
    })?;
    let moved = sky.drawn(lab, &moved, &["filter=mip"])?;
    let moved = sky.score(lab, &moved)?.relative_rmse;
    measures.push(Measure::beside(
        format!(
            "{} lights by moments, ambient light of order 1: RMSE",
            counts[0]
        ),
        "-",
        moved,
        Unit::Share,
    ));
    let without = without.relative_rmse;
    measures.push(Measure::beside(
        "the last without shadows: RMSE",
        "-",
        without,
        Unit::Share,
    ));
    Ok(Finding {
        scene: sky.describe(),
        counted: format!("{COUNTED}; mip chains, light views of 256x256"),
        measures,
        reason: "What lights leave is ambient light without direction or shadow, and a light is \
            shaded from the middle of its texels and not from where their luminance is: more \
            lights need not help. Lights by moments and ambient light of order 1 are nearer."
            .to_owned(),
        charts: Vec::new(),
    })
}

pub(super) fn brute_force(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let sky = Sky::new(lab, "statue")?;
    against_maps(lab, &sky, 30, MAPS)
}

fn against_maps(
    lab: &mut Lab,
    sky: &Sky,
    lights: usize,
    maps: usize,
) -> Result<Finding, ReproduceError> {
    let fitted = sky.fitted(lights)?;
    let mut runs = Vec::new();
    for filter in ["filter=mip", "filter=sat"] {
        let done = sky.drawn(lab, &fitted, &[filter])?;
        runs.push((sky.score(lab, &done)?, done.frame_ms));
    }
    let drawn = lab.plain(&sky.points(&fitted, maps), "shadow-map", &[VIEWS], sky.size)?;
    let (brute, brute_ms) = (sky.score(lab, &drawn)?, drawn.frame_ms);
    let [mip, sat] = [&runs[0], &runs[1]];
    let alike = |what: &str, ours| Measure::new(what, Theirs::Within(0.5, 2.0), ours, Unit::Ratio);
    let slower = |what: &str, ours| Measure::new(what, Theirs::AtLeast(2.0), ours, Unit::Ratio);
    let shown = |what: &str, ours, unit| Measure::beside(what, "-", ours, unit);
    let error = |score: &RadianceScore| score.relative_rmse;
    Ok(Finding {
        scene: sky.describe(),
        counted: format!(
            "{COUNTED}; frame times. Brute force is a shadow map of 256x256 for each of {maps} \
             directions, sampled like those of the reference with another seed"
        ),
        measures: vec![
            alike(
                "error of mip chains over that of many maps",
                error(&mip.0) / error(&brute),
            ),
            alike(
                "error of tables over that of many maps",
                error(&sat.0) / error(&brute),
            ),
            slower("time of many maps over mip chains", brute_ms / mip.1),
            slower("time of many maps over tables", brute_ms / sat.1),
            Measure::new(
                "error of mip chains over that of tables",
                Theirs::None {
                    neutral: 1.0,
                    within: 0.1,
                },
                error(&mip.0) / error(&sat.0),
                Unit::Ratio,
            ),
            shown(
                "fitted lights, mip chains: RMSE",
                error(&mip.0),
                Unit::Share,
            ),
            shown("fitted lights, tables: RMSE", error(&sat.0), Unit::Share),
            shown("many shadow maps: RMSE", error(&brute), Unit::Share),
            shown("fitted lights, mip chains: time", mip.1, Unit::Milliseconds),
            shown("many shadow maps: time", brute_ms, Unit::Milliseconds),
        ],
        reason: "What remains with 30 lights is ambient light without direction or shadow, that \
            each is shaded from its centre and that it flattens its blockers; 500 directions err \
            by their number."
            .to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Judgement, LabSettings};

    fn lab() -> Lab {
        let settings = LabSettings {
            size: [40, 30],
            repeat: 1,
            ..LabSettings::default()
        };
        Lab::new(settings, None)
    }

    fn ours(found: &Finding, what: &str) -> f64 {
        let measure = found.measures.iter().find(|m| m.what.contains(what));
        measure.unwrap_or_else(|| panic!("no {what}")).ours
    }

    /// Shadows are most of the difference, and the figures are of one reference.
    #[test]
    fn fitted_lights_are_nearer_than_lights_without_shadow() {
        let mut lab = lab();
        let sky = Sky::new(&lab, "creature").unwrap();
        let found = fitted_lights(&mut lab, &sky, [2, 8, 24]).unwrap();
        let error = |k: usize| ours(&found, &format!("{k} lights: RMSE"));
        assert!(error(24) < 0.7 * ours(&found, "without shadows"));
        assert!(error(24) < error(2), "{:?}", found.measures);
        let ratio = ours(&found, "error of 24 lights over that of 8");
        assert!((ratio - error(24) / error(8)).abs() < 1e-12);
        assert!(ours(&found, "24 lights: FLIP") < 0.2);
    }

    /// Few maps are further off than many; a claim that few suffice does not hold.
    #[test]
    fn too_few_maps_are_no_match() {
        let mut lab = lab();
        let sky = Sky::new(&lab, "creature").unwrap();
        let mut error = |maps| {
            let found = against_maps(&mut lab, &sky, 12, maps).unwrap();
            (ours(&found, "shadow maps: RMSE"), found.judgement())
        };
        let (few, judged) = error(3);
        let (many, _) = error(64);
        assert!(many < 0.5 * few, "{many} {few}");
        assert_eq!(judged, Judgement::DoesNotHold);
    }
}
