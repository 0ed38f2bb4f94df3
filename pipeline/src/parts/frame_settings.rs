//! Settings that every technique has: which lights shine, how surfaces are shaded,
//! and the formats of the attachments.
//!
//! # Colour
//!
//! Shaders compute linear light and passes add it. The default target is
//! `rgba16f`, precise enough that its sRGB picture shows no bands. `rgba8`
//! holds the same linear light in 8 bits, as the papers' hardware and the peers'
//! renderers do: half the bytes, bands in the dark, sums that
//! saturate. What a value means does not depend on the format.

use gnomon_raster::Format;

use crate::choices;
use crate::technique::{Param, ParamInfo, Params, TechniqueError, Whole};
use crate::world::scene::Scene;

choices! {
    /// How surfaces reflect.
    pub enum Shading {
        /// With the material's highlights.
        Phong = "phong",
        /// Diffuse only.
        Lambert = "lambert",
    }
}

choices! {
    /// Format of the colour attachment.
    pub enum ColorFormat {
        /// 16-bit floats.
        Rgba16f = "rgba16f",
        /// 8 bits.
        Rgba8 = "rgba8",
    }
}

choices! {
    /// Format of the depth attachment.
    pub enum DepthFormat {
        /// 24-bit integers.
        D24 = "d24",
        /// 32-bit floats.
        D32f = "d32f",
    }
}

/// Which lights shine.
pub const LIGHT: Param<Option<usize>> = Param::<Option<usize>>::whole_or(
    &["all"],
    "light",
    [0, u32::MAX as u64],
    Whole::Any,
    "which lights shine: all, or one by its number; visibility is that of the first",
);

/// How surfaces reflect.
pub const SHADING: Param<Shading> = Param::choice(
    "shading",
    Shading::Phong.word(),
    "with the material's highlights, or diffuse only",
);

/// Format of the colour attachment.
pub const COLOR_FORMAT: Param<ColorFormat> = Param::choice(
    "color-format",
    ColorFormat::Rgba16f.word(),
    "target for linear light; rgba8 costs half the bytes, shows bands and saturates",
);

/// Format of the depth attachment.
pub const DEPTH_FORMAT: Param<DepthFormat> = Param::choice(
    "depth-format",
    DepthFormat::D24.word(),
    "24-bit integer or 32-bit float depth",
);

/// Values of the parameters of this module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSettings {
    /// The only light that shines; all where there is none.
    pub light: Option<usize>,
    /// How surfaces reflect.
    pub shading: Shading,
    /// Format of the colour attachment.
    pub color: ColorFormat,
    /// Format of the depth attachment.
    pub depth: DepthFormat,
}

impl FrameSettings {
    /// The parameters, for a technique's list.
    pub const PARAMS: &'static [ParamInfo] = &[
        LIGHT.info,
        SHADING.info,
        COLOR_FORMAT.info,
        DEPTH_FORMAT.info,
    ];

    /// Reads them.
    ///
    /// # Errors
    /// The technique does not list them.
    pub fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            light: params.get(&LIGHT)?,
            ..Self::shading_only(params)?
        })
    }

    /// Shading and formats, with all lights.
    ///
    /// # Errors
    /// The technique does not list them.
    pub fn shading_only(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            light: None,
            shading: params.get(&SHADING)?,
            color: params.get(&COLOR_FORMAT)?,
            depth: params.get(&DEPTH_FORMAT)?,
        })
    }

    /// Numbers of the lights that shine, first one first.
    ///
    /// # Errors
    /// The scene has no light of the number asked for.
    pub fn lights(&self, scene: &Scene) -> Result<Vec<usize>, TechniqueError> {
        let count = scene.lights.len();
        match self.light {
            None => Ok((0..count).collect()),
            Some(given) if given < count => Ok(vec![given]),
            Some(given) => Err(TechniqueError::NoSuchLight { given, count }),
        }
    }

    /// Format of the colour attachment.
    pub(super) fn color_format(&self) -> Format {
        match self.color {
            ColorFormat::Rgba16f => Format::Rgba16Float,
            ColorFormat::Rgba8 => Format::Rgba8Unorm,
        }
    }

    /// Format of the depth attachment.
    pub(super) fn depth_format(&self) -> Format {
        match self.depth {
            DepthFormat::D24 => Format::Depth24Stencil8,
            DepthFormat::D32f => Format::Depth32FloatStencil8,
        }
    }
}
