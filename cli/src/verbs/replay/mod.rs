//! `gnomon replay`: a frame of a trace, drawn again.

mod args;
mod picture;
mod run;

pub(crate) use args::ReplayArgs;
pub(crate) use run::run;
