//! An environment that lights a scene.

use glam::DVec3;

use super::{Environment, Fit};

/// Half side of the cube of lights, in radii of the casters' bounding box.
pub const DISTANCE: f64 = 64.0;

/// An environment that lights a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedEnvironment {
    /// The map.
    pub map: Environment,
    /// Its lights, in the order of the scene's.
    pub fit: Fit,
    /// Centre of the cube of lights, world space.
    pub centre: DVec3,
    /// Half its side, world units.
    pub reach: f64,
}
