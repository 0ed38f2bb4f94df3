//! Errors as Python has them: their words are Gnomon's, which say what was met and what
//! would be valid.

use std::error::Error;
use std::io::{self, ErrorKind};

use gnomon::pipeline::measure::render::RenderError;
use gnomon::pipeline::technique::TechniqueError;
use gnomon::raster;
use gnomon::traces::history::HistoryError;
use pyo3::PyErr;
use pyo3::exceptions::{
    PyFileNotFoundError, PyMemoryError, PyOSError, PyPermissionError, PyRuntimeError, PyValueError,
};

/// The exception that `error` is: that of the system where one is its cause, `MemoryError`
/// where memory was short, `RuntimeError` for faults of the program, else `ValueError`.
pub(crate) fn raise(error: impl Error + 'static) -> PyErr {
    let message = error.to_string();
    if let Some(cause) = cause::<io::Error>(&error) {
        return of_system(cause.kind(), message);
    }
    if let Some(raster::Error::OutOfMemory { .. }) = cause(&error) {
        return PyMemoryError::new_err(message);
    }
    if let Some(HistoryError::Broken { .. }) = cause(&error) {
        return PyRuntimeError::new_err(message);
    }
    PyValueError::new_err(message)
}

/// The same of a technique: it hands the GPU's errors on as its own.
pub(crate) fn raise_technique(error: TechniqueError) -> PyErr {
    match error {
        TechniqueError::Gpu(error) => raise(error),
        other => raise(other),
    }
}

/// The same of a render: it hands the GPU's errors on as its own.
pub(crate) fn raise_render(error: RenderError) -> PyErr {
    match error {
        RenderError::Gpu(error) => raise(error),
        RenderError::Technique(error) => raise_technique(error),
    }
}

/// The same of a pixel's history: it hands the GPU's errors on as its own.
pub(crate) fn raise_history(error: HistoryError) -> PyErr {
    match error {
        HistoryError::Gpu(error) => raise(error),
        other => raise(other),
    }
}

/// What the system says of a file, in the words of `message`.
pub(crate) fn of_system(kind: ErrorKind, message: String) -> PyErr {
    match kind {
        ErrorKind::NotFound => PyFileNotFoundError::new_err(message),
        ErrorKind::PermissionDenied => PyPermissionError::new_err(message),
        ErrorKind::OutOfMemory => PyMemoryError::new_err(message),
        _ => PyOSError::new_err(message),
    }
}

/// The first of `error` and its causes that is an `E`.
fn cause<'a, E: Error + 'static>(error: &'a (dyn Error + 'static)) -> Option<&'a E> {
    let mut next = Some(error);
    while let Some(error) = next {
        if let Some(found) = error.downcast_ref() {
            return Some(found);
        }
        next = error.source();
    }
    None
}
