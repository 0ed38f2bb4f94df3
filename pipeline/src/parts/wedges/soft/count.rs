//! The hard shadow count as draws (pass 1 of papers III and IV).

use std::sync::Arc;

use glam::{DVec3, DVec4};
use gnomon_raster::shader::VertexStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, VertexBuffer};
use gnomon_shaders::soft_volumes::{CountTo, EyeCount, HardCount, HardQuads};

use super::edges::{Silhouettes, SoftEdge};
use crate::parts::passes::{self, View};
use crate::parts::visibility::{Positions, binding, full_screen};
use crate::world::mesh::narrow;

/// What counts are drawn with.
pub(crate) struct Counting<'a> {
    pub(crate) view: &'a View,
    pub(crate) positions: Positions,
    /// The light's centre, world space.
    pub(crate) centre: DVec3,
    pub(crate) to: CountTo,
}

impl Counting<'_> {
    /// The eye's own count where it is not 0, then all quads in one draw.
    pub(crate) fn draws(&self, silhouettes: &Silhouettes) -> Vec<Draw> {
        let eye = (silhouettes.eye_count != 0).then(|| {
            let vertex = EyeCount(silhouettes.eye_count as f32).stage();
            let textures = vec![binding(self.positions.texture)];
            full_screen(self.pipeline("eye", vertex), textures)
        });
        eye.into_iter()
            .chain(self.quads(&silhouettes.edges))
            .collect()
    }

    fn pipeline(&self, label: &str, vertex: VertexStage) -> RenderPipeline {
        let targets = match self.to {
            CountTo::Visibility => 1,
            CountTo::Alpha => 2,
        };
        let shader = HardCount {
            centre: narrow(self.view.relative(self.centre)),
            to: self.to,
        };
        RenderPipeline {
            label: label.to_owned(),
            vertex,
            fragment: Some(shader.stage()),
            primitive: passes::clamped(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::ADDITIVE; targets],
        }
    }

    fn quads(&self, edges: &[SoftEdge]) -> Option<Draw> {
        let mut data = Vec::new();
        let mut indices = Vec::new();
        for edge in edges.iter().filter(|e| e.has_plane()) {
            let first = (data.len() / 8) as u32;
            let [e0, e1] = edge.ends.map(|e| self.view.relative(e).extend(1.0));
            let [d0, d1] = edge.away(self.centre).map(|d| d.extend(0.0));
            for v in [e0, e1, d0, d1] {
                data.extend(DVec4::to_array(&v).map(|c| c as f32));
                data.extend(edge.normal);
                data.push(if edge.eye_inside { 1.0 } else { 0.0 });
            }
            indices.extend([1, 0, 2, 1, 2, 3].map(|i| first + i));
        }
        if indices.is_empty() {
            return None;
        }
        let pipeline = self.pipeline("quads", HardQuads(self.view.clip_from_world).stage());
        let vertices = VertexBuffer { data, stride: 8 };
        Some(Draw {
            textures: vec![binding(self.positions.texture)],
            ..Draw::indexed(
                "quads",
                &Arc::new(pipeline),
                &Arc::new(vertices),
                &Arc::new(IndexBuffer::new(indices)),
            )
        })
    }
}
