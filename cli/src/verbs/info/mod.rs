//! `gnomon info`: what is in a trace. Nothing is drawn, and no shader is needed.

mod args;
mod run;

pub(crate) use args::InfoArgs;
pub(crate) use run::{contents, run};
