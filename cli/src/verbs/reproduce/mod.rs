//! `gnomon reproduce`: published claims, measured again.

mod args;
mod document;
mod run;
mod text;

pub(crate) use args::ReproduceArgs;
pub(crate) use run::run;
