//! Depth as a colour texture, to be read while depth is attached.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::penumbra::buffers::DepthCopy;
use gnomon_shaders::transform::FullScreen;

use crate::parts::passes::Targets;
use crate::parts::visibility::{attachment, binding, full_screen};
use crate::technique::{Pass, PassRole, TechniqueError};

/// The pass that copies depth, and the copy: wedges read depth while it is attached.
pub(crate) fn depth_copy(
    targets: &Targets,
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<(Pass, TextureId), TechniqueError> {
    let desc = TextureDescriptor::d2("depth copy", Format::R32Float, width, height);
    let copy = recording.create(&desc)?;
    let pipeline = RenderPipeline {
        label: "depth copy".into(),
        vertex: FullScreen.stage(),
        fragment: Some(DepthCopy.stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    };
    let depth = vec![binding(targets.depth_texture())];
    let pass = RenderPass {
        label: "depth copy".into(),
        color: vec![attachment(copy, LoadOp::DontCare)],
        depth_stencil: None,
        draws: vec![full_screen(pipeline, depth)],
    };
    Ok((Pass::new(PassRole::DepthCopy, pass), copy))
}
