//! `gnomon bench`: time and bytes against error, over scenes, techniques and their
//! parameters.
//!
//! A suite is planned as cells: a scene by a technique with parameters, at a size, on so
//! many threads. The result of each is a file of its own, found by the hash of all that
//! decides it; tables, plots and the page are made of those files and of nothing else. So
//! a run can stop anywhere, and parts can be measured anywhere.

mod advice;
mod args;
mod charts;
mod csv;
mod document;
mod envelope;
mod exact;
mod front;
mod load;
mod measure;
mod merge;
mod pace;
mod page;
mod plan;
mod publish;
mod request;
mod results;
mod run;
mod shard;
mod store;
mod stored;
mod suite;
mod text;

pub(crate) use args::BenchArgs;
pub(crate) use measure::Trial;
pub(crate) use pace::Pace;
pub(crate) use run::run;
