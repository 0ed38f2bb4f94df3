//! Parts of soft shadow volumes: silhouette edges with their hard planes, lights
//! as shaders project on them, wedges as draws, and coverage tables.

pub(crate) mod count;
pub(crate) mod covering;
pub(crate) mod edges;
pub(crate) mod halves;
pub(crate) mod light;
pub(crate) mod loops;
pub(crate) mod pieces;
mod ranges;
pub(crate) mod settings;
pub(crate) mod split_tables;
pub(crate) mod stencil_count;
pub(crate) mod table;
pub(crate) mod wedges;
