//! What a technique hands to the driver.

use gnomon_raster::{Recording, TextureId};

use super::kept::{KeptWork, PictureToKeep};
use super::pass::Roles;
use crate::world::scene::SceneWarning;

/// Something amiss that did not stop the work: code, count, message.
pub type Warning = SceneWarning;

/// Textures, commands and named outputs of one picture.
#[derive(Clone)]
pub struct Frame {
    /// Everything to draw, and the textures that it is drawn with: loaded once, its
    /// list may be submitted any number of times. Its outputs are named `color`,
    /// `depth-stencil` and, where a texture holds it, `visibility`.
    pub recording: Recording,
    /// What the passes of its list are for, one role each.
    pub roles: Roles,
    /// Where the results are afterwards.
    pub outputs: Outputs,
    /// What was found amiss on the way.
    pub warnings: Vec<Warning>,
    /// What became of each caster, light after light; empty for techniques
    /// without casters.
    pub casters: Vec<CasterUse>,
    /// Numbers that the technique chose for this scene, such as a bias.
    pub figures: Vec<Figure>,
    /// What the next frame of an animation may need of this one.
    pub keep: Vec<PictureToKeep>,
    /// The same of what was worked out for it.
    pub work: KeptWork,
}

/// A number that a technique chose, to be reported with its results.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it is, with the light's number where there are several.
    pub name: String,
    /// World units where it is a length.
    pub value: f64,
}

/// The textures that hold a frame's results, at mip 0, layer 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// Linear light.
    pub color: TextureId,
    /// Depth of the visible surfaces; 1 where there is none.
    pub depth_stencil: TextureId,
    /// Where visibility of the light is.
    pub visibility: VisibilityOutput,
}

/// How the light's visibility follows from a frame's textures. It is NaN where
/// depth is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VisibilityOutput {
    /// 1 at every surface.
    Full,
    /// 1 where the stencil is 0, else 0.
    StencilZero,
    /// Red of a colour texture of the frame's size, at mip 0, layer 0:
    /// `red · scale + offset`, limited to 0..=1. Integer formats give their
    /// integers as floats.
    Red {
        /// The texture.
        texture: TextureId,
        /// Factor of red.
        scale: f32,
        /// Added to the product.
        offset: f32,
    },
    /// Red and green of an 8-bit texture of the frame's size, at mip 0, layer 0, as the
    /// high and the low byte of a whole number: that times `scale`, limited to 0..=1.
    Bytes {
        /// The texture.
        texture: TextureId,
        /// Visibility of one step.
        scale: f32,
    },
}

impl VisibilityOutput {
    /// The texture that it is in, where it is in one.
    pub fn texture(self) -> Option<TextureId> {
        match self {
            Self::Full | Self::StencilZero => None,
            Self::Red { texture, .. } | Self::Bytes { texture, .. } => Some(texture),
        }
    }
}

/// How a caster's volume was counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeMethod {
    /// Sides, where they pass the depth test.
    DepthPass,
    /// Sides and caps, where they fail the depth test.
    DepthFail,
    /// Not drawn: the volume is outside the view.
    Skipped,
}

/// What became of one caster for one light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CasterUse {
    /// Index into [`crate::world::scene::Scene::objects`].
    pub object: usize,
    /// Index into [`crate::world::scene::Scene::lights`].
    pub light: usize,
    /// How it was counted.
    pub method: VolumeMethod,
    /// Triangles of light cap, dark cap and sides of its volume.
    pub triangles: [usize; 3],
}
