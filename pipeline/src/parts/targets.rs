//! The attachments that all passes of a frame share, and the parameters that
//! choose their formats and the lights that shine.
//!
//! # Colour
//!
//! Shaders compute linear light and passes add it. The default target is
//! `rgba16f`, precise enough that its sRGB picture shows no bands. `rgba8`
//! holds the same linear light in 8 bits, as the papers' hardware and the peers'
//! renderers do: half the bytes, bands in the dark, sums that
//! saturate. What a value means does not depend on the format.

use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Format, LoadOp, Recording, RenderPass,
    StoreOp, Subresource, TextureDescriptor, TextureId,
};

use super::visibility::attachment;
use crate::technique::{Frame, Outputs, ParamInfo, Params, TechniqueError, VisibilityOutput};
use crate::world::scene::Scene;

pub(crate) const LIGHT: ParamInfo = ParamInfo {
    name: "light",
    default: "all",
    valid: "all|N",
    summary: "which lights shine: all, or one by its number; visibility is that of the first",
};

pub(crate) const SHADING: ParamInfo = ParamInfo {
    name: "shading",
    default: "phong",
    valid: "phong|lambert",
    summary: "with the material's highlights, or diffuse only",
};

pub(crate) const COLOR_FORMAT: ParamInfo = ParamInfo {
    name: "color-format",
    default: "rgba16f",
    valid: "rgba16f|rgba8",
    summary: "target for linear light; rgba8 costs half the bytes, shows bands and saturates",
};

pub(crate) const DEPTH_FORMAT: ParamInfo = ParamInfo {
    name: "depth-format",
    default: "d24",
    valid: "d24|d32f",
    summary: "24-bit integer or 32-bit float depth",
};

/// The lights that `params` asks for, first one first.
pub(crate) fn lights(scene: &Scene, params: &Params) -> Result<Vec<usize>, TechniqueError> {
    let count = scene.lights.len();
    match params.get(LIGHT.name).parse() {
        Err(_) => Ok((0..count).collect()),
        Ok(given) if given < count => Ok(vec![given]),
        Ok(given) => Err(TechniqueError::NoSuchLight { given, count }),
    }
}

/// `what`, with the light's number where there are several.
pub(crate) fn label(what: &str, light: usize, lights: &[usize]) -> String {
    if lights.len() == 1 {
        what.to_owned()
    } else {
        format!("{what} {light}")
    }
}

/// The attachments of a frame.
pub(crate) struct Targets {
    color: TextureId,
    depth_stencil: TextureId,
}

impl Targets {
    pub(crate) fn create(
        [width, height]: [u32; 2],
        params: &Params,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let rgba8 = params.get(COLOR_FORMAT.name) == "rgba8";
        let color = if rgba8 {
            Format::Rgba8Unorm
        } else {
            Format::Rgba16Float
        };
        let d32f = params.get(DEPTH_FORMAT.name) == "d32f";
        let depth = if d32f {
            Format::Depth32FloatStencil8
        } else {
            Format::Depth24Stencil8
        };
        Ok(Self {
            color: recording.create(&TextureDescriptor::d2("color", color, width, height))?,
            depth_stencil: recording.create(&TextureDescriptor::d2(
                "depth-stencil",
                depth,
                width,
                height,
            ))?,
        })
    }

    /// The frame of `passes`, whose textures are in `recording`.
    pub(crate) fn frame(
        &self,
        mut recording: Recording,
        passes: Vec<RenderPass>,
        visibility: VisibilityOutput,
    ) -> Result<Frame, TechniqueError> {
        recording.list = CommandList { passes };
        recording.name_output("color", self.color)?;
        recording.name_output("depth-stencil", self.depth_stencil)?;
        if let VisibilityOutput::Red { texture, .. } = visibility {
            recording.name_output("visibility", texture)?;
        }
        Ok(Frame {
            recording,
            outputs: Outputs {
                color: self.color,
                depth_stencil: self.depth_stencil,
                visibility,
            },
            warnings: Vec::new(),
            casters: Vec::new(),
            figures: Vec::new(),
        })
    }

    pub(crate) fn color(&self, load: LoadOp<[f32; 4]>) -> Vec<ColorAttachment> {
        vec![attachment(self.color, load)]
    }

    /// Depth and stencil, to be read while they are not attached.
    pub(crate) fn depth_texture(&self) -> TextureId {
        self.depth_stencil
    }

    /// Depth and stencil as they are, but for the given loads.
    pub(crate) fn depth_stencil(
        &self,
        depth: LoadOp<f32>,
        stencil: LoadOp<u8>,
    ) -> Option<DepthStencilAttachment> {
        Some(DepthStencilAttachment {
            texture: self.depth_stencil,
            subresource: Subresource::default(),
            depth_load: depth,
            depth_store: StoreOp::Store,
            stencil_load: stencil,
            stencil_store: StoreOp::Store,
        })
    }
}
