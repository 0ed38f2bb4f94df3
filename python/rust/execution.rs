//! How work is executed; none of it changes a bit of a result.

use std::error::Error as _;

use gnomon::raster::simd::UnknownSimdLevel;
use gnomon::raster::{GpuConfig, MAX_THREADS, SimdLevel};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::raise;

/// Threads (0 for one per core), side of tiles, instruction set, whether zmin/zmax skip work.
pub(crate) type Given = (usize, u32, String, bool);

/// The variable by which people choose the number of threads.
const VARIABLE: &str = "RAYON_NUM_THREADS";
/// Bytes of a worker's stack: kernels have large frames, less in release.
const STACK: usize = 8 << 20;

/// Threads of a call's own, and the GPU's settings. A pool for each call costs less than a
/// millisecond, holds back nothing that runs beside it, and survives the fork of a process,
/// as the threads of a common one would not.
pub(crate) struct Execution {
    pub(crate) gpu: GpuConfig,
    pool: ThreadPool,
}

impl Execution {
    pub(crate) fn new((threads, tile, simd, skip): Given) -> PyResult<Self> {
        let simd: SimdLevel = simd.parse().map_err(|e: UnknownSimdLevel| raise(e))?;
        check_variable(threads)?;
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .stack_size(STACK);
        let pool = pool.build().map_err(|e| {
            let cause = e.source().map(|s| format!(": {s}")).unwrap_or_default();
            PyOSError::new_err(format!("threads cannot be started: {e}{cause}"))
        })?;
        let gpu = GpuConfig {
            threads: pool.current_num_threads().min(MAX_THREADS),
            tile,
            simd,
            skip,
        };
        Ok(Self { gpu, pool })
    }

    /// Runs `work` on these threads, while Python goes on.
    pub(crate) fn run<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
        py.detach(|| self.pool.install(work))
    }
}

/// More threads than the GPU takes would be started without a limit.
fn check_variable(threads: usize) -> PyResult<()> {
    let value = std::env::var(VARIABLE).unwrap_or_default();
    match value.trim().parse::<u128>() {
        Ok(n) if threads == 0 && n > MAX_THREADS as u128 => Err(PyValueError::new_err(format!(
            "the environment variable {VARIABLE} is `{value}`; expected at most {MAX_THREADS}, \
             or 0 for one thread per core"
        ))),
        _ => Ok(()),
    }
}
