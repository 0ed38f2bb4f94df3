//! What a shadow technique is; the list of all of them is in [`crate::techniques`].
//!
//! A technique is a pure function from a scene and parameters to a [`Frame`]:
//! textures and commands for the emulated GPU, and the names of their outputs. It
//! touches no GPU, thread, clock or file; [`crate::measure::render`] runs it.

mod frame;
mod params;

use thiserror::Error;

pub use frame::{CasterUse, Figure, Frame, Outputs, VisibilityOutput, VolumeMethod, Warning};
pub use params::{ParamInfo, Params};

use crate::geometry::caster::RefusedCaster;
use crate::world::error::LightError;
use crate::world::scene::Scene;

/// A way to shade a scene with shadows.
pub trait Technique: Sync {
    /// Name on the command line, kebab-case.
    fn name(&self) -> &'static str;

    /// One line for people.
    fn summary(&self) -> &'static str;

    /// Its parameters, in the order in which they are listed.
    fn params(&self) -> &'static [ParamInfo];

    /// The frame of `scene` at `size` (width, height).
    ///
    /// # Errors
    /// The scene cannot be drawn by this technique, or the size is impossible.
    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError>;
}

/// Why a technique gives no frame.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TechniqueError {
    /// No technique of that name.
    #[error("no technique is called '{name}'{}; there are: {}", crate::world::error::suggestion(.nearest), .known.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The closest known name, when one is close.
        nearest: Option<&'static str>,
        /// All known names.
        known: Vec<&'static str>,
    },
    /// Not of the form `key=value`.
    #[error("parameter '{given}' is not of the form key=value")]
    NotAnAssignment {
        /// What was given.
        given: String,
    },
    /// No parameter of that name.
    #[error(
        "technique '{technique}' has no parameter '{key}'{}; it has: {}",
        crate::world::error::suggestion(.nearest), .known.join(", ")
    )]
    UnknownParameter {
        /// The technique.
        technique: &'static str,
        /// The parameter asked for.
        key: String,
        /// The closest known name, when one is close.
        nearest: Option<&'static str>,
        /// All known names.
        known: Vec<&'static str>,
    },
    /// A value that the parameter does not take.
    #[error("parameter {key} of technique '{technique}' is '{value}'; valid are: {valid}")]
    BadValue {
        /// The technique.
        technique: &'static str,
        /// The parameter.
        key: &'static str,
        /// The value given.
        value: String,
        /// The values taken.
        valid: &'static str,
    },
    /// A light that the scene does not have.
    #[error("light {given} was asked for; the scene has {count}, numbered from 0")]
    NoSuchLight {
        /// The number given.
        given: usize,
        /// Number of lights of the scene.
        count: usize,
    },
    /// A light that the technique cannot use.
    #[error("technique '{technique}' cannot use light {light}: {why}; it takes {valid}")]
    UnsuitableLight {
        /// The technique.
        technique: &'static str,
        /// Number of the light.
        light: usize,
        /// What is wrong with it.
        why: String,
        /// The lights taken.
        valid: &'static str,
    },
    /// A caster that is not closed.
    #[error(transparent)]
    RefusedCaster(#[from] RefusedCaster),
    /// A light should have an extent and has none.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The GPU refuses a texture.
    #[error(transparent)]
    Gpu(#[from] gnomon_raster::Error),
}
