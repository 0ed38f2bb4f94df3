//! What a shadow technique is; the list of all of them is in [`crate::techniques`].
//!
//! A technique is a pure function from a scene and parameters to a [`Frame`]:
//! textures and commands for the emulated GPU, and the names of their outputs. It
//! touches no GPU, thread, clock or file; [`crate::measure::render`] runs it.

mod capabilities;
mod condition;
mod domain;
mod frame;
mod kept;
mod nested;
mod param;
mod params;
mod pass;
mod wedges;

use thiserror::Error;

pub use capabilities::{Capabilities, LightKinds, ShadowKind, Source, WedgeUse};
pub use condition::{Condition, LightFact};
pub use domain::{Decimals, Domain, Value, Whole};
pub use frame::{CasterUse, Figure, Frame, Outputs, VisibilityOutput, VolumeMethod, Warning};
pub use kept::{KeptPictures, KeptWork, PictureKey, PictureToKeep};
pub use nested::Nested;
pub use param::{Choice, Number, Param, ParamInfo, Setting, count, join};
pub use params::{LIGHT_FRAME, Params, SETTING_WITHOUT_EFFECT};
pub use pass::{DrawRole, Pass, PassRole, Roles, apart};
pub use wedges::{CarryChannels, SceneWedges, WedgeKind};

use crate::geometry::caster::RefusedCaster;
use crate::truth::oracle::cache::{CacheWarning, OracleCache};
use crate::world::error::LightError;
use crate::world::light_image::{LightImage, LightImageError};
use crate::world::scene::Scene;

/// A way to shade a scene with shadows.
///
/// It is `Sync` and has no state but what it is made of, so that the list of all of
/// them is plain data; [`crate::techniques::Registry`] takes those of other crates.
pub trait Technique: Sync {
    /// Name on the command line, kebab-case.
    fn name(&self) -> &'static str;

    /// One line for people.
    fn summary(&self) -> &'static str;

    /// Its parameters, in the order in which they are listed; see
    /// [`param_list!`](crate::param_list).
    fn params(&self) -> &'static [ParamInfo];

    /// What it can do and what it needs.
    fn capabilities(&self) -> Capabilities;

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

    /// The same frame after another one of an animation, of which `kept` holds what it
    /// asked to keep: bits are those of [`Technique::frame`], draws may be fewer.
    ///
    /// # Errors
    /// As the frame.
    fn frame_after(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
        _kept: &KeptPictures,
    ) -> Result<Frame, TechniqueError> {
        self.frame(scene, size, params)
    }

    /// The image on the rectangle lights of its frame, which the truth about them has
    /// too; `None` for lights of one colour.
    ///
    /// # Errors
    /// As the frame: settings that rule each other out.
    fn light_image(&self, _params: &Params) -> Result<Option<LightImage>, TechniqueError> {
        Ok(None)
    }

    /// Makes what frames of `scene` need and takes long, such as precomputed transport, or
    /// reads it from `cache`; frames then find it. `done` is told of pieces of work, from
    /// any thread. What goes wrong with the cache is told, and made all the same.
    ///
    /// # Errors
    /// As the frame.
    fn prepare(
        &self,
        _scene: &Scene,
        _params: &Params,
        _cache: &OracleCache,
        _done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<CacheWarning>, TechniqueError> {
        Ok(Vec::new())
    }

    /// The penumbra wedges of its frame, from the same casters, silhouettes and
    /// constructions, without drawing; `None` for techniques without any.
    ///
    /// # Errors
    /// As the frame: a caster that is not closed, or a light that it is not made for.
    fn wedges(
        &self,
        _scene: &Scene,
        _params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        Ok(None)
    }

    /// How the attachments of its wedge passes, which each begin without coverage, are
    /// shared by coverage and carries; `None` where nothing is carried.
    ///
    /// # Errors
    /// As the frame: settings that rule each other out.
    fn carry_channels(&self, _params: &Params) -> Result<Option<CarryChannels>, TechniqueError> {
        Ok(None)
    }
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
        valid: String,
    },
    /// Files that are no images of a light.
    #[error("parameter {key} of technique '{technique}': {why}")]
    LightImage {
        /// The technique.
        technique: &'static str,
        /// The parameter.
        key: &'static str,
        /// What is wrong.
        why: LightImageError,
    },
    /// Two settings of which one rules the other out.
    #[error("technique '{technique}' cannot have both {}={} and {}={}: {why}", .settings[0].0, .settings[0].1, .settings[1].0, .settings[1].1)]
    Contradiction {
        /// The technique.
        technique: &'static str,
        /// Keys and values.
        settings: [(&'static str, String); 2],
        /// What each would need.
        why: &'static str,
    },
    /// A frame that does not say what its passes are for.
    #[error("technique '{technique}' gives {passes} passes and the roles of {roles}; each has one")]
    MissingRoles {
        /// The technique.
        technique: &'static str,
        /// Passes of the frame.
        passes: usize,
        /// Roles of the frame.
        roles: usize,
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
    /// More than its textures can hold.
    #[error("technique '{technique}' takes {most} triangles of casters; the scene has {given}")]
    TooManyTriangles {
        /// The technique.
        technique: &'static str,
        /// Triangles that cast.
        given: usize,
        /// How many there may be.
        most: usize,
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
