//! What techniques share: the camera, the attachments, the draws of a scene and
//! the passes over them at the top; below, what volumes, wedges and shadow maps
//! are made of.

pub(crate) mod casters;
pub(crate) mod far_surface;
pub(crate) mod horizon;
pub mod light_samples;
pub(crate) mod maps;
pub(crate) mod passes;
pub(crate) mod surface_draw;
pub(crate) mod targets;
pub(crate) mod view;
pub(crate) mod visibility;
pub(crate) mod volumes;
pub(crate) mod wedges;
