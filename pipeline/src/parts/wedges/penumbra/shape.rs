//! The triangles of a wedge, the front plane's apart from the others.

use std::sync::Arc;

use glam::DVec4;
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, TextureBinding, VertexBuffer};

use super::volume::Triangle;
use crate::geometry::wedge::paper1::{LinkedWedge, Overlap};
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
    /// The umbra's boundary.
    pub(crate) front: Faces,
    /// All other faces; `None` where the boundary is more than the wedge's front
    /// face, because the side planes meet in the front plane.
    pub(crate) others: Option<Faces>,
    /// All faces of the wedge.
    pub(crate) all: Faces,
}

impl WedgeShape {
    pub(crate) fn new(view: &View, wedge: &LinkedWedge) -> Self {
        let mesh = wedge.mesh();
        let vertices = Arc::new(homogeneous(view, &mesh.vertices));
        let faces = |triangles: &[[u32; 3]]| Faces {
            vertices: vertices.clone(),
            indices: passes::index_buffer(triangles),
        };
        let corners = front_corners(wedge);
        let in_front = |t: &&[u32; 3]| {
            t.iter()
                .all(|&i| corners.contains(&mesh.vertices[i as usize]))
        };
        let (front, others): (Vec<&[u32; 3]>, Vec<_>) = mesh.triangles.iter().partition(in_front);
        let expected = if wedge.edge[0] == wedge.edge[1] { 1 } else { 2 };
        let all = faces(&mesh.triangles);
        let cut = matches!(wedge.overlap(), Some(Overlap::Front(_) | Overlap::Both(_)));
        if cut || front.len() != expected {
            return Self {
                front: triangles(view, &wedge.front_quad()),
                others: None,
                all,
            };
        }
        let owned = |list: Vec<&[u32; 3]>| list.into_iter().copied().collect::<Vec<_>>();
        Self {
            front: faces(&owned(front)),
            others: Some(faces(&owned(others))),
            all,
        }
    }
}

fn front_corners(wedge: &LinkedWedge) -> [DVec4; 4] {
    let [a, b] = wedge.edge.map(|p| p.extend(1.0));
    let [r, s] = wedge.front_rays.map(|d| d.extend(0.0));
    [a, b, r, s]
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
