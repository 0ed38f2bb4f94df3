//! `gnomon export`: a scene as files for other programs.

mod args;
mod run;

pub(crate) use args::ExportArgs;
pub(crate) use run::run;
