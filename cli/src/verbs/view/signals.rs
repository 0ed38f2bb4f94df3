//! What ends the viewer from outside: the terminal is given back first.

use std::io;
#[cfg(unix)]
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

/// Signals that ask a program to end, from now on heard instead of obeyed.
pub(super) struct Signals {
    /// The last one that came, or 0.
    #[cfg(unix)]
    came: Arc<AtomicUsize>,
}

#[cfg(unix)]
impl Signals {
    pub(super) fn heard() -> io::Result<Self> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
        let came = Arc::new(AtomicUsize::new(0));
        for signal in [SIGHUP, SIGINT, SIGQUIT, SIGTERM] {
            signal_hook::flag::register_usize(signal, came.clone(), signal as usize)?;
        }
        Ok(Self { came })
    }

    /// Whether one came.
    pub(super) fn is_over(&self) -> bool {
        self.came.load(Ordering::SeqCst) != 0
    }

    /// Ends the program as the signal would have, if one came: whoever sent it sees that.
    pub(super) fn end(&self) {
        if self.is_over() {
            let signal = self.came.load(Ordering::SeqCst) as i32;
            // It does not come back but for signals that end nothing.
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    }
}

#[cfg(not(unix))]
impl Signals {
    pub(super) fn heard() -> io::Result<Self> {
        Ok(Self {})
    }

    pub(super) fn is_over(&self) -> bool {
        false
    }

    pub(super) fn end(&self) {}
}
