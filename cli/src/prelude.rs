//! What a first frame and its test need: `use gnomon::prelude::*`.

pub use gnomon_golden::{assert_frame, content_hash};
pub use gnomon_raster::shader::{
    FragmentContext, FragmentOutputs, ScalarFragmentOutput, ScalarVertexOutput, per_fragment,
    per_vertex,
};
pub use gnomon_raster::state::{
    BlendState, ColorTargetState, CompareFunction, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation,
};
pub use gnomon_raster::{
    CommandList, Draw, Drawn, Error, Format, FrameBuilder, Gpu, GpuConfig, Recording, RenderPass,
    RenderPipeline, Sampler, Subresource, Texture, TextureBinding, TextureDescriptor, TextureId,
    TriangleDraw,
};
