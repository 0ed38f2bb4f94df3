//! What techniques share: the camera, the attachments, the draws of a scene and
//! the passes over them at the top; below, what volumes, wedges and shadow maps
//! are made of.
//!
//! What a technique of another crate needs is public: settings that every technique
//! has ([`frame_settings`]), the skeleton of a frame ([`shadowed_frame`]), the passes
//! over the scene ([`passes`]), and textures of positions and visibility with draws
//! over the whole screen ([`visibility`]).

pub(crate) mod backdrop;
pub(crate) mod casters;
pub(crate) mod far_surface;
pub mod frame_settings;
pub(crate) mod hierarchy;
pub(crate) mod horizon;
pub mod light_samples;
mod lit_surface;
pub(crate) mod maps;
pub mod passes;
pub mod shadowed_frame;
pub(crate) mod surface_draw;
pub(crate) mod surface_textures;
pub(crate) mod surface_vertices;
pub(crate) mod tables;
pub mod targets;
pub mod view;
pub mod visibility;
pub(crate) mod volumes;
pub(crate) mod wedges;
