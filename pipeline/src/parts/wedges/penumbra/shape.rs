//! The triangles of a wedge, the front plane's apart from the others.

use std::sync::Arc;

use glam::DVec4;
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, TextureBinding, VertexBuffer};

use super::volume::Triangle;
use crate::geometry::wedge::paper1::WedgeParts;
use crate::parts::passes::{self, View};
use crate::parts::visibility::homogeneous;

/// Triangles of one kind, ready to draw.
#[derive(Clone)]
pub(crate) struct Faces {
    pub(crate) vertices: Arc<VertexBuffer>,
    pub(crate) indices: Arc<IndexBuffer>,
}

impl Faces {
    pub(crate) fn draw(
        &self,
        label: &str,
        pipeline: RenderPipeline,
        textures: Vec<TextureBinding>,
    ) -> Draw {
        Draw {
            textures,
            ..Draw::indexed(label, &Arc::new(pipeline), &self.vertices, &self.indices)
        }
    }
}

/// How a wedge is drawn.
pub(crate) struct WedgeShape {
    /// The wedge's front face.
    pub(crate) front: Faces,
    /// Boundary of the umbra that is none of the wedge, where its side planes meet in
    /// the front plane.
    pub(crate) beyond: Option<Faces>,
    /// All other faces; with the front face they close the wedge.
    pub(crate) others: Faces,
    /// Everything of the wedge, to find where it may be seen.
    pub(crate) whole: Vec<Triangle>,
}

impl WedgeShape {
    pub(crate) fn new(view: &View, parts: WedgeParts) -> Self {
        let beyond = &parts.beyond;
        Self {
            front: triangles(view, &parts.front),
            beyond: (!beyond.is_empty()).then(|| triangles(view, beyond)),
            others: triangles(view, &parts.others),
            whole: [parts.front, parts.others].concat(),
        }
    }
}

/// Triangles with corners of their own.
pub(crate) fn triangles(view: &View, list: &[Triangle]) -> Faces {
    let corners: Vec<DVec4> = list.iter().flatten().copied().collect();
    let indices: Vec<[u32; 3]> = (0..list.len() as u32)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    Faces {
        vertices: Arc::new(homogeneous(view, &corners)),
        indices: passes::index_buffer(&indices),
    }
}
