//! Progress with the time that is left: a bar on a terminal, lines elsewhere.

use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::output::is_quiet;

/// How far a benchmark is.
pub(crate) struct Pace {
    bar: Option<ProgressBar>,
    /// Cells that are to be measured, and those that were.
    total: usize,
    done: usize,
    start: Instant,
}

impl Pace {
    /// The start of `total` measurements.
    pub(crate) fn new(total: usize) -> Self {
        Self {
            bar: (stderr().is_terminal() && !is_quiet()).then(|| bar(total)),
            total,
            done: 0,
            start: Instant::now(),
        }
    }

    /// Says what is being done.
    pub(crate) fn doing(&self, what: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(format!("{}{what}", self.left()));
            bar.tick();
        }
    }

    /// A measurement is done.
    pub(crate) fn done(&mut self, what: &str) {
        self.done += 1;
        match &self.bar {
            Some(bar) => bar.inc(1),
            None if is_quiet() => {}
            None => {
                let [done, total] = [self.done, self.total];
                self.say(&format!("[{done}/{total}] {}{what}", self.left()));
            }
        }
    }

    /// Says something that stays.
    pub(crate) fn say(&self, line: &str) {
        // Whoever does not listen need not be told that he does not.
        let write = || {
            let _ = writeln!(stderr().lock(), "{line}");
        };
        match &self.bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }

    fn left(&self) -> String {
        match left(self.start.elapsed(), self.done, self.total) {
            Some(left) => format!("{} left, ", duration(left)),
            None => String::new(),
        }
    }
}

impl Drop for Pace {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: usize) -> ProgressBar {
    let bar = ProgressBar::new(total as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:20} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    bar
}

/// Time for the rest, if it goes on as it went.
fn left(spent: Duration, done: usize, total: usize) -> Option<Duration> {
    let rest = total.saturating_sub(done);
    (done > 0).then(|| spent.mul_f64(rest as f64 / done as f64))
}

/// `40 s`, `3 min`, `2 h 5 min`.
pub(super) fn duration(time: Duration) -> String {
    let seconds = time.as_secs_f64().round() as u64;
    let minutes = (seconds + 30) / 60;
    match seconds {
        0..90 => format!("{seconds} s"),
        90..3570 => format!("{minutes} min"),
        _ => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_takes_as_long_as_what_was_done() {
        let seconds = Duration::from_secs;
        assert_eq!(left(seconds(10), 0, 5), None);
        assert_eq!(left(seconds(10), 2, 5), Some(seconds(15)));
        assert_eq!(left(seconds(10), 5, 5), Some(seconds(0)));
        let texts = [0, 89, 90, 150, 3569, 3570, 7500].map(|s| duration(seconds(s)));
        assert_eq!(
            texts,
            [
                "0 s",
                "89 s",
                "2 min",
                "3 min",
                "59 min",
                "1 h 0 min",
                "2 h 5 min"
            ]
        );
    }
}
