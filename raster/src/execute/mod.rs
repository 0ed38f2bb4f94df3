//! Execution of command lists: validation, geometry, tiles, reports.

mod listen;
mod order;
mod pass;
mod prepare;
mod split;
mod tiles;
mod unit;
mod validate;
mod workers;

pub use workers::worker_threads;

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
    observer: Option<(Wants<'_>, &mut dyn AccessObserver)>,
) -> Result<SubmitReport, Error> {
    list.passes
        .iter()
        .try_for_each(|p| validate::render_pass(gpu, p))?;
    workers::ensure(gpu, list)?;
    // One visit to the pool for all passes.
    let Some(pool) = gpu.pool.take() else {
        gpu.parallel = false;
        return passes(gpu, list, observer);
    };
    gpu.parallel = true;
    let report = pool.install(|| passes(gpu, list, observer));
    gpu.pool = Some(pool);
    report
}

/// Executes validated passes in order.
fn passes(
    gpu: &mut Gpu,
    list: &CommandList,
    mut observer: Option<(Wants<'_>, &mut dyn AccessObserver)>,
) -> Result<SubmitReport, Error> {
    let mut report = SubmitReport::default();
    for (number, pass) in list.passes.iter().enumerate() {
        let start = Instant::now();
        let listener = observer
            .as_mut()
            .map(|(wants, observer)| Listener::new(*wants, &mut **observer, number));
        let mut done = pass::execute(gpu, pass, listener)?;
        done.time = start.elapsed();
        if let Some((_, observer)) = &mut observer {
            observer.end(number, &done);
        }
        report.passes.push(done);
    }
    Ok(report)
}

/// Whether this thread's floating-point unit replaces denormals by zero.
pub(crate) fn denormals_are_flushed() -> bool {
    let smallest = std::hint::black_box(f32::MIN_POSITIVE);
    std::hint::black_box(smallest * 0.5) == 0.0
}
