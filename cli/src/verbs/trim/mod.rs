//! `gnomon trim`: a part of a trace.

mod args;
mod run;

pub(crate) use args::TrimArgs;
pub(crate) use run::run;
