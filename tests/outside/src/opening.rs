//! The example that the documentation of `gnomon-raster` opens with.

use std::sync::Arc;

use gnomon_raster::shader::{
    FragmentOutputs, ScalarFragmentOutput, ScalarVertexOutput, per_fragment, per_vertex,
};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass, RenderPipeline,
    StoreOp, Subresource, TextureDescriptor,
};

/// A triangle over the lower left half of a 4×4 image.
pub fn opening(config: GpuConfig) -> u64 {
    let corners = [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let pipeline = Arc::new(RenderPipeline {
        label: "orange".into(),
        vertex: per_vertex(&[], move |v| {
            let [x, y] = corners[v.vertex_index as usize];
            ScalarVertexOutput {
                position: [x, y, 0.5, 1.0],
                ..Default::default()
            }
        }),
        fragment: Some(per_fragment(FragmentOutputs::default(), |_| {
            ScalarFragmentOutput::color([1.0, 0.5, 0.0, 1.0])
        })),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![ColorTargetState::OPAQUE],
    });
    let mut gpu = Gpu::new(config).expect("valid");
    let image = gpu
        .create_texture(&TextureDescriptor::d2("image", Format::Rgba8Unorm, 4, 4))
        .expect("valid");
    let report = gpu
        .submit(&CommandList {
            passes: vec![RenderPass {
                label: "main".into(),
                color: vec![ColorAttachment {
                    texture: image,
                    subresource: Subresource::default(),
                    load: LoadOp::Clear([0.0; 4]),
                    store: StoreOp::Store,
                }],
                depth_stencil: None,
                draws: vec![Draw::vertices_only("triangle", &pipeline, 3)],
            }],
        })
        .expect("valid");
    let image = gpu.texture(image).expect("exists");
    let texels = image.read_raw(Subresource::default()).expect("exists");
    crate::hash(&(texels, report.passes[0].draws[0].counters))
}
