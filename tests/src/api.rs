//! A small valid use of the raster API, for tests to break.

use std::sync::Arc;

use gnomon_raster::shader::{
    FragmentOutputs, Interpolation, ScalarFragmentOutput, ScalarVertexOutput, per_fragment,
    per_vertex,
};
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, CommandList, DepthStencilAttachment, Draw, Error, Format, Gpu, GpuConfig,
    LoadOp, MAX_VARYINGS, RenderPass, RenderPipeline, StoreOp, SubmitReport, Subresource,
    TextureDescriptor, TextureId, VertexBuffer,
};

/// A GPU with an image, a depth buffer and one draw of one triangle.
pub struct Use {
    /// The GPU.
    pub gpu: Gpu,
    /// Rgba8, 8×8, 2 mip levels.
    pub color: TextureId,
    /// D24S8, 8×8.
    pub depth: TextureId,
    /// Both attached, one draw.
    pub pass: RenderPass,
}

impl Use {
    /// A valid one.
    ///
    /// # Panics
    /// If it is refused.
    #[must_use]
    pub fn new() -> Self {
        let config = GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        };
        let mut gpu = Gpu::new(config).expect("a valid configuration");
        let mut create = |d: &TextureDescriptor| gpu.create_texture(d).expect("a valid texture");
        let color = create(&TextureDescriptor {
            mip_levels: 2,
            ..TextureDescriptor::d2("image", Format::Rgba8Unorm, 8, 8)
        });
        let depth = create(&TextureDescriptor::d2(
            "depths",
            Format::Depth24Stencil8,
            8,
            8,
        ));
        let pass = RenderPass {
            label: "main".to_owned(),
            color: vec![color_attachment(color)],
            depth_stencil: Some(depth_attachment(depth)),
            draws: vec![triangle(&Arc::new(pipeline()))],
        };
        Self {
            gpu,
            color,
            depth,
            pass,
        }
    }

    /// Submits the pass.
    ///
    /// # Errors
    /// What the GPU refuses.
    pub fn submit(&mut self) -> Result<SubmitReport, Error> {
        self.gpu.submit(&CommandList {
            passes: vec![self.pass.clone()],
        })
    }

    /// Changes the only draw.
    pub fn draw(&mut self, change: impl FnOnce(&mut Draw)) {
        change(&mut self.pass.draws[0]);
    }

    /// Changes the draw's render pipeline.
    pub fn pipeline(&mut self, change: impl FnOnce(&mut RenderPipeline)) {
        change(Arc::make_mut(&mut self.pass.draws[0].pipeline));
    }
}

impl Default for Use {
    fn default() -> Self {
        Self::new()
    }
}

/// Mip 0 of a texture, cleared.
#[must_use]
pub fn color_attachment(texture: TextureId) -> ColorAttachment {
    ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load: LoadOp::Clear([0.0; 4]),
        store: StoreOp::Store,
    }
}

/// Mip 0 of a texture, cleared.
#[must_use]
pub fn depth_attachment(texture: TextureId) -> DepthStencilAttachment {
    DepthStencilAttachment {
        texture,
        subresource: Subresource::default(),
        depth_load: LoadOp::Clear(1.0),
        depth_store: StoreOp::Store,
        stencil_load: LoadOp::Clear(0),
        stencil_store: StoreOp::Store,
    }
}

/// Positions are the first four floats of a vertex, what is missing 0; the
/// other floats are varyings. White, reading `textures` slots.
#[must_use]
pub fn shaders(varyings: usize, textures: usize) -> RenderPipeline {
    let vertex = per_vertex(&vec![Interpolation::Perspective; varyings], |v| {
        let float = |i: usize| v.attributes.get(i).copied().unwrap_or(0.0);
        ScalarVertexOutput {
            position: std::array::from_fn(float),
            varyings: std::array::from_fn::<f32, MAX_VARYINGS, _>(|i| float(4 + i)),
        }
    });
    let outputs = FragmentOutputs {
        textures,
        ..FragmentOutputs::default()
    };
    RenderPipeline {
        label: "pipeline".to_owned(),
        vertex,
        fragment: Some(per_fragment(outputs, |_| {
            ScalarFragmentOutput::color([1.0; 4])
        })),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::opaque(),
        color_targets: vec![ColorTargetState::OPAQUE],
    }
}

fn pipeline() -> RenderPipeline {
    shaders(0, 0)
}

fn triangle(pipeline: &Arc<RenderPipeline>) -> Draw {
    let corners = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]];
    let data = corners.iter().flat_map(|[x, y]| [*x, *y, 0.5, 1.0]);
    Draw {
        vertices: Some(Arc::new(VertexBuffer {
            data: data.collect(),
            stride: 4,
        })),
        ..Draw::vertices_only("triangle", pipeline, 3)
    }
}
