//! The hard shadow count in seven bits of the stencil (paper IV, §4.2: an ordinary
//! shadow volume pass; docs/papers.md, paper IV).
//!
//! Quads that are entered count up and those that are left count down: which it is
//! follows from the side that the eye is on. Whether a quad is crossed is for the
//! shader, whose predicate is that of the penumbrae; a depth test leaves out what it
//! could never find, quads that lie clearly behind the surface. So `skip` changes no bit.

use std::sync::Arc;

use gnomon_raster::shader::VertexStage;
use gnomon_raster::state::{
    CompareFunction, CullMode, DepthBias, DepthState, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, VertexBuffer};
use gnomon_shaders::soft_volumes::{CountTo, EyeCount, HardCount, HardQuads};
use gnomon_shaders::split_volumes::resolve::COUNT_BITS;

use super::count::{near_cap_vertices, quads_of};
use super::edges::{Silhouettes, SoftEdge};
use super::light::SoftLight;
use super::wedges::bias;
use crate::parts::passes::{self, View};
use crate::parts::visibility::{Positions, binding, full_screen};
use crate::parts::volumes::near_cap::{self, CapTriangle};

/// What counts are drawn with: into a pass without colour whose stencil begins at 0.
pub(crate) struct StencilCounting<'a> {
    pub(crate) view: &'a View,
    pub(crate) positions: Positions,
    pub(crate) light: &'a SoftLight,
    /// Leave out quads behind the surface.
    pub(crate) skip: bool,
}

/// What a crossing does to the count.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Step {
    /// An umbra is entered.
    Entered,
    /// It is left.
    Left,
}

impl StencilCounting<'_> {
    /// The eye's own count where it is not 0, lit triangles between the eye and the
    /// near plane where there are some, then quads.
    pub(crate) fn draws(&self, silhouettes: &Silhouettes) -> Vec<Draw> {
        self.eye(silhouettes.eye_count)
            .into_iter()
            .chain(self.near_caps(&silhouettes.near_caps))
            .chain(self.quads(&silhouettes.edges, Step::Entered))
            .chain(self.quads(&silhouettes.edges, Step::Left))
            .collect()
    }

    fn eye(&self, count: i32) -> Option<Draw> {
        let vertex = EyeCount(count as f32).stage();
        let state = counting(StencilOperation::Replace, DepthState::DISABLED);
        let pipeline = self.pipeline("eye", vertex, passes::clamped(), state);
        let draw = full_screen(pipeline, vec![binding(self.positions.texture)]);
        (count != 0).then(|| Draw {
            stencil_reference: [(count & i32::from(COUNT_BITS)) as u8; 2],
            ..draw
        })
    }

    /// Triangles that face the eye as if an umbra was entered there, the others as if it
    /// was left.
    fn near_caps(&self, caps: &[CapTriangle]) -> Vec<Draw> {
        if caps.is_empty() {
            return Vec::new();
        }
        let draw = |label, cull_mode, step: Step| {
            let vertices = near_cap_vertices(self.view, caps, 1.0);
            let indices = IndexBuffer::new((0..vertices.len() as u32).collect());
            let primitive = PrimitiveState {
                cull_mode,
                ..near_cap::primitive()
            };
            let vertex = HardQuads {
                clip_from_world: near_cap::clip_from_world(self.view),
                offsets: false,
            };
            let state = counting(step.operation(), DepthState::DISABLED);
            let pipeline = self.pipeline(label, vertex.stage(), primitive, state);
            self.indexed(pipeline, vertices, indices)
        };
        vec![
            draw("near caps entered", CullMode::Back, Step::Entered),
            draw("near caps left", CullMode::Front, Step::Left),
        ]
    }

    /// The quads of edges for which a crossing is such a step.
    fn quads(&self, edges: &[SoftEdge], step: Step) -> Option<Draw> {
        let inside = step == Step::Left;
        let edges = edges.iter().filter(|e| e.eye_inside == inside);
        let (vertices, indices) = quads_of(self.view, self.light, edges)?;
        let vertex = HardQuads {
            clip_from_world: self.view.clip_from_world,
            offsets: self.light.is_far(),
        };
        let state = DepthStencilState {
            bias: if self.skip {
                bias(-1.0)
            } else {
                DepthBias::default()
            },
            ..counting(step.operation(), self.not_behind())
        };
        let label = match step {
            Step::Entered => "quads entered",
            Step::Left => "quads left",
        };
        let pipeline = self.pipeline(label, vertex.stage(), passes::clamped(), state);
        Some(self.indexed(pipeline, vertices, indices))
    }

    fn not_behind(&self) -> DepthState {
        DepthState {
            compare: if self.skip {
                CompareFunction::LessEqual
            } else {
                CompareFunction::Always
            },
            write: false,
            bounds: None,
        }
    }

    fn pipeline(
        &self,
        label: &str,
        vertex: VertexStage,
        primitive: PrimitiveState,
        depth_stencil: DepthStencilState,
    ) -> RenderPipeline {
        let shader = HardCount {
            origin: self.light.shader_origin(self.view),
            to: CountTo::Stencil,
        };
        RenderPipeline {
            label: label.to_owned(),
            vertex,
            fragment: Some(shader.stage()),
            primitive,
            depth_stencil,
            color_targets: Vec::new(),
        }
    }

    fn indexed(
        &self,
        pipeline: RenderPipeline,
        vertices: VertexBuffer,
        indices: IndexBuffer,
    ) -> Draw {
        let label = pipeline.label.clone();
        let (pipeline, vertices) = (Arc::new(pipeline), Arc::new(vertices));
        Draw {
            textures: vec![binding(self.positions.texture)],
            ..Draw::indexed(&label, &pipeline, &vertices, &Arc::new(indices))
        }
    }
}

impl Step {
    fn operation(self) -> StencilOperation {
        match self {
            Self::Entered => StencilOperation::IncrementWrap,
            Self::Left => StencilOperation::DecrementWrap,
        }
    }
}

/// Counts where the test of depth passes.
fn counting(operation: StencilOperation, depth: DepthState) -> DepthStencilState {
    let face = StencilFaceState {
        pass_op: operation,
        write_mask: COUNT_BITS,
        ..StencilFaceState::IGNORE
    };
    DepthStencilState {
        depth,
        stencil: StencilState {
            front: face,
            back: face,
        },
        ..DepthStencilState::default()
    }
}
