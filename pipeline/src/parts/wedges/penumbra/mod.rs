//! What the penumbra-wedge techniques of papers I and II share.

pub(crate) mod axes;
pub(crate) mod casters;
pub(crate) mod hard;
pub(crate) mod light;
pub(crate) mod report;
pub(crate) mod screen;
pub(crate) mod shape;
pub(crate) mod volume;

use gnomon_raster::{Format, LoadOp, Recording, RenderPass, TextureDescriptor, TextureId};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::intensity::Interpolation;

use crate::parts::passes::{SceneDraws, Targets};
use crate::parts::visibility::{VisibilityTexture, attachment};
use crate::technique::{ParamInfo, Params, TechniqueError};

pub(crate) const INTERPOLATION: ParamInfo = ParamInfo {
    name: "interpolation",
    default: "linear",
    valid: "linear|smoothstep",
    summary: "between full light and full shadow: linear, or 3s^2 - 2s^3, nearer to a sphere",
};

pub(crate) const EXTRA_WEDGES: ParamInfo = ParamInfo {
    name: "extra-wedges",
    default: "on",
    valid: "on|off",
    summary: "up to six more wedges round acute vertices",
};

pub(crate) fn interpolation(params: &Params) -> Interpolation {
    match params.get(INTERPOLATION.name) {
        "linear" => Interpolation::Linear,
        _ => Interpolation::Smoothstep,
    }
}

/// The light-intensity buffer, which all lights use in turn: signed 16 bits, 255
/// is full light.
pub(crate) fn light_intensity(
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2("light intensity", Format::R16Sint, width, height);
    Ok(recording.create(&desc)?)
}

/// The buffer as visibility: clamped to 0..=255 (paper I, §4), over 255.
pub(crate) fn visibility(buffer: TextureId) -> VisibilityTexture {
    VisibilityTexture {
        scale: 1.0 / FULL,
        ..VisibilityTexture::red(buffer)
    }
}

/// A pass into a light-intensity buffer, without draws.
pub(crate) fn intensity_pass(
    label: String,
    buffer: TextureId,
    load: LoadOp<[f32; 4]>,
) -> RenderPass {
    RenderPass {
        label,
        color: vec![attachment(buffer, load)],
        depth_stencil: None,
        draws: Vec::new(),
    }
}

/// The pass that gives full light to what takes no shadow, if there is anything.
pub(crate) fn not_receiving_pass(
    label: String,
    buffer: TextureId,
    targets: &Targets,
    draws: &SceneDraws<'_>,
) -> Option<RenderPass> {
    let list = draws.not_receiving(&label, [FULL, 0.0, 0.0, 0.0]);
    (!list.is_empty()).then(|| RenderPass {
        depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
        draws: list,
        ..intensity_pass(label, buffer, LoadOp::Load)
    })
}

/// Every pixel at `intensity`.
pub(crate) fn cleared(intensity: f32) -> LoadOp<[f32; 4]> {
    LoadOp::Clear([intensity, 0.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests;
