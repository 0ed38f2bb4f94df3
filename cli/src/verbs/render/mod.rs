//! `gnomon render`: one frame of a scene, or an animation.

mod args;
mod expect;
mod frames;
mod job;
mod run;
mod show;
mod write;

pub(crate) use args::RenderArgs;
pub(crate) use run::run;
pub(crate) use write::png_of;
