//! Execution of command lists: validation, geometry, tiles, reports.

mod listen;
mod pass;
mod prepare;
mod split;
mod tiles;
mod unit;
mod validate;

use std::time::Instant;

use listen::Listener;

use crate::command::CommandList;
use crate::error::Error;
use crate::gpu::{Gpu, SubmitReport};
use crate::observer::{AccessObserver, Wants};

/// Validates everything, then executes pass after pass.
pub(crate) fn submit(
    gpu: &mut Gpu,
    list: &CommandList,
    observer: Option<(Wants, &mut dyn AccessObserver)>,
) -> Result<SubmitReport, Error> {
    list.passes
        .iter()
        .try_for_each(|p| validate::render_pass(gpu, p))?;
    // One visit to the pool for all passes.
    let Some(pool) = gpu.pool.take() else {
        return Ok(passes(gpu, list, observer));
    };
    let report = pool.install(|| passes(gpu, list, observer));
    gpu.pool = Some(pool);
    Ok(report)
}

/// Executes validated passes in order.
fn passes(
    gpu: &mut Gpu,
    list: &CommandList,
    mut observer: Option<(Wants, &mut dyn AccessObserver)>,
) -> SubmitReport {
    let mut report = SubmitReport::default();
    for (number, pass) in list.passes.iter().enumerate() {
        let start = Instant::now();
        let listener = observer
            .as_mut()
            .map(|(wants, observer)| Listener::new(*wants, &mut **observer, number));
        let mut done = pass::execute(gpu, pass, listener);
        done.time = start.elapsed();
        if let Some((_, observer)) = &mut observer {
            observer.end(number, &done);
        }
        report.passes.push(done);
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
