//! `gnomon bisect`: which change of state makes two traces differ.

mod args;
mod run;

pub(crate) use args::BisectArgs;
pub(crate) use run::run;
