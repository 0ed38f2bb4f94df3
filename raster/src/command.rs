//! Commands as data: render passes of draws, with state, shaders and resources.

use std::sync::{Arc, OnceLock};

use crate::shader::{FragmentStage, VertexStage};
use crate::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, Sampler, ScissorRect, Viewport,
};
use crate::texture::{Subresource, TextureId};

/// What an attachment holds when the pass begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadOp<T> {
    /// What it held before.
    Load,
    /// This value in every pixel; counted as writes.
    Clear(T),
    /// Nothing that may be relied on; here always zero, uncounted.
    DontCare,
}

/// What becomes of an attachment when the pass ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StoreOp {
    /// It is kept.
    #[default]
    Store,
    /// It may be forgotten; here it always becomes zero, so that nobody comes
    /// to rely on it.
    Discard,
}

/// A colour attachment of a render pass.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorAttachment {
    /// The image.
    pub texture: TextureId,
    /// Which of its images.
    pub subresource: Subresource,
    /// At the beginning.
    pub load: LoadOp<[f32; 4]>,
    /// At the end.
    pub store: StoreOp,
}

/// The depth-stencil attachment of a render pass.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthStencilAttachment {
    /// The image.
    pub texture: TextureId,
    /// Which of its images.
    pub subresource: Subresource,
    /// Depth at the beginning.
    pub depth_load: LoadOp<f32>,
    /// Depth at the end.
    pub depth_store: StoreOp,
    /// Stencil at the beginning.
    pub stencil_load: LoadOp<u8>,
    /// Stencil at the end.
    pub stencil_store: StoreOp,
}

/// The state bundle of a draw.
#[derive(Clone)]
pub struct RenderPipeline {
    /// Shown in reports.
    pub label: String,
    /// The vertex shader.
    pub vertex: VertexStage,
    /// The fragment shader; `None` for depth and stencil only.
    pub fragment: Option<FragmentStage>,
    /// Assembly and rasterisation.
    pub primitive: PrimitiveState,
    /// Depth and stencil tests.
    pub depth_stencil: DepthStencilState,
    /// One per colour attachment of the render pass.
    pub color_targets: Vec<ColorTargetState>,
}

/// Interleaved vertex data.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexBuffer {
    /// Floats of all vertices.
    pub data: Vec<f32>,
    /// Floats per vertex.
    pub stride: usize,
}

impl VertexBuffer {
    /// Number of whole vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.data.len().checked_div(self.stride).unwrap_or(0)
    }

    /// Whether there is no whole vertex.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The vertices that a range of indices refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Referenced {
    /// Vertex numbers, ascending, each once.
    pub(crate) vertices: Vec<u32>,
    /// The indices, as positions in `vertices`.
    pub(crate) local: Vec<u32>,
}

impl Referenced {
    pub(crate) fn of(indices: &[u32]) -> Self {
        let (Some(&min), Some(&max)) = (indices.iter().min(), indices.iter().max()) else {
            return Self {
                vertices: Vec::new(),
                local: Vec::new(),
            };
        };
        // A table over the span of the indices is fast, but few indices may span gigabytes.
        if (max - min) as usize / 64 > indices.len() {
            return Self::of_sparse(indices);
        }
        Self::of_dense(indices, min, max)
    }

    fn of_sparse(indices: &[u32]) -> Self {
        let mut vertices = indices.to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |i: &u32| vertices.partition_point(|v| v < i) as u32;
        let local = indices.iter().map(place).collect();
        Self { vertices, local }
    }

    fn of_dense(indices: &[u32], min: u32, max: u32) -> Self {
        let mut place = vec![u32::MAX; (max - min) as usize + 1];
        for &i in indices {
            place[(i - min) as usize] = 0;
        }
        let mut vertices = Vec::new();
        for (i, p) in place.iter_mut().enumerate() {
            if *p == 0 {
                *p = vertices.len() as u32;
                vertices.push(min + i as u32);
            }
        }
        let local = indices.iter().map(|&i| place[(i - min) as usize]).collect();
        Self { vertices, local }
    }
}

/// Indices into a vertex buffer.
#[derive(Debug)]
pub struct IndexBuffer {
    indices: Vec<u32>,
    largest: Option<u32>,
    referenced: OnceLock<Referenced>,
}

