//! Environment maps as the lights of a scene.

mod place;
mod request;

pub use place::place;
pub use request::{EnvironmentRequest, FittedMaps};
