//! `gnomon stress`: how far a scene can be pushed before techniques break down.

mod args;
mod charts;
mod csv;
mod document;
mod job;
mod record;
mod run;
mod text;

pub(crate) use args::StressArgs;
pub(crate) use run::run;
