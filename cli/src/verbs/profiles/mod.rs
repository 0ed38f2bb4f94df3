//! `gnomon profiles`: the hardware whose memory can be modelled.

mod args;
mod run;

pub(crate) use args::ProfilesArgs;
pub(crate) use run::run;
