//! How often something is done again that only tells how far things are.

use std::time::{Duration, Instant};

/// How much longer than it took it is not done again: a tenth of the time goes into it at
/// most.
const SHARE: u32 = 10;

/// When something may be done again.
#[derive(Debug, Default)]
pub(crate) struct Pause {
    until: Option<Instant>,
}

impl Pause {
    /// Does it, the first time and whenever it would not take too much of the time. It may
    /// fail: what only tells how far things are is no reason to end them.
    pub(crate) fn unless_too_soon<E>(&mut self, work: impl FnOnce() -> Result<(), E>) {
        let start = Instant::now();
        if self.until.is_some_and(|until| start < until) {
            return;
        }
        let _ = work();
        self.until = Some(next(start, Instant::now()));
    }
}

/// When work from `start` to `end` may be done again.
fn next(start: Instant, end: Instant) -> Instant {
    let took: Duration = end - start;
    end + took * SHARE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_long_is_done_seldom() {
        let start = Instant::now();
        let seconds = |s| start + Duration::from_secs(s);
        assert_eq!(next(start, seconds(3)), seconds(33));
        let (mut pause, mut done) = (Pause::default(), 0);
        for _ in 0..5 {
            let work = || {
                done += 1;
                std::thread::sleep(Duration::from_millis(200));
                Ok::<(), ()>(())
            };
            pause.unless_too_soon(work);
        }
        assert_eq!(done, 1);
    }

    #[test]
    fn what_fails_is_tried_again_in_its_time() {
        let (mut pause, mut tried) = (Pause::default(), 0);
        for _ in 0..3 {
            pause.unless_too_soon(|| {
                tried += 1;
                Err("full")
            });
            assert!(pause.until.is_some());
            pause.until = Some(Instant::now());
        }
        assert_eq!(tried, 3);
    }
}
