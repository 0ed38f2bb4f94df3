//! `gnomon report`: where a frame's work and bytes go, as one page to look at.

mod args;
mod measure;
mod page;
mod run;

pub(crate) use args::ReportArgs;
pub(crate) use run::run;
