//! A candidate, measured on some frames at a size.

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::technique::{Params, TechniqueError};
use gnomon_pipeline::world::light_image::LightImage;

use super::budget::Figures;
use super::candidates::Candidate;
use super::job::TuneJob;
use crate::error::CliError;
use crate::verbs::bench::Trial;

/// The parameter by which techniques choose lights.
const LIGHT: &str = "light";

/// A size with its frames and their truth.
pub(super) struct Stage<'a> {
    job: &'a TuneJob,
    pub(super) size: [u32; 2],
    /// Numbers of frames, with the truth.
    truths: Vec<(usize, Reference)>,
    /// What went wrong with the folder that keeps truth and preparations.
    pub(super) warnings: Vec<String>,
}

impl<'a> Stage<'a> {
    /// Pictures of a `share` of the width and height, of about as many of the frames.
    pub(super) fn new(job: &'a TuneJob, share: u32) -> Result<Self, CliError> {
        let size = job.size.map(|s| (s / share).max(1));
        let step = share as usize;
        let mut truths = Vec::new();
        for frame in (0..job.frames.len()).step_by(step) {
            let scene = &job.frames[frame];
            let kind = ReferenceKind::Exact;
            let truth = Reference::new(scene, job.light, size, kind, Some(&job.cache), &|| {})?;
            truths.push((frame, truth));
        }
        let warnings = truths.iter().flat_map(|(_, truth)| &truth.warnings);
        Ok(Self {
            warnings: warnings.map(|w| w.to_string()).collect(),
            job,
            size,
            truths,
        })
    }

    /// Pixels of the job's pictures over those of this stage.
    pub(super) fn growth(&self) -> f64 {
        let pixels = |[w, h]: [u32; 2]| f64::from(w) * f64::from(h);
        pixels(self.job.size) / pixels(self.size)
    }

    /// The largest of each figure over the frames; `None` for what is refused, or has no
    /// error.
    pub(super) fn measure(
        &mut self,
        candidate: &Candidate,
        repeat: u32,
    ) -> Result<Option<Figures>, CliError> {
        let params = params(candidate, self.job.light)?;
        let technique = candidate.technique;
        let image = technique.light_image(&params)?;
        let mut figures = Figures::default();
        for (frame, reference) in &self.truths {
            let scene = &self.job.frames[*frame];
            let imaged = self.imaged(*frame, image.as_ref())?;
            // What is refused here the frame refuses too.
            let prepared = technique.prepare(scene, &params, &self.job.cache, &|_| {});
            let prepared = prepared.unwrap_or_default();
            self.warnings.extend(prepared.iter().map(|w| w.to_string()));
            let trial = Trial {
                scene,
                technique,
                params: &params,
                reference: imaged.as_ref().unwrap_or(reference),
                settings: RenderSettings {
                    size: self.size,
                    gpu: self.job.gpu,
                    repeat,
                },
            };
            let measured = match trial.measure() {
                Ok(measured) => measured,
                Err(CliError::Render(_)) => return Ok(None),
                Err(other) => return Err(other),
            };
            let found = &measured.found;
            let (Some(rmse), Some(max)) = (found.rmse, found.max) else {
                return Ok(None);
            };
            figures = figures.or_larger(Figures {
                rmse: rmse.0,
                max: max.0,
                ms: measured.time.whole(),
                bytes: found.bytes as f64,
            });
        }
        Ok(Some(figures))
    }

    /// The truth of a frame under a light with an image.
    fn imaged(
        &self,
        frame: usize,
        image: Option<&LightImage>,
    ) -> Result<Option<Reference>, CliError> {
        if image.is_none() {
            return Ok(None);
        }
        let (scene, light) = (&self.job.frames[frame], (self.job.light, image));
        let (kind, cache) = (ReferenceKind::Exact, Some(&self.job.cache));
        let truth = Reference::with_light_image(scene, light, self.size, kind, cache, &|| {})?;
        Ok(Some(truth))
    }
}

/// All parameters of a candidate under light number `light`.
pub(super) fn params(candidate: &Candidate, light: usize) -> Result<Params, TechniqueError> {
    let technique = candidate.technique;
    let has_lights = technique.params().iter().any(|p| p.name == LIGHT);
    let light = has_lights.then(|| format!("{LIGHT}={light}"));
    let given = candidate.settings.iter().map(|(k, v)| format!("{k}={v}"));
    Params::parse(technique, light.into_iter().chain(given))
}
