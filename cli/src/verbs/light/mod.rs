//! `gnomon light`: an area light as one pixel's surface sees it, and what adds up to its
//! visibility.

mod args;
mod document;
mod picture;
mod run;
mod text;

pub(crate) use args::LightArgs;
pub(crate) use run::run;
