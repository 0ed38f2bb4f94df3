//! Techniques beside the truth.

use std::path::PathBuf;
use std::str::FromStr as _;
use std::time::Instant;

use gnomon::documents::{CompareDocument, CompareInputs, ResultDocument};
use gnomon::pipeline::measure::comparison::{
    Aligned, Origin, Reference, ReferenceKind, Score, ShadingKey, shaded,
};
use gnomon::pipeline::measure::render::{RenderSettings, Rendered};
use gnomon::pipeline::technique::{Params, Technique};
use gnomon::pipeline::truth::oracle::cache::OracleCache;
use gnomon::pipeline::world::light_image::LightImage;
use gnomon::pipeline::world::scene;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{raise, raise_render, raise_technique};
use crate::execution::{Execution, Given};
use crate::frame::{Frame, document, rendered};
use crate::json;
use crate::scene::Scene;
use crate::settings::{GivenTechnique, chosen};
use crate::truth::Truth;

/// The document as text, a frame for each technique, the truth.
type Compared = (String, Vec<Frame>, Truth);

/// Renders `techniques` and holds them against the truth about one light.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python hands them over by name")]
pub(crate) fn compare(
    py: Python<'_>,
    scene: &Scene,
    techniques: Vec<GivenTechnique>,
    light: usize,
    size: [u32; 2],
    reference: &str,
    execution: Given,
    repeat: u32,
    cache: Option<PathBuf>,
) -> PyResult<Compared> {
    let kind = ReferenceKind::from_str(reference).map_err(raise)?;
    let entries = techniques
        .iter()
        .map(|t| chosen(t, execution.3, Some(light)));
    let entries = entries.collect::<PyResult<Vec<_>>>()?;
    let image = common_image(&entries)?;
    let execution = Execution::new(execution)?;
    let mut work = Work {
        scene: &scene.scene,
        settings: RenderSettings {
            size,
            gpu: execution.gpu,
            repeat,
        },
        cache: cache.map(OracleCache::new),
        pictures: Vec::new(),
    };
    let (text, frames, reference) =
        execution.run(py, || work.all(&entries, (light, image.as_ref()), kind))?;
    let frames = frames.into_iter();
    let frames = frames.map(|(done, text)| Frame::new(py, done, text));
    let frames = frames.collect::<PyResult<Vec<_>>>()?;
    Ok((text, frames, Truth::new(py, reference)?))
}

/// The same before Python has it.
type Done = (String, Vec<(Rendered, String)>, Reference);
type Entry = (&'static dyn Technique, Params);

/// The image that is on the light for all techniques: under another one another truth holds.
fn common_image(entries: &[Entry]) -> PyResult<Option<LightImage>> {
    let mut common = None;
    for (number, (technique, params)) in entries.iter().enumerate() {
        let image = technique.light_image(params).map_err(raise_technique)?;
        if number > 0 && image != common {
            return Err(PyValueError::new_err(format!(
                "light-image of '{}' is not that of '{}'; valid is the same image on the light \
                 for all techniques compared",
                technique.name(),
                entries[0].0.name(),
            )));
        }
        common = image;
    }
    Ok(common)
}

struct Work<'a> {
    scene: &'a scene::Scene,
    settings: RenderSettings,
    cache: Option<OracleCache>,
    /// Pictures of the truth, by how they are shaded.
    pictures: Vec<(ShadingKey, Vec<[u8; 4]>)>,
}

impl Work<'_> {
    fn all(
        &mut self,
        entries: &[Entry],
        light: (usize, Option<&LightImage>),
        kind: ReferenceKind,
    ) -> PyResult<Done> {
        let (size, cache) = (self.settings.size, self.cache.as_ref());
        let start = Instant::now();
        let reference = Reference::with_light_image(self.scene, light, size, kind, cache, &|| {});
        let reference = reference.map_err(raise)?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let (mut results, mut frames) = (Vec::new(), Vec::new());
        for (technique, params) in entries {
            let (done, score) = self.measured(*technique, params, &reference)?;
            results.push(ResultDocument::new(*technique, params, &done, &score));
            let text = document(self.scene, *technique, params, &self.settings, &done)?;
            frames.push((done, text));
        }
        let inputs = CompareInputs {
            scene: self.scene,
            settings: self.settings,
            reference_ms: (reference.origin == Origin::Computed).then_some(ms),
        };
        let text = json::text(&CompareDocument::new(
            inputs,
            &reference,
            results,
            Vec::new(),
        ))?;
        Ok((text, frames, reference))
    }

    fn measured(
        &mut self,
        technique: &'static dyn Technique,
        params: &Params,
        reference: &Reference,
    ) -> PyResult<(Rendered, Score)> {
        let cache = self.cache.as_ref();
        let mut done = rendered(self.scene, technique, params, &self.settings, cache)?;
        let under = reference.under(&done.depth).map_err(raise)?;
        let picture = self.picture(params, reference, &under)?;
        let score = Score::measure(&under, &done, picture).map_err(raise)?;
        done.warnings.extend(score.pixels.warning());
        Ok((done, score))
    }

    /// The picture that the truth gives where it is shaded like this; made once.
    fn picture(
        &mut self,
        params: &Params,
        reference: &Reference,
        under: &Aligned,
    ) -> PyResult<&[[u8; 4]]> {
        let key = ShadingKey::of(params);
        let at = match self.pictures.iter().position(|(k, _)| *k == key) {
            Some(at) => at,
            None => {
                let made = shaded(self.scene, reference, under, params, &self.settings);
                self.pictures.push((key, made.map_err(raise_render)?));
                self.pictures.len() - 1
            }
        };
        Ok(&self.pictures[at].1)
    }
}