impl IndexBuffer {
    /// Takes the indices.
    #[must_use]
    pub fn new(indices: Vec<u32>) -> Self {
        let largest = indices.iter().copied().max();
        Self {
            indices,
            largest,
            referenced: OnceLock::new(),
        }
    }

    /// The indices.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The largest index; `None` where there is none.
    #[must_use]
    pub fn largest(&self) -> Option<u32> {
        self.largest
    }

    /// What the whole buffer refers to, found once.
    pub(crate) fn referenced(&self) -> &Referenced {
        self.referenced
            .get_or_init(|| Referenced::of(&self.indices))
    }
}

/// A texture in a slot of a draw.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureBinding {
    /// The texture.
    pub texture: TextureId,
    /// How it is read.
    pub sampler: Sampler,
}

/// One draw call.
#[derive(Clone)]
pub struct Draw {
    /// Shown in reports.
    pub label: String,
    /// State and shaders.
    pub pipeline: Arc<RenderPipeline>,
    /// Vertex data; `None` where the shader needs only vertex numbers.
    pub vertices: Option<Arc<VertexBuffer>>,
    /// Indices; `None` draws vertices in order.
    pub indices: Option<Arc<IndexBuffer>>,
    /// First index, or first vertex.
    pub first: u32,
    /// Number of indices, or of vertices.
    pub count: u32,
    /// Number of instances.
    pub instances: u32,
    /// Stencil reference of front and back faces.
    pub stencil_reference: [u8; 2],
    /// For [`crate::state::BlendFactor::Constant`].
    pub blend_constant: [f32; 4],
    /// `None`: all of the attachments.
    pub viewport: Option<Viewport>,
    /// `None`: all of the attachments.
    pub scissor: Option<ScissorRect>,
    /// Textures by slot.
    pub textures: Vec<TextureBinding>,
}

impl Draw {
    /// All indices of `indices` over `vertices`, one instance, default dynamic state.
    #[must_use]
    pub fn indexed(
        label: &str,
        pipeline: &Arc<RenderPipeline>,
        vertices: &Arc<VertexBuffer>,
        indices: &Arc<IndexBuffer>,
    ) -> Self {
        Self {
            count: indices.indices().len() as u32,
            indices: Some(indices.clone()),
            vertices: Some(vertices.clone()),
            ..Self::vertices_only(label, pipeline, 0)
        }
    }

    /// `count` vertices without buffers, one instance, default dynamic state.
    #[must_use]
    pub fn vertices_only(label: &str, pipeline: &Arc<RenderPipeline>, count: u32) -> Self {
        Self {
            label: label.to_owned(),
            pipeline: pipeline.clone(),
            vertices: None,
            indices: None,
            first: 0,
            count,
            instances: 1,
            stencil_reference: [0; 2],
            blend_constant: [0.0; 4],
            viewport: None,
            scissor: None,
            textures: Vec::new(),
        }
    }
}

/// Draws into one set of attachments.
#[derive(Clone)]
pub struct RenderPass {
    /// Shown in reports.
    pub label: String,
    /// At most [`crate::MAX_COLOR_ATTACHMENTS`], all of one size.
    pub color: Vec<ColorAttachment>,
    /// Depth and stencil, of the same size.
    pub depth_stencil: Option<DepthStencilAttachment>,
    /// In submission order.
    pub draws: Vec<Draw>,
}

/// Render passes in submission order.
#[derive(Clone, Default)]
pub struct CommandList {
    /// The passes.
    pub passes: Vec<RenderPass>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn referenced_vertices_are_each_listed_once_in_order() {
        let r = Referenced::of(&[7, 3, 7, 9, 3, 4]);
        assert_eq!(r.vertices, [3, 4, 7, 9]);
        assert_eq!(r.local, [2, 0, 2, 3, 0, 1]);
        let sparse = [7, 3_000_000_000, 7, 2];
        assert_eq!(Referenced::of(&sparse).vertices, [2, 7, 3_000_000_000]);
        assert_eq!(Referenced::of(&sparse).local, [1, 2, 1, 0]);
        let near = [7, 3, 7, 9, 3, 4];
        assert_eq!(
            Referenced::of_sparse(&near),
            Referenced::of_dense(&near, 3, 9)
        );
        assert_eq!(
            Referenced::of(&[]),
            Referenced {
                vertices: vec![],
                local: vec![]
            }
        );
    }
}
