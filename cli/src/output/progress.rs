//! Progress: a bar with the time left on a terminal, plain lines now and then elsewhere.

use std::cell::Cell;
use std::io::{IsTerminal, Write, stderr};
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use gnomon_pipeline::measure::watch::{Upcoming, watched};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::is_quiet;

/// Between lines where there is no terminal; what is faster says nothing.
const PAUSE: Duration = Duration::from_secs(5);

/// Says on stderr what is being done.
pub(crate) struct Progress(Arc<Shown>);

/// What is shown, also by whoever tells of passes.
struct Shown {
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
        let lines = (!is_terminal && !is_quiet()).then(|| Mutex::new(lines));
        Self(Arc::new(Shown { bar, lines }))
    }

    /// Says what is done now.
    pub(crate) fn doing(&self, what: impl Into<String>) {
        self.0.doing(what.into());
    }

    /// A step is done.
    pub(crate) fn step(&self) {
        self.steps(1);
    }

    /// Several steps are done, or need not be.
    pub(crate) fn steps(&self, count: u64) {
        self.0.steps(count);
    }

    /// What `render` gives, each pass of which is a further step: for a frame of its own.
    pub(crate) fn of_frame<T>(&self, what: &str, render: impl FnOnce() -> T) -> T {
        self.watched(what, true, render)
    }

    /// What `render` gives, which is one step of many: its passes are told of.
    pub(crate) fn of_step<T>(&self, what: &str, render: impl FnOnce() -> T) -> T {
        self.watched(what, false, render)
    }

    /// Where nobody is told, nobody listens.
    fn watched<T>(&self, what: &str, are_steps: bool, render: impl FnOnce() -> T) -> T {
        self.doing(what);
        if is_quiet() {
            return render();
        }
        let (shown, what) = (self.0.clone(), what.to_owned());
        let passes = Rc::new(Cell::new(0));
        let told = passes.clone();
        let listen = move |next: Upcoming<'_>| {
            told.set(next.passes);
            match (are_steps, next.pass) {
                (true, 0) => shown.bar.inc_length(next.passes as u64),
                (true, _) => shown.steps(1),
                (false, _) => {}
            }
            shown.doing(of_pass(&what, next));
        };
        let done = watched(listen, render);
        // The last pass, where there was one.
        if are_steps && passes.get() > 0 {
            self.step();
        }
        done
    }
}

/// `pcss, pass 3 of 12: lit`.
fn of_pass(what: &str, next: Upcoming<'_>) -> String {
    let (number, passes, label) = (next.pass + 1, next.passes, next.label);
    format!("{what}, pass {number} of {passes}: {label}")
}

impl Shown {
    fn doing(&self, what: String) {
        if let Some(lines) = &self.lines {
            let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
            lines.doing.clone_from(&what);
        }
        self.bar.set_message(what);
        self.bar.tick();
        self.line();
    }

    fn steps(&self, count: u64) {
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
        self.0.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_told_by_number_and_label() {
        let next = Upcoming {
            pass: 2,
            passes: 12,
            label: "lit 3",
        };
        assert_eq!(of_pass("pcss", next), "pcss, pass 3 of 12: lit 3");
    }

    #[test]
    fn lines_say_how_far_and_how_long() {
        assert_eq!(line(0, 9, "loading", Duration::ZERO), "0/9 loading");
        let told = line(3, 9, "frame 3", Duration::from_millis(61_500));
        assert_eq!(told, "3/9 frame 3 (about 61 s left)");
    }
}
