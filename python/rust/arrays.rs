//! Vectors as NumPy arrays: the array takes the vector over, memory and all, and can only be
//! read, since hashes were taken of it.

use numpy::ndarray::Dimension;
use numpy::{Element, IntoPyArray, Ix1, Ix2, Ix3, PyArray, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// `values` as an array of one axis.
pub(crate) fn line<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Py<PyArray<T, Ix1>>> {
    Ok(locked(values.into_pyarray(py))?.unbind())
}

/// A value for each pixel of an image of `size` (width, height): rows, columns.
pub(crate) fn image<T: Element>(
    py: Python<'_>,
    size: [u32; 2],
    values: Vec<T>,
) -> PyResult<Py<PyArray<T, Ix2>>> {
    let [columns, rows] = size.map(|s| s as usize);
    let shaped = values.into_pyarray(py).reshape([rows, columns])?;
    Ok(locked(shaped)?.unbind())
}

/// `N` values for each pixel: rows, columns, channels.
pub(crate) fn channels<T: Element, const N: usize>(
    py: Python<'_>,
    size: [u32; 2],
    values: Vec<[T; N]>,
) -> PyResult<Py<PyArray<T, Ix3>>> {
    let [columns, rows] = size.map(|s| s as usize);
    let flat = values.into_flattened().into_pyarray(py);
    Ok(locked(flat.reshape([rows, columns, N])?)?.unbind())
}

/// A row of `N` values for each entry.
pub(crate) fn rows<T: Element, const N: usize>(
    py: Python<'_>,
    values: Vec<[T; N]>,
) -> PyResult<Py<PyArray<T, Ix2>>> {
    let count = values.len();
    let flat = values.into_flattened().into_pyarray(py);
    Ok(locked(flat.reshape([count, N])?)?.unbind())
}

/// Four values for each entry of a table of `shape` (rows, columns).
pub(crate) fn blocks<T: Element>(
    py: Python<'_>,
    shape: [usize; 2],
    values: Vec<[T; 4]>,
) -> PyResult<Py<PyArray<T, Ix3>>> {
    let flat = values.into_flattened().into_pyarray(py);
    Ok(locked(flat.reshape([shape[0], shape[1], 4])?)?.unbind())
}

/// Bytes as numbers that NumPy calls `kind`, in the shape `shape`.
pub(crate) fn typed(
    py: Python<'_>,
    bytes: Vec<u8>,
    kind: &str,
    shape: Vec<usize>,
) -> PyResult<Py<PyAny>> {
    let bytes: Bound<'_, PyArray1<u8>> = bytes.into_pyarray(py);
    let shaped = bytes
        .call_method1("view", (kind,))?
        .call_method1("reshape", (shape,))?;
    shaped.call_method1("setflags", (false,))?;
    Ok(shaped.unbind())
}

fn locked<'py, T: Element, D: Dimension>(
    array: Bound<'py, PyArray<T, D>>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    array.call_method1("setflags", (false,))?;
    Ok(array)
}
