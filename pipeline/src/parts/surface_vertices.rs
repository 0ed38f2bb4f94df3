//! Vertices of an object's surface, and which triangles are left of each of its own.

use super::view::View;
use crate::world::scene::{CornerCoordinates, Object};

/// Floats of a vertex: its position and its normal.
pub(crate) const STRIDE: usize = 6;

/// What is drawn of an object.
pub(crate) struct SurfaceVertices {
    /// Six floats each: position and normal.
    pub(crate) data: Vec<f32>,
    /// Texture coordinates of each vertex, where they are not those of the mesh's corners.
    pub(crate) coordinates: Option<Vec<[f32; 2]>>,
    triangles: Vec<[u32; 3]>,
    /// Where in `triangles` those of each of the mesh's end.
    ends: Vec<usize>,
}

impl SurfaceVertices {
    /// No vertex, and no triangle of the mesh yet.
    pub(crate) fn new() -> Self {
        Self {
            data: Vec::new(),
            coordinates: Some(Vec::new()),
            triangles: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// All of an object, each triangle as it is.
    pub(crate) fn whole(object: &Object, view: &View) -> Self {
        let shading = object.mesh.shading_vertices();
        let rows = shading.positions.iter().zip(&shading.normals);
        Self {
            data: rows
                .flat_map(|(p, n)| view.point(*p).into_iter().chain(*n))
                .collect(),
            coordinates: None,
            ends: (1..=shading.triangles.len()).collect(),
            triangles: shading.triangles,
        }
    }

    /// Number of vertices so far.
    pub(crate) fn len(&self) -> u32 {
        (self.data.len() / STRIDE) as u32
    }

    /// Adds what is left of the mesh's next triangle.
    pub(crate) fn push(&mut self, triangles: impl IntoIterator<Item = [u32; 3]>) {
        self.triangles.extend(triangles);
        self.ends.push(self.triangles.len());
    }

    /// Texture coordinates of the corners of `triangle`, which is left of triangle `t`.
    pub(crate) fn coordinates_of(
        &self,
        object: &Object,
        t: u32,
        triangle: [u32; 3],
    ) -> CornerCoordinates {
        match &self.coordinates {
            Some(own) => triangle.map(|v| own[v as usize]),
            None => object.coordinates_of(t),
        }
    }

    /// What is left of triangle `t` of the mesh.
    pub(crate) fn of(&self, t: u32) -> &[[u32; 3]] {
        let t = t as usize;
        let begin = t.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.triangles[begin..self.ends[t]]
    }
}
