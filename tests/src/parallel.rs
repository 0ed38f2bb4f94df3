//! Independent jobs on plain threads.
//!
//! Not on rayon: a worker that waits for a GPU's own pool would steal further
//! jobs meanwhile, case inside case, until its stack overflows.

use std::sync::atomic::{AtomicU64, Ordering};

/// What `job` gives for each number of a range, in order.
pub fn map<T: Send>(range: std::ops::Range<u64>, job: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let next = AtomicU64::new(range.start);
    let work = || {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= range.end {
                return done;
            }
            done.push((k, job(k)));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut results = std::thread::scope(|s| {
        let workers: Vec<_> = (0..threads).map(|_| s.spawn(work)).collect();
        let join = |w: std::thread::ScopedJoinHandle<'_, Vec<(u64, T)>>| {
            w.join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        workers.into_iter().flat_map(join).collect::<Vec<_>>()
    });
    results.sort_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, t)| t).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn results_come_in_order() {
        assert_eq!(
            super::map(3..50, |k| k * k),
            (3..50).map(|k| k * k).collect::<Vec<_>>()
        );
    }
}
