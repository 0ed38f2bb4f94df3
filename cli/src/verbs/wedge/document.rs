//! The JSON documents of `gnomon wedge`.

use gnomon_pipeline::geometry::wedge::{Plane, Wedge, WedgeMesh};
use gnomon_pipeline::measure::visibility_sum::SilhouetteEdge;
use gnomon_pipeline::world::scene::Scene;
use serde::Serialize;

use super::run::Shown;
use super::text::construction;

/// All silhouette edges.
#[derive(Serialize)]
pub(super) struct EdgesDocument<'a> {
    scene: &'a str,
    light: usize,
    edges: Vec<EdgeDocument<'a>>,
}

#[derive(Serialize)]
struct EdgeDocument<'a> {
    edge: usize,
    object: &'a str,
    vertices: [u32; 2],
    ends: [[f64; 3]; 2],
}

/// One edge with its wedges.
#[derive(Serialize)]
pub(super) struct WedgeDocument<'a> {
    scene: &'a str,
    light: usize,
    #[serde(flatten)]
    edge: EdgeDocument<'a>,
    construction: &'static str,
    wedges: Vec<WedgePart>,
    size: [u32; 2],
    pixels_adding: usize,
    most_added: f64,
    pixels_taking: usize,
    most_taken: f64,
}

#[derive(Serialize)]
struct WedgePart {
    construction: &'static str,
    /// `[a, b, c, d]` with `a x + b y + c z + d` positive inside.
    planes: Vec<[f64; 4]>,
    hard_plane: Option<[f64; 4]>,
    hard_quad: [[f64; 4]; 4],
    mesh: MeshDocument,
    outer: Option<MeshDocument>,
    inner: Option<MeshDocument>,
}

/// Homogeneous vertices, w = 0 at infinity, and triangles.
#[derive(Serialize)]
struct MeshDocument {
    vertices: Vec<[f64; 4]>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> EdgesDocument<'a> {
    pub(super) fn new(scene: &'a Scene, light: usize, edges: &[SilhouetteEdge]) -> Self {
        let edges = edges.iter().enumerate();
        Self {
            scene: &scene.name,
            light,
            edges: edges.map(|(n, e)| EdgeDocument::new(scene, n, e)).collect(),
        }
    }
}

impl<'a> EdgeDocument<'a> {
    fn new(scene: &'a Scene, number: usize, edge: &SilhouetteEdge) -> Self {
        Self {
            edge: number,
            object: &scene.objects[edge.object].name,
            vertices: edge.vertices,
            ends: edge.ends.map(|e| e.to_array()),
        }
    }
}

impl<'a> WedgeDocument<'a> {
    pub(super) fn new(shown: &Shown<'a>) -> Self {
        let totals = shown.map.totals();
        Self {
            scene: &shown.scene.name,
            light: shown.light,
            edge: EdgeDocument::new(shown.scene, shown.number, &shown.edge),
            construction: shown.construction,
            wedges: shown.wedges.iter().map(WedgePart::new).collect(),
            size: shown.map.size,
            pixels_adding: totals.adding,
            most_added: totals.most_added,
            pixels_taking: totals.taking,
            most_taken: totals.most_taken,
        }
    }
}

impl WedgePart {
    fn new(wedge: &Wedge) -> Self {
        let halves = wedge.halves();
        let planes = wedge.volume.planes().iter();
        Self {
            construction: construction(wedge.construction),
            planes: planes.map(Plane::coefficients).collect(),
            hard_plane: wedge.hard_plane().map(|p| p.coefficients()),
            hard_quad: wedge.hard_quad().map(|v| v.to_array()),
            mesh: MeshDocument::new(&wedge.volume.mesh()),
            outer: halves.as_ref().map(|h| MeshDocument::new(&h.outer)),
            inner: halves.as_ref().map(|h| MeshDocument::new(&h.inner)),
        }
    }
}

impl MeshDocument {
    fn new(mesh: &WedgeMesh) -> Self {
        Self {
            vertices: mesh.vertices.iter().map(|v| v.to_array()).collect(),
            triangles: mesh.triangles.clone(),
        }
    }
}
