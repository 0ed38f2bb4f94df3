//! `gnomon record`: frames of a scene in a trace.

mod args;
mod run;

pub(crate) use args::RecordArgs;
pub(crate) use run::run;
