//! Parts of soft shadow volumes: silhouette edges with their hard planes, lights
//! as shaders project on them, wedges as draws, and coverage tables.

pub(super) mod count;
pub(super) mod covering;
pub(super) mod edges;
pub(super) mod halves;
pub(super) mod light;
pub(super) mod light_image;
mod outlines;
pub(super) mod split_tables;
pub(super) mod table;
pub(super) mod wedges;
