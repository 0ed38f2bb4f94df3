//! Progress: a bar with the time left on a terminal, plain lines now and then elsewhere.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::is_quiet;

/// Between lines where there is no terminal; what is faster says nothing.
const PAUSE: Duration = Duration::from_secs(5);

/// Says on stderr what is being done.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Where there is no terminal.
    lines: Option<Mutex<Lines>>,
}

/// When the last line was.
struct Lines {
    last: Instant,
    doing: String,
}

impl Progress {
    /// Of `steps` steps.
    pub(crate) fn new(steps: u64) -> Self {
        let is_terminal = stderr().is_terminal();
        let target = match is_terminal && !is_quiet() {
            true => ProgressDrawTarget::stderr(),
            false => ProgressDrawTarget::hidden(),
        };
        let bar = ProgressBar::with_draw_target(Some(steps), target);
        let template = "{bar:24} {pos}/{len} {msg} (about {eta} left)";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let lines = Lines {
            last: Instant::now(),
            doing: String::new(),
        };
        Self {
            bar,
            lines: (!is_terminal && !is_quiet()).then(|| Mutex::new(lines)),
        }
    }

    /// Says what is done now.
    pub(crate) fn doing(&self, what: impl Into<String>) {
        let what = what.into();
        if let Some(lines) = &self.lines {
            let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
            lines.doing.clone_from(&what);
        }
        self.bar.set_message(what);
        self.bar.tick();
        self.line();
    }

    /// A step is done.
    pub(crate) fn step(&self) {
        self.steps(1);
    }

    /// Several steps are done, or need not be.
    pub(crate) fn steps(&self, count: u64) {
        self.bar.inc(count);
        self.line();
    }

    /// A line, if there has been none for a while.
    fn line(&self) {
        let Some(lines) = &self.lines else {
            return;
        };
        let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
        if lines.last.elapsed() < PAUSE {
            return;
        }
        lines.last = Instant::now();
        let (at, all) = (self.bar.position(), self.bar.length().unwrap_or(0));
        // A line that nobody can read is not worth failing for.
        let _ = writeln!(
            stderr().lock(),
            "{}",
            line(at, all, &lines.doing, self.bar.eta())
        );
    }
}

/// Steps, what is done, and the time left, which is known from the first step on.
fn line(at: u64, all: u64, doing: &str, left: Duration) -> String {
    match at {
        0 => format!("{at}/{all} {doing}"),
        _ => format!("{at}/{all} {doing} (about {} s left)", left.as_secs()),
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_how_far_and_how_long() {
        assert_eq!(line(0, 9, "loading", Duration::ZERO), "0/9 loading");
        let told = line(3, 9, "frame 3", Duration::from_millis(61_500));
        assert_eq!(told, "3/9 frame 3 (about 61 s left)");
    }
}
