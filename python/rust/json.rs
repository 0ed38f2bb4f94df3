//! Documents as Python's own dictionaries, by way of their text: so they are, to the key and
//! the digit, what the command line prints.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::Serialize;

/// A document's text.
pub(crate) fn text(document: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(document).map_err(|e| PyRuntimeError::new_err(e.to_string()))
}

/// The dictionaries and lists that `text` stands for; made afresh, so that whoever changes
/// them changes nothing here.
pub(crate) fn loads<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}
