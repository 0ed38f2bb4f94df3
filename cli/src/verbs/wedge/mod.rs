//! `gnomon wedge`: the penumbra wedge of one silhouette edge, and what it covers.

mod args;
mod document;
mod map;
mod picture;
mod run;
mod text;

pub(crate) use args::WedgeArgs;
pub(crate) use run::run;
