//! Techniques along an axis, measured.

use gnomon_raster::GpuConfig;

use super::axis::Axis;
use super::place::place;
use crate::measure::comparison::{Reference, ReferenceKind};
use crate::measure::render::{RenderSettings, Rendered, render};
use crate::technique::{Params, Technique, TechniqueError};
use crate::truth::metrics::visibility::VisibilityError;
use crate::world::scene::Scene;

/// A technique with settings.
#[derive(Clone)]
pub struct Candidate {
    /// The technique.
    pub technique: &'static dyn Technique,
    /// What is not at its default, as `key=value`.
    pub settings: Vec<String>,
}

impl Candidate {
    /// Checked.
    ///
    /// # Errors
    /// A setting that the technique does not have, or not so.
    pub fn new(
        technique: &'static dyn Technique,
        settings: &[String],
    ) -> Result<Self, TechniqueError> {
        Params::parse(technique, settings)?;
        Ok(Self {
            technique,
            settings: settings.to_vec(),
        })
    }

    /// Its name with its settings, as the command line writes it.
    #[must_use]
    pub fn label(&self) -> String {
        let settings = self.settings.iter().map(|s| format!(":{s}"));
        self.technique.name().to_owned() + &settings.collect::<String>()
    }

    fn has(&self, name: &str) -> bool {
        self.technique.params().iter().any(|p| p.name == name)
    }

    /// Its settings along `axis`, for light number `light`. `None` where it has not what the
    /// axis is about.
    fn params(&self, axis: &Axis, light: usize) -> Option<Result<Params, TechniqueError>> {
        let mut given = Vec::new();
        if self.has("light") {
            given.push(format!("light={light}"));
        }
        given.extend(self.settings.iter().cloned());
        if let Some((name, value)) = axis.setting() {
            if !self.has(name) {
                return None;
            }
            given.push(format!("{name}={value}"));
        }
        Some(Params::parse(self.technique, given))
    }
}

/// A scene and how to draw it.
#[derive(Clone, Copy)]
pub struct Stress<'a> {
    /// The scene at rest.
    pub scene: &'a Scene,
    /// The light that shines, by its number.
    pub light: usize,
    /// Width and height of pictures.
    pub size: [u32; 2],
    /// How the emulated GPU executes.
    pub gpu: GpuConfig,
}

/// Candidates along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What was varied.
    pub axis: Axis,
    /// Names of the candidates.
    pub candidates: Vec<String>,
    /// One for each value of the axis, in their order.
    pub points: Vec<Point>,
}

/// Candidates at a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The value.
    pub value: f64,
    /// One for each candidate; what is left of the scene, in words, where there is none.
    pub outcomes: Result<Vec<Outcome>, String>,
}

/// A candidate at a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It drew a picture.
    Measured(Measured),
    /// It, or the GPU, refused, and said why.
    Refused(String),
    /// It does not have what the axis is about.
    DoesNotApply,
}

/// A picture beside the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Root mean square of the error of visibility; NaN where nothing can be compared.
    pub rmse: f64,
    /// Its largest magnitude, or NaN.
    pub max: f64,
    /// Share of pixels with surfaces that picture and truth have in common.
    pub compared: f64,
    /// Pixels whose visibility is not in 0..=1, or no number on a surface.
    pub insane: usize,
    /// Codes of what was warned of.
    pub warnings: Vec<&'static str>,
}

