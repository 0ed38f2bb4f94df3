//! `gnomon dump`: the commands of a trace as lines of JSON, and its data as files.

mod args;
mod document;
mod images;
mod run;

pub(crate) use args::DumpArgs;
pub(crate) use run::run;
