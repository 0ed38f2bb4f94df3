//! `gnomon compare`: techniques against the truth, in errors, time and bytes.

mod against;
mod args;
mod csv;
mod environment;
mod job;
mod measure;
mod picture;
mod pixels;
mod run;
mod table;

pub(crate) use args::CompareArgs;
pub(crate) use run::run;
