//! `gnomon tune`: the technique and parameters that keep a budget.

mod args;
mod budget;
mod candidates;
mod document;
mod job;
mod run;
mod search;
mod text;
mod trial;

pub(crate) use args::TuneArgs;
pub(crate) use run::run;
