//! The truth about a light.

use std::path::PathBuf;
use std::str::FromStr as _;

use gnomon::pipeline::measure::comparison::{Origin, Reference, ReferenceKind};
use gnomon::pipeline::truth::oracle::cache::OracleCache;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::raise;
use crate::execution::{Execution, Given};
use crate::scene::Scene;

/// Visibility of a light as an oracle finds it.
#[pyclass(frozen, module = "gnomon")]
pub(crate) struct Truth {
    #[pyo3(get)]
    visibility: Py<PyArray2<f64>>,
    #[pyo3(get)]
    light: usize,
    #[pyo3(get)]
    soft: bool,
    #[pyo3(get)]
    cached: bool,
    #[pyo3(get)]
    warnings: Vec<String>,
    kind: ReferenceKind,
}

impl Truth {
    pub(crate) fn new(py: Python<'_>, reference: Reference) -> PyResult<Self> {
        let image = reference.image;
        Ok(Self {
            visibility: arrays::image(py, image.size, image.values)?,
            light: reference.light,
            soft: reference.is_soft,
            cached: reference.origin == Origin::Read,
            warnings: reference.warnings.iter().map(ToString::to_string).collect(),
            kind: reference.kind,
        })
    }
}

#[pymethods]
impl Truth {
    /// The oracle that was asked.
    #[getter]
    fn reference(&self) -> &'static str {
        self.kind.name()
    }

    fn __repr__(&self) -> String {
        let kind = self.kind.name();
        let what = if self.soft { "soft" } else { "hard" };
        format!("<gnomon.Truth of light {}: {kind}, {what}>", self.light)
    }
}

/// Asks the oracle `reference`.
#[pyfunction]
pub(crate) fn truth(
    py: Python<'_>,
    scene: &Scene,
    light: usize,
    size: [u32; 2],
    reference: &str,
    threads: usize,
    cache: Option<PathBuf>,
) -> PyResult<Truth> {
    let kind = ReferenceKind::from_str(reference).map_err(raise)?;
    let execution = Execution::new(any(threads))?;
    let scene = scene.scene.clone();
    let found = execution.run(py, || {
        let cache = cache.map(OracleCache::new);
        Reference::new(&scene, light, size, kind, cache.as_ref(), &|| {})
    });
    Truth::new(py, found.map_err(raise)?)
}

/// So many threads, and a GPU that is not used.
fn any(threads: usize) -> Given {
    (threads, 64, "auto".to_owned(), true)
}
