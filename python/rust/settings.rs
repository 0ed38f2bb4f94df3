//! Techniques and their settings.

use gnomon::documents::TechniquesDocument;
use gnomon::pipeline::technique::{Params, Technique};
use gnomon::pipeline::techniques::{Registry, find};
use pyo3::prelude::*;

use crate::errors::raise;
use crate::json;

/// A technique by name, and settings `key=value`.
pub(crate) type GivenTechnique = (String, Vec<String>);

/// What `gnomon techniques --json` lists.
#[pyfunction]
pub(crate) fn techniques(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let document = TechniquesDocument::new(Registry::built_in().all());
    json::loads(py, &json::text(&document)?)
}

/// A technique, and its parameters with what was given. Without `skip`, techniques that can
/// leave work out themselves do not, unless told otherwise. Techniques that choose among
/// lights are told `light`, if there is one.
pub(crate) fn chosen(
    (name, settings): &GivenTechnique,
    skip: bool,
    light: Option<usize>,
) -> PyResult<(&'static dyn Technique, Params)> {
    let technique = find(name).map_err(raise)?;
    let has = |name: &str| technique.params().iter().any(|p| p.name == name);
    let mut given = Vec::new();
    if !skip && has("skip") {
        given.push("skip=off".to_owned());
    }
    if let Some(light) = light.filter(|_| has("light")) {
        given.push(format!("light={light}"));
    }
    given.extend(settings.iter().cloned());
    let params = Params::parse(technique, given).map_err(raise)?;
    Ok((technique, params))
}
