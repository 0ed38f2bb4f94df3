//! The smallest frame that has something to test.

use std::sync::Arc;

use gnomon_raster::shader::{
    FragmentOutputs, ScalarFragment, ScalarFragmentOutput, ScalarVertexOutput, per_fragment,
    per_vertex,
};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, Error, Format, LoadOp, Recording, RenderPass,
    RenderPipeline, StoreOp, Subresource, TextureDescriptor, TextureId,
};

/// A frame of one draw: triangles with `corners` in normalised device coordinates, nearest
/// first, shaded by `shade`, onto a black image called `color` and a depth buffer.
///
/// # Errors
/// For sizes that are not possible.
pub fn triangles<F>(size: [u32; 2], corners: &[[f32; 3]], shade: F) -> Result<Recording, Error>
where
    F: Fn(&ScalarFragment) -> ScalarFragmentOutput + Send + Sync + 'static,
{
    let mut frame = Recording::default();
    let [width, height] = size;
    let mut create =
        |label, format| frame.create(&TextureDescriptor::d2(label, format, width, height));
    let color = create("color", Format::Rgba8Unorm)?;
    let depth = create("depth", Format::Depth24Stencil8)?;
    frame.name_output("color", color)?;
    let count = corners.len() as u32;
    let corners: Arc<[[f32; 3]]> = corners.into();
    let pipeline = Arc::new(RenderPipeline {
        label: "triangles".to_owned(),
        vertex: per_vertex(&[], move |v| {
            let [x, y, z] = corners[v.vertex_index as usize];
            ScalarVertexOutput {
                position: [x, y, z, 1.0],
                ..ScalarVertexOutput::default()
            }
        }),
        fragment: Some(per_fragment(FragmentOutputs::default(), shade)),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::opaque(),
        color_targets: vec![ColorTargetState::OPAQUE],
    });
    let draws = vec![Draw::vertices_only("triangles", &pipeline, count)];
    frame.list.passes.push(pass(color, depth, draws));
    Ok(frame)
}

fn pass(color: TextureId, depth: TextureId, draws: Vec<Draw>) -> RenderPass {
    RenderPass {
        label: "triangles".to_owned(),
        color: vec![ColorAttachment {
            texture: color,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0, 0.0, 0.0, 1.0]),
            store: StoreOp::Store,
        }],
        depth_stencil: Some(DepthStencilAttachment {
            texture: depth,
            subresource: Subresource::default(),
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Store,
            stencil_load: LoadOp::Clear(0),
            stencil_store: StoreOp::Store,
        }),
        draws,
    }
}
