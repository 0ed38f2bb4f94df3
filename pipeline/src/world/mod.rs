//! What is rendered: scenes with their meshes, lights and environment maps, and
//! the files they come from. Knows nothing of shadows.

pub mod adjacency;
pub mod convexity;
pub mod environment;
pub mod error;
pub mod export;
mod faces;
pub mod files;
pub mod light;
pub mod light_image;
pub mod material;
pub(crate) mod memo;
pub mod mesh;
pub mod model;
pub mod obj;
pub mod plates;
pub mod scene;
pub mod shape;
mod tally;
pub mod texture;
pub mod warning;

#[cfg(test)]
pub(crate) mod scratch;
