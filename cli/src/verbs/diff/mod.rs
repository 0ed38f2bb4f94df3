//! `gnomon diff`: what two traces differ in.

mod args;
mod document;
mod inputs;
mod run;
pub(super) mod text;

pub(crate) use args::DiffArgs;
pub(super) use document::StateDocument;
pub(super) use inputs::Inputs;
pub(crate) use run::run;
