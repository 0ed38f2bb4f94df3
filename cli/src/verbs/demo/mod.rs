//! `gnomon demo`: the default scene, what each technique costs, and a proof
//! that skipping and the choice of method change no bit.

mod args;
mod checks;
mod errors;
mod run;
mod shots;

pub(crate) use args::DemoArgs;
pub(crate) use run::run;
