//! `gnomon view`: a scene on the terminal, to go round and to look into.
//!
//! `state.rs` says what is to be seen, as a pure function of what happens; `studio.rs` draws
//! it, in a thread of its own (`worker.rs`); `screen.rs` makes cells of it. The terminal is
//! known to `run.rs`, `session.rs`, `backend.rs` and `keys.rs` alone.

mod args;
mod backend;
mod blocks;
mod event;
mod facts;
mod fit;
mod keys;
mod look;
mod orbit;
mod panel;
mod run;
mod save;
mod screen;
mod session;
mod signals;
mod state;
mod studio;
#[cfg(test)]
mod tests;
mod text;
mod worker;

pub(crate) use args::ViewerArgs;
pub(crate) use run::run;
