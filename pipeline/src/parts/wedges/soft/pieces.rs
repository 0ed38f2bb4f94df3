//! What counts hard shadows, piece by piece, for whoever draws it in ways of their own.

use std::sync::Arc;

use gnomon_raster::shader::VertexStage;
use gnomon_raster::state::{CullMode, PrimitiveState};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, TextureBinding, VertexBuffer};
use gnomon_shaders::soft_volumes::{EyeCount, HardQuads};

use super::count::{near_cap_vertices, quads_of};
use super::edges::{Silhouettes, SoftEdge};
use super::light::SoftLight;
use crate::parts::passes::{self, View};
use crate::parts::visibility::full_screen;
use crate::parts::volumes::near_cap::{self, CapTriangle};

/// Something drawn that counts: the eye's own umbrae, lit triangles that the near plane
/// cuts away, or hard shadow quads.
pub(crate) struct Piece {
    pub(crate) label: &'static str,
    pub(crate) vertex: VertexStage,
    pub(crate) primitive: PrimitiveState,
    /// Umbrae that are entered there; below 0 they are left.
    pub(crate) entered: i32,
    /// Whether it is where it is drawn; else it counts before everything.
    pub(crate) is_quad: bool,
    /// `None` for the whole screen.
    geometry: Option<(Arc<VertexBuffer>, Arc<IndexBuffer>)>,
}

impl Piece {
    /// Whether it is the eye's own count.
    pub(crate) fn is_eye(&self) -> bool {
        self.geometry.is_none()
    }

    /// The draw of it.
    pub(crate) fn draw(&self, pipeline: RenderPipeline, textures: Vec<TextureBinding>) -> Draw {
        match &self.geometry {
            None => full_screen(pipeline, textures),
            Some((vertices, indices)) => Draw {
                textures,
                ..Draw::indexed(self.label, &Arc::new(pipeline), vertices, indices)
            },
        }
    }
}

/// What counts the hard shadows of silhouettes: all of a kind together or, with `apart`,
/// such that no piece lies over itself.
pub(crate) fn pieces(
    view: &View,
    light: &SoftLight,
    silhouettes: &Silhouettes,
    apart: bool,
) -> Vec<Piece> {
    let count = silhouettes.eye_count;
    let eye = (count != 0).then(|| Piece {
        label: "eye",
        vertex: EyeCount(count as f32).stage(),
        primitive: passes::clamped(),
        entered: count,
        is_quad: false,
        geometry: None,
    });
    let together = |n: usize| if apart { 1 } else { n.max(1) };
    let caps = silhouettes
        .near_caps
        .chunks(together(silhouettes.near_caps.len()));
    let edges = silhouettes.edges.iter().filter(|e| e.has_plane());
    let (left, entered): (Vec<&SoftEdge>, Vec<&SoftEdge>) = edges.partition(|e| e.eye_inside);
    let quads = [(1, entered), (-1, left)].into_iter();
    eye.into_iter()
        .chain(caps.flat_map(|caps| near_caps(view, caps)))
        .chain(quads.flat_map(|(step, edges)| {
            let chunks = edges.chunks(together(edges.len()));
            let all: Vec<Piece> = chunks
                .filter_map(|c| quads_piece(view, light, c, step))
                .collect();
            all
        }))
        .collect()
}

/// Triangles that face the eye, as if an umbra was entered there, and the others, as if
/// it was left.
fn near_caps(view: &View, caps: &[CapTriangle]) -> [Piece; 2] {
    let piece = |label, cull_mode, entered: i32| {
        let vertices = near_cap_vertices(view, caps, entered as f32);
        let indices = IndexBuffer::new((0..vertices.len() as u32).collect());
        let vertex = HardQuads {
            clip_from_world: near_cap::clip_from_world(view),
            offsets: false,
        };
        Piece {
            label,
            vertex: vertex.stage(),
            primitive: PrimitiveState {
                cull_mode,
                ..near_cap::primitive()
            },
            entered,
            is_quad: false,
            geometry: Some((Arc::new(vertices), Arc::new(indices))),
        }
    };
    [
        piece("near caps entered", CullMode::Back, 1),
        piece("near caps left", CullMode::Front, -1),
    ]
}

/// Quads at which umbrae are entered, or left, by the side that the eye is on.
fn quads_piece(view: &View, light: &SoftLight, edges: &[&SoftEdge], entered: i32) -> Option<Piece> {
    let (vertices, indices) = quads_of(view, light, edges.iter().copied())?;
    let vertex = HardQuads {
        clip_from_world: view.clip_from_world,
        offsets: light.is_far(),
    };
    Some(Piece {
        label: if entered > 0 {
            "quads entered"
        } else {
            "quads left"
        },
        vertex: vertex.stage(),
        primitive: passes::clamped(),
        entered,
        is_quad: true,
        geometry: Some((Arc::new(vertices), Arc::new(indices))),
    })
}
