//! `gnomon debug`: a fragment's primitive, uniforms and varyings, and how to open its
//! shader in a debugger.

mod args;
mod run;

pub(crate) use args::DebugArgs;
pub(crate) use run::run;
