//! The terminal while it is the viewer's; given back however the viewer ends.

use std::io::{self, BufWriter, IsTerminal, Stdout, Write, stdout};
use std::panic;
use std::sync::atomic::{AtomicBool, Ordering};

use crossterm::cursor::Show;
use crossterm::event::{DisableMouseCapture, EnableMouseCapture};
use crossterm::execute;
use crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use ratatui_core::terminal::Terminal;

use super::backend::Crossterm;
use crate::error::CliError;

/// Whether the terminal is the viewer's.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// A terminal in raw mode, with a screen of its own.
pub(super) struct Session {
    pub(super) terminal: Terminal<Crossterm<BufWriter<Stdout>>>,
}

/// Refuses to go on where there is no terminal.
pub(super) fn check() -> Result<(), CliError> {
    match stdout().is_terminal() {
        true => Ok(()),
        false => Err(CliError::NoTerminal),
    }
}

impl Session {
    /// Takes the terminal. From here on panics give it back before they are told.
    pub(super) fn start() -> Result<Self, CliError> {
        // A picture without colours is none: NO_COLOR is about text.
        crossterm::style::force_color_output(true);
        let told = panic::take_hook();
        panic::set_hook(Box::new(move |what| {
            give_back();
            told(what);
        }));
        IS_TAKEN.store(true, Ordering::SeqCst);
        take()
            .inspect_err(|_| give_back())
            .map_err(CliError::Terminal)
    }

    /// Whether the terminal is still the viewer's: a panic elsewhere gives it back.
    pub(super) fn is_on() -> bool {
        IS_TAKEN.load(Ordering::SeqCst)
    }
}

fn take() -> io::Result<Session> {
    enable_raw_mode()?;
    execute!(stdout(), EnterAlternateScreen, EnableMouseCapture)?;
    let mut terminal = Terminal::new(Crossterm(BufWriter::new(stdout())))?;
    terminal.hide_cursor()?;
    terminal.clear()?;
    Ok(Session { terminal })
}

/// Gives the terminal back, once.
fn give_back() {
    if !IS_TAKEN.swap(false, Ordering::SeqCst) {
        return;
    }
    // Nothing more can be done where this fails.
    let _ = execute!(stdout(), DisableMouseCapture, LeaveAlternateScreen, Show);
    let _ = disable_raw_mode();
    let _ = stdout().flush();
}

impl Drop for Session {
    fn drop(&mut self) {
        // What waits to be written belongs on the viewer's screen.
        let _ = self.terminal.backend_mut().0.flush();
        give_back();
    }
}
