//! From the command line to a screen, and back.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossterm::event::{poll, read};
use gnomon_pipeline::techniques::Registry;

use super::args::ViewerArgs;
use super::blocks::Palette;
use super::event::{Action, Effect, Event, Saved};
use super::keys::Keys;
use super::save;
use super::screen;
use super::session::{self, Session};
use super::signals::Signals;
use super::state::State;
use super::studio::Studio;
use super::worker::Worker;
use crate::error::CliError;
use crate::output;

/// Between looks at keys and frames.
const TICK: Duration = Duration::from_millis(20);
/// Between words about a frame that is being drawn.
const WAITING: Duration = Duration::from_millis(100);
/// How long the panic of another thread may take to be told.
const GRACE: Duration = Duration::from_secs(2);
/// Without a key for so long, the whole frame is drawn.
const REST: Duration = Duration::from_millis(150);

/// Shows the scene until somebody has seen enough of it; then says what was written.
pub(crate) fn run(args: &ViewerArgs, registry: &Registry) -> Result<(), CliError> {
    check(args)?;
    session::check()?;
    let (studio, technique) = Studio::new(args, registry)?;
    let facts = studio.facts()?;
    let studio = Arc::new(studio);
    let worker = Worker::start(studio.clone()).map_err(CliError::Terminal)?;
    let signals = Signals::heard().map_err(CliError::Terminal)?;
    let mut session = Session::start()?;
    let size = session.terminal.size().map_err(CliError::Terminal)?;
    let state = State::new(facts, technique, [size.width, size.height]);
    let mut viewer = Viewer {
        studio,
        state,
        worker,
        palette: Palette::of_terminal(),
        input: Instant::now(),
        asked: Instant::now(),
        seen: Instant::now(),
        is_over: false,
        signals,
    };
    let ended = viewer.show(&mut session);
    drop(session);
    viewer.signals.end();
    viewer.wait_for_pictures();
    let text = told(&viewer.state.saved);
    if !text.is_empty() {
        output::print_asked(&text, false)?;
    }
    ended?;
    match viewer.is_over {
        true => Ok(()),
        false => {
            viewer.worker.wait(GRACE);
            Err(CliError::Check(
                "the thread that draws has ended".to_owned(),
            ))
        }
    }
}

/// An animation is looked at a moment at a time.
fn check(args: &ViewerArgs) -> Result<(), CliError> {
    match args.frame.frames {
        Some(frames) => Err(CliError::Flag {
            flag: "--frames",
            value: frames.to_string(),
            valid: "the viewer shows one moment; choose it with --time, or render the frames"
                .to_owned(),
        }),
        None => Ok(()),
    }
}

/// The files that were written, and what makes each again.
fn told(saved: &[Saved]) -> String {
    let lines = saved
        .iter()
        .map(|s| format!("wrote {}\n  {}\n", s.path.display(), s.command));
    lines.collect()
}

struct Viewer {
    studio: Arc<Studio>,
    state: State,
    worker: Worker,
    palette: Palette,
    /// When somebody asked for something last.
    input: Instant,
    /// When a frame was asked for last.
    asked: Instant,
    /// When the screen was drawn last.
    seen: Instant,
    is_over: bool,
    signals: Signals,
}

impl Viewer {
    /// Until it is over, or the thread that draws is no more.
    fn show(&mut self, session: &mut Session) -> Result<(), CliError> {
        let mut keys = Keys::default();
        let first = self.state.start();
        self.do_all(first);
        self.draw(session)?;
        while !self.is_over && Session::is_on() && !self.signals.is_over() {
            let mut events = self.heard(&mut keys).map_err(CliError::Terminal)?;
            let Ok(()) = self.finished(&mut events) else {
                return Ok(());
            };
            let mut is_new = !events.is_empty();
            if events.is_empty() && self.input.elapsed() >= REST {
                events.push(Event::Rest);
            }
            for event in events {
                let effects = self.state.update(event);
                is_new |= !effects.is_empty();
                self.do_all(effects);
            }
            is_new |= self.state.asked.is_some() && self.seen.elapsed() >= WAITING;
            if is_new && Session::is_on() {
                self.draw(session)?;
            }
        }
        Ok(())
    }

    /// What keys and mouse ask for: all that has come, after a little while at most.
    fn heard(&mut self, keys: &mut Keys) -> std::io::Result<Vec<Event>> {
        let mut events = Vec::new();
        let mut wait = TICK;
        while poll(wait)? {
            if let Some(action) = keys.action(&read()?) {
                events.push(Event::Input(action));
                self.input = Instant::now();
            }
            wait = Duration::ZERO;
        }
        Ok(events)
    }

    /// What the thread has done.
    fn finished(&self, events: &mut Vec<Event>) -> Result<(), ()> {
        while let Some(event) = self.worker.next()? {
            events.push(event);
        }
        Ok(())
    }

    /// Until what was to be written is, or a signal says that nobody wants it any more.
    fn wait_for_pictures(&mut self) {
        let mut events = Vec::new();
        while self.state.saving > 0 && self.finished(&mut events).is_ok() {
            for event in events.drain(..) {
                self.state.update(event);
            }
            self.signals.end();
            std::thread::sleep(TICK);
        }
    }

    fn do_all(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Draw(look) => {
                    self.asked = Instant::now();
                    self.worker.draw(look);
                }
                Effect::Tell(look, pixel) => self.worker.tell(look, pixel),
                Effect::Save(look) => match self.state.shown.as_ref() {
                    Some(drawn) if drawn.look == look => {
                        let event = save::event(&self.studio, Ok(&**drawn));
                        self.state.update(event);
                    }
                    _ => self.worker.save(look),
                },
                Effect::Quit => self.is_over = true,
            }
        }
    }

    fn draw(&mut self, session: &mut Session) -> Result<(), CliError> {
        self.seen = Instant::now();
        let terminal = &mut session.terminal;
        let size = terminal.size().map_err(CliError::Terminal)?;
        let cells = [size.width, size.height];
        if cells != self.state.cells {
            let effects = self.state.update(Event::Input(Action::Resize(cells)));
            self.do_all(effects);
        }
        let (state, waited, palette) = (&self.state, self.asked.elapsed(), self.palette);
        let drawn = session
            .terminal
            .draw(|frame| screen::draw(state, waited, palette, frame.buffer_mut()));
        drawn.map(|_| ()).map_err(CliError::Terminal)
    }
}
