//! Techniques on shadow maps: light views and what is looked up in them.

pub(crate) mod light_view;
pub(crate) mod lit_tiles;
pub(crate) mod mapped;
pub(crate) mod pictured;
pub(crate) mod tiles;
