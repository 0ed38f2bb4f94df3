//! `gnomon traffic`: what a recorded frame moves under profiles of hardware. Nothing is
//! drawn, and no shader is needed.

mod args;
mod files;
mod run;
mod table;

pub(crate) use args::TrafficArgs;
pub(crate) use run::{find_profile, run};
