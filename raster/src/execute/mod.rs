//! Execution of command lists: validation, geometry, tiles, reports.

mod pass;
mod prepare;
mod split;
mod validate;

use std::time::Instant;

use crate::command::CommandList;
use crate::error::Error;
use crate::gpu::{Gpu, SubmitReport};
use crate::observer::AccessObserver;

/// Validates everything, then executes pass after pass.
pub(crate) fn submit(
    gpu: &mut Gpu,
    list: &CommandList,
    observer: Option<&mut dyn AccessObserver>,
) -> Result<SubmitReport, Error> {
    list.passes
        .iter()
        .try_for_each(|p| validate::render_pass(gpu, p))?;
    // One visit to the pool for all passes, unless an observer has to stay here.
    match (gpu.pool.take(), observer) {
        (Some(pool), None) => {
            let report = pool.install(|| passes(gpu, list, None));
            gpu.pool = Some(pool);
            Ok(report)
        }
        (pool, observer) => {
            gpu.pool = pool;
            Ok(passes(gpu, list, observer))
        }
    }
}

/// Executes validated passes in order.
fn passes(
    gpu: &mut Gpu,
    list: &CommandList,
    mut observer: Option<&mut dyn AccessObserver>,
) -> SubmitReport {
    let mut report = SubmitReport::default();
    for (number, pass) in list.passes.iter().enumerate() {
        let start = Instant::now();
        let mut accesses = observer.as_ref().map(|_| Vec::new());
        let mut done = pass::execute(gpu, pass, accesses.as_mut());
        done.time = start.elapsed();
        report.passes.push(done);
        if let (Some(observer), Some(accesses)) = (observer.as_deref_mut(), accesses) {
            observer.render_pass(number, &pass.label, &accesses);
        }
    }
    report
}

/// A pool of `n` workers; 0 for one per core.
pub(crate) fn start_pool(n: usize) -> Result<rayon::ThreadPool, Error> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(n)
        .build()
        .map_err(|e| Error::Threads {
            given: n,
            reason: e.to_string(),
        })
}

/// Whether this thread's floating-point unit replaces denormals by zero.
pub(crate) fn denormals_are_flushed() -> bool {
    let smallest = std::hint::black_box(f32::MIN_POSITIVE);
    std::hint::black_box(smallest * 0.5) == 0.0
}
