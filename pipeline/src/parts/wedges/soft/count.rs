//! The hard shadow count as draws (pass 1 of papers III and IV).

use std::sync::Arc;

use glam::DVec4;
use gnomon_raster::shader::VertexStage;
use gnomon_raster::state::{ColorTargetState, CullMode, DepthStencilState, PrimitiveState};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, VertexBuffer};
use gnomon_shaders::soft_volumes::{CountTo, EyeCount, HardCount, HardQuads};

use super::edges::{Silhouettes, SoftEdge};
use super::light::SoftLight;
use crate::parts::passes::{self, View};
use crate::parts::visibility::{Positions, binding, full_screen};
use crate::parts::volumes::near_cap::{self, CapTriangle};

/// What counts are drawn with.
pub(crate) struct Counting<'a> {
    pub(crate) view: &'a View,
    pub(crate) positions: Positions,
    pub(crate) light: &'a SoftLight,
    pub(crate) to: CountTo,
}

impl Counting<'_> {
    /// The eye's own count where it is not 0, lit triangles between the eye and the
    /// near plane where there are some, then all quads in one draw.
    pub(crate) fn draws(&self, silhouettes: &Silhouettes) -> Vec<Draw> {
        let eye = (silhouettes.eye_count != 0).then(|| {
            let vertex = EyeCount(silhouettes.eye_count as f32).stage();
            let textures = vec![binding(self.positions.texture)];
            full_screen(self.pipeline("eye", vertex, passes::clamped()), textures)
        });
        eye.into_iter()
            .chain(self.near_caps(&silhouettes.near_caps))
            .chain(self.quads(&silhouettes.edges))
            .collect()
    }

    /// Triangles that face the eye as if an umbra was entered there, the others as
    /// if it was left.
    fn near_caps(&self, caps: &[CapTriangle]) -> Vec<Draw> {
        if caps.is_empty() {
            return Vec::new();
        }
        let draw = |label, cull_mode, entered: f32| {
            let vertices = near_cap_vertices(self.view, caps, entered);
            let primitive = PrimitiveState {
                cull_mode,
                ..near_cap::primitive()
            };
            let vertex = HardQuads {
                clip_from_world: near_cap::clip_from_world(self.view),
                offsets: false,
            };
            let vertex = vertex.stage();
            let pipeline = self.pipeline(label, vertex, primitive);
            let indices = IndexBuffer::new((0..vertices.len() as u32).collect());
            Draw {
                textures: vec![binding(self.positions.texture)],
                ..Draw::indexed(
                    label,
                    &Arc::new(pipeline),
                    &Arc::new(vertices),
                    &Arc::new(indices),
                )
            }
        };
        vec![
            draw("near caps entered", CullMode::Back, 1.0),
            draw("near caps left", CullMode::Front, -1.0),
        ]
    }

    fn pipeline(
        &self,
        label: &str,
        vertex: VertexStage,
        primitive: PrimitiveState,
    ) -> RenderPipeline {
        let targets = match self.to {
            CountTo::Visibility => 1,
            CountTo::Alpha => 2,
            CountTo::Stencil => 0,
        };
        let shader = HardCount {
            origin: self.light.shader_origin(self.view),
            to: self.to,
        };
        RenderPipeline {
            label: label.to_owned(),
            vertex,
            fragment: Some(shader.stage()),
            primitive,
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::ADDITIVE; targets],
        }
    }

    fn quads(&self, edges: &[SoftEdge]) -> Option<Draw> {
        let (vertices, indices) = quads_of(self.view, self.light, edges)?;
        let vertex = HardQuads {
            clip_from_world: self.view.clip_from_world,
            offsets: self.light.is_far(),
        };
        let vertex = vertex.stage();
        let pipeline = self.pipeline("quads", vertex, passes::clamped());
        Some(Draw {
            textures: vec![binding(self.positions.texture)],
            ..Draw::indexed(
                "quads",
                &Arc::new(pipeline),
                &Arc::new(vertices),
                &Arc::new(indices),
            )
        })
    }
}

/// Corners of triangles for [`HardQuads`] with [`near_cap::clip_from_world`]; those that
/// face the eye count `entered`. They have no normal, so that nothing is on an umbra
/// side.
pub(super) fn near_cap_vertices(view: &View, caps: &[CapTriangle], entered: f32) -> VertexBuffer {
    let corners = near_cap::corners(view, caps);
    let data = corners.flat_map(|p| p.into_iter().chain([0.0, 0.0, 0.0, -entered]));
    VertexBuffer {
        data: data.collect(),
        stride: 8,
    }
}

/// Vertices and indices of the hard shadow quads of edges, for [`HardQuads`] with
/// offsets where the light is far; `None` without any.
pub(super) fn quads_of<'e>(
    view: &View,
    light: &SoftLight,
    edges: impl IntoIterator<Item = &'e SoftEdge>,
) -> Option<(VertexBuffer, IndexBuffer)> {
    let offsets = light.is_far();
    let stride = if offsets { 9 } else { 8 };
    let mut data = Vec::new();
    let mut indices = Vec::new();
    for edge in edges.into_iter().filter(|e| e.has_plane()) {
        let first = (data.len() / stride) as u32;
        let [e0, e1] = edge.ends.map(|e| view.relative(e).extend(1.0));
        let [d0, d1] = edge.away(light.centre).map(|d| d.extend(0.0));
        for v in [e0, e1, d0, d1] {
            data.extend(DVec4::to_array(&v).map(|c| c as f32));
            data.extend(edge.normal);
            data.push(if edge.eye_inside { 1.0 } else { 0.0 });
            data.extend(offsets.then(|| light.plane(edge).offset));
        }
        indices.extend([1, 0, 2, 1, 2, 3].map(|i| first + i));
    }
    let vertices = VertexBuffer { data, stride };
    (!indices.is_empty()).then(|| (vertices, IndexBuffer::new(indices)))
}
