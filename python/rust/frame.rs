//! Frames that were rendered.

use std::path::PathBuf;

use gnomon::documents::{RenderDocument, RenderInputs};
use gnomon::pipeline::measure::render::{self as driver, RenderSettings, Rendered};
use gnomon::pipeline::technique::{Params, Technique, Warning};
use gnomon::pipeline::truth::oracle::cache::OracleCache;
use gnomon::pipeline::world::scene;
use numpy::{PyArray2, PyArray3};
use pyo3::prelude::*;

use crate::errors::{raise_render, raise_technique};
use crate::execution::{Execution, Given};
use crate::scene::Scene;
use crate::settings::{GivenTechnique, chosen};
use crate::{arrays, json};

/// A picture, what it was made of, and what it cost.
#[pyclass(frozen, module = "gnomon")]
pub(crate) struct Frame {
    #[pyo3(get)]
    rgba8: Py<PyArray3<u8>>,
    #[pyo3(get)]
    color: Py<PyArray3<f32>>,
    #[pyo3(get)]
    visibility: Py<PyArray2<f32>>,
    #[pyo3(get)]
    depth: Py<PyArray2<f32>>,
    #[pyo3(get)]
    stencil: Py<PyArray2<u8>>,
    #[pyo3(get)]
    time_ms: f64,
    text: String,
}

impl Frame {
    /// Takes the arrays of `done` over; `text` is its document.
    pub(crate) fn new(py: Python<'_>, done: Rendered, text: String) -> PyResult<Self> {
        let size = done.size;
        Ok(Self {
            rgba8: arrays::channels(py, size, done.srgb)?,
            color: arrays::channels(py, size, done.color)?,
            visibility: arrays::image(py, size, done.visibility)?,
            depth: arrays::image(py, size, done.depth)?,
            stencil: arrays::image(py, size, done.stencil)?,
            time_ms: done.frame_ms,
            text,
        })
    }
}

#[pymethods]
impl Frame {
    /// What `gnomon render --json` prints of it.
    #[getter]
    fn document<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::loads(py, &self.text)
    }

    /// What the whole frame counted.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.document(py)?.get_item("totals")
    }

    /// What each pass counted.
    #[getter]
    fn passes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.document(py)?.get_item("passes")
    }

    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.document(py)?.get_item("warnings")
    }

    /// Of picture and visibility, 64 hex digits each.
    #[getter]
    fn hash<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.document(py)?.get_item("hash")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let document = self.document(py)?;
        let of = |key: &str| document.get_item(key)?.str().map(|s| s.to_string());
        Ok(format!(
            "<gnomon.Frame of {} by {}: {}>",
            of("scene")?,
            of("technique")?,
            of("size")?
        ))
    }
}

/// Renders `scene`.
#[pyfunction]
pub(crate) fn render(
    py: Python<'_>,
    scene: &Scene,
    technique: GivenTechnique,
    size: [u32; 2],
    execution: Given,
    repeat: u32,
    cache: Option<PathBuf>,
) -> PyResult<Frame> {
    let (technique, params) = chosen(&technique, execution.3, None)?;
    let execution = Execution::new(execution)?;
    let settings = RenderSettings {
        size,
        gpu: execution.gpu,
        repeat,
    };
    let scene = scene.scene.clone();
    let (done, text) = execution.run(py, || {
        let cache = cache.map(OracleCache::new);
        let done = rendered(&scene, technique, &params, &settings, cache.as_ref())?;
        let text = document(&scene, technique, &params, &settings, &done)?;
        Ok::<_, PyErr>((done, text))
    })?;
    Frame::new(py, done, text)
}

/// Has the technique make ahead what it needs, or read it, if there is a cache, and renders.
pub(crate) fn rendered(
    scene: &scene::Scene,
    technique: &dyn Technique,
    params: &Params,
    settings: &RenderSettings,
    cache: Option<&OracleCache>,
) -> PyResult<Rendered> {
    let ahead = match cache {
        Some(cache) => technique.prepare(scene, params, cache, &|_| {}),
        None => Ok(Vec::new()),
    };
    let ahead = ahead
        .map_err(raise_technique)?
        .into_iter()
        .map(|w| Warning {
            code: "cache",
            count: 1,
            message: w.to_string(),
        });
    let mut done = driver::render(scene, technique, params, settings).map_err(raise_render)?;
    done.warnings.extend(ahead);
    Ok(done)
}

/// What the command line prints of a render.
pub(crate) fn document(
    scene: &scene::Scene,
    technique: &'static dyn Technique,
    params: &Params,
    settings: &RenderSettings,
    done: &Rendered,
) -> PyResult<String> {
    let inputs = RenderInputs {
        scene,
        technique,
        params,
        gpu: settings.gpu,
        repeat: settings.repeat,
        supersample: 1,
    };
    json::text(&RenderDocument::new(inputs, done, Vec::new()))
}