impl Stress<'_> {
    /// Measures `candidates` at all values of `axis`. `done` is told of each value that is.
    pub fn curve(
        &self,
        axis: &Axis,
        candidates: &[Candidate],
        done: &mut dyn FnMut(&Axis, f64),
    ) -> Curve {
        let point = |value: &f64| {
            let point = self.point(axis, *value, candidates);
            done(axis, *value);
            point
        };
        Curve {
            axis: axis.clone(),
            candidates: candidates.iter().map(Candidate::label).collect(),
            points: axis.values.iter().map(point).collect(),
        }
    }

    fn point(&self, axis: &Axis, value: f64, candidates: &[Candidate]) -> Point {
        let outcomes = self.at(axis, value).map(|(placed, truth)| {
            let drawn = |c: &Candidate| match c.params(axis, self.light) {
                None => Outcome::DoesNotApply,
                Some(Err(refused)) => Outcome::Refused(refused.to_string()),
                Some(Ok(params)) => self.draw(&placed, c.technique, &params, &truth),
            };
            candidates.iter().map(drawn).collect()
        });
        Point { value, outcomes }
    }

    /// The scene there, and the truth of it.
    fn at(&self, axis: &Axis, value: f64) -> Result<(Scene, Reference), String> {
        let placed = place(self.scene, self.light, axis, value)?;
        let exact = ReferenceKind::Exact;
        let truth = Reference::new(&placed, self.light, self.size, exact, None, &|| ());
        let truth = truth.map_err(|e| e.to_string())?;
        Ok((placed, truth))
    }

    fn draw(
        &self,
        scene: &Scene,
        technique: &dyn Technique,
        params: &Params,
        truth: &Reference,
    ) -> Outcome {
        let settings = RenderSettings {
            size: self.size,
            gpu: self.gpu,
            repeat: 1,
        };
        match render(scene, technique, params, &settings) {
            Ok(done) => compare(&done, truth).unwrap_or_else(Outcome::Refused),
            Err(refused) => Outcome::Refused(refused.to_string()),
        }
    }
}

fn compare(done: &Rendered, truth: &Reference) -> Result<Outcome, String> {
    let under = truth.under(&done.depth).map_err(|e| e.to_string())?;
    // Left out on both sides where the truth has nothing to say: outlines.
    let pairs = done.visibility.iter().zip(&under.truth.values);
    let seen: Vec<f32> = pairs
        .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
        .collect();
    let error = VisibilityError::measure(&under.truth, done.size, &seen);
    let error = error.map_err(|e| e.to_string())?;
    let surfaces = done.depth.iter().filter(|d| **d < 1.0).count();
    let insane = done.depth.iter().zip(&done.visibility);
    let insane = insane.filter(|(d, v)| **d < 1.0 && !(0.0..=1.0).contains(*v));
    Ok(Outcome::Measured(Measured {
        rmse: error.all.map_or(f64::NAN, |e| e.rmse),
        max: error.all.map_or(f64::NAN, |e| e.max),
        compared: error.all.map_or(0, |e| e.pixels) as f64 / surfaces.max(1) as f64,
        insane: insane.count(),
        warnings: done.warnings.iter().map(|w| w.code).collect(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques;
    use crate::world::scene::builtin;

    /// Visibility below 0, above 1 and none on surfaces is counted; none where there is no
    /// surface is as it should be.
    #[test]
    fn what_is_insane_is_counted() {
        let scene = builtin::build("cylinder").unwrap();
        let size = [32, 24];
        let truth = Reference::new(&scene, 0, size, ReferenceKind::Exact, None, &|| ()).unwrap();
        let technique = techniques::find("unshadowed").unwrap();
        let settings = RenderSettings {
            size,
            ..RenderSettings::default()
        };
        let params = Params::defaults(technique);
        let mut done = render(&scene, technique, &params, &settings).unwrap();
        let insane = |done: &Rendered| match compare(done, &truth).unwrap() {
            Outcome::Measured(m) => m.insane,
            other => panic!("{other:?}"),
        };
        assert_eq!(insane(&done), 0);
        assert!(done.visibility.iter().any(|v| v.is_nan()));
        let surfaces = (0..done.depth.len()).filter(|k| done.depth[*k] < 1.0);
        let places: Vec<usize> = surfaces.take(5).collect();
        for (k, value) in places
            .into_iter()
            .zip([-0.1, 1.1, f32::NAN, f32::INFINITY, 1.0])
        {
            done.visibility[k] = value;
        }
        assert_eq!(insane(&done), 4);
    }
}
