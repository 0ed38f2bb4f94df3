//! What a frame does, without data and without code: enough to judge its traffic.

use gnomon_raster::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect, Viewport,
};
use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, Draw, Recording, RenderPass, TextureBinding,
    TextureDescriptor,
};

/// Textures and commands of a frame, shaders and buffers reduced to what they mean for
/// memory. A trace gives it without knowing a single shader.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameShape {
    /// By id.
    pub textures: Vec<TextureDescriptor>,
    /// In submission order.
    pub passes: Vec<PassShape>,
}

/// A render pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassShape {
    /// Shown in reports.
    pub label: String,
    /// Colour attachments.
    pub color: Vec<ColorAttachment>,
    /// Depth and stencil.
    pub depth_stencil: Option<DepthStencilAttachment>,
    /// In submission order.
    pub draws: Vec<DrawShape>,
}

/// A draw.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawShape {
    /// Shown in reports.
    pub label: String,
    /// The pipeline's label.
    pub pipeline: String,
    /// Assembly and rasterisation.
    pub primitive: PrimitiveState,
    /// Depth and stencil tests.
    pub depth_stencil: DepthStencilState,
    /// One per colour attachment of the pass.
    pub color_targets: Vec<ColorTargetState>,
    /// What its fragment shader may do; `None` without one.
    pub fragment: Option<FragmentShape>,
    /// Floats of a vertex in its buffer; `None` without one.
    pub vertex_stride: Option<usize>,
    /// It has an index buffer.
    pub indexed: bool,
    /// First index, or first vertex.
    pub first: u32,
    /// Number of indices, or of vertices.
    pub count: u32,
    /// Number of instances.
    pub instances: u32,
    /// Stencil reference of front and back faces.
    pub stencil_reference: [u8; 2],
    /// `None`: all of the attachments.
    pub viewport: Option<Viewport>,
    /// `None`: all of the attachments.
    pub scissor: Option<ScissorRect>,
    /// Textures by slot.
    pub textures: Vec<TextureBinding>,
}

/// What a fragment shader may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FragmentShape {
    /// It may discard fragments.
    pub discards: bool,
    /// It writes depth.
    pub depth: bool,
    /// Texture slots that it reads.
    pub textures: usize,
}

impl FrameShape {
    /// The shape of `recording`.
    #[must_use]
    pub fn of(recording: &Recording) -> Self {
        let textures = recording.textures().iter();
        Self {
            textures: textures.map(|t| t.descriptor().clone()).collect(),
            passes: recording.list.passes.iter().map(PassShape::of).collect(),
        }
    }
}

impl PassShape {
    fn of(pass: &RenderPass) -> Self {
        Self {
            label: pass.label.clone(),
            color: pass.color.clone(),
            depth_stencil: pass.depth_stencil.clone(),
            draws: pass.draws.iter().map(DrawShape::of).collect(),
        }
    }
}

impl DrawShape {
    fn of(draw: &Draw) -> Self {
        let pipeline = &draw.pipeline;
        let fragment = pipeline.fragment.as_ref().map(|stage| {
            let outputs = stage.outputs();
            FragmentShape {
                discards: outputs.discards,
                depth: outputs.depth,
                textures: outputs.textures,
            }
        });
        Self {
            label: draw.label.clone(),
            pipeline: pipeline.label.clone(),
            primitive: pipeline.primitive.clone(),
            depth_stencil: pipeline.depth_stencil,
            color_targets: pipeline.color_targets.clone(),
            fragment,
            vertex_stride: draw.vertices.as_ref().map(|v| v.stride),
            indexed: draw.indices.is_some(),
            first: draw.first,
            count: draw.count,
            instances: draw.instances,
            stencil_reference: draw.stencil_reference,
            viewport: draw.viewport,
            scissor: draw.scissor,
            textures: draw.textures.clone(),
        }
    }
}
