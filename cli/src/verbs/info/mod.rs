//! `gnomon info`: what is in a trace. Nothing is drawn, and no shader is needed.

mod args;
mod document;
mod run;

pub(crate) use args::InfoArgs;
pub(crate) use document::TraceDocument;
pub(crate) use run::run;
