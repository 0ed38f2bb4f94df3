//! The half of the Python package `gnomon` that is Rust: what takes time, and arrays.
//!
//! It is small on purpose. Arguments come checked from `src/gnomon/`, which is what users
//! see; here they are used, with Python's lock given back, and results leave as arrays that
//! take over the memory of the vectors that they were, or as the text of the documents that
//! the command line prints.

mod accesses;
mod arrays;
mod comparison;
mod errors;
mod execution;
mod frame;
mod history;
mod json;
mod replay;
mod scene;
mod settings;
mod trace;
mod truth;

/// The native half of the package; everything public is in `gnomon`.
#[pyo3::pymodule]
mod _gnomon {
    #[pymodule_export]
    use crate::comparison::compare;
    #[pymodule_export]
    use crate::frame::{Frame, render};
    #[pymodule_export]
    use crate::replay::Replay;
    #[pymodule_export]
    use crate::scene::{Scene, SceneObject, scenes};
    #[pymodule_export]
    use crate::settings::techniques;
    #[pymodule_export]
    use crate::trace::{Trace, profiles, record};
    #[pymodule_export]
    use crate::truth::{Truth, truth};

    /// Most pixels on a side of a picture.
    #[pymodule_export]
    const MAX_SIZE: u32 = gnomon::raster::MAX_TEXTURE_SIZE;
    /// Most threads.
    #[pymodule_export]
    const MAX_THREADS: usize = gnomon::raster::MAX_THREADS;
    /// The version of Gnomon.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
