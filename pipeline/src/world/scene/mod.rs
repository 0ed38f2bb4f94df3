//! Scenes: what is drawn, what casts, what receives, from where it is seen.

pub mod builtin;
mod camera;
pub mod environment;
pub mod file;
mod frame_model;
mod near;
mod open;
mod placed;
mod pyramid;
mod rest;
mod source;
mod view;
mod view_warnings;

use std::sync::Arc;

use glam::DVec3;

pub use camera::{Camera, EyeRays};
pub use frame_model::{frame_model, load_and_frame};
pub use open::{SceneError, open};
pub use placed::PlacedError;
pub(crate) use pyramid::{Pyramid, clip, clip_with};
pub use rest::Rest;
pub use source::SceneSource;
pub use view::{View, ViewError};

pub use crate::world::material::{Material, MaterialPart};
pub use crate::world::texture::{CornerCoordinates, SurfaceTexture};
pub use crate::world::warning::SceneWarning;

use crate::world::environment::{MapSource, PlacedEnvironment};
use crate::world::light::{Light, LightShape};
use crate::world::light_image::LightImage;
use crate::world::mesh::Mesh;

/// A complete scene: everything in world space, nothing left to look up.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Name for reports and file names.
    pub name: String,
    /// The eye.
    pub camera: Camera,
    /// At least one light.
    pub lights: Vec<Light>,
    /// Objects in drawing order.
    pub objects: Vec<Object>,
    /// Linear RGB light that reaches everything, shadowed or not.
    pub ambient: [f32; 3],
    /// What is added to each colour of it per unit of a surface's normal.
    pub ambient_slope: [[f32; 3]; 3],
    /// Linear RGB where no surface is seen.
    pub background: [f32; 3],
    /// What is seen there instead, if it is a map.
    pub backdrop: Option<Arc<MapSource>>,
    /// Image width and height asked for by a scene file.
    pub size: Option<[u32; 2]>,
    /// What the lights stand for, if they were fitted to a map.
    pub environment: Option<Arc<PlacedEnvironment>>,
    /// What was found amiss when the scene was made, without stopping it.
    pub warnings: Vec<SceneWarning>,
}

impl Scene {
    /// A nameless scene with a dim ambient light on a dark background.
    pub fn new(camera: Camera, lights: Vec<Light>, objects: Vec<Object>) -> Self {
        Self {
            name: String::new(),
            camera,
            lights,
            objects,
            ambient: [0.15; 3],
            ambient_slope: [[0.0; 3]; 3],
            background: [0.05, 0.06, 0.08],
            backdrop: None,
            size: None,
            environment: None,
            warnings: Vec::new(),
        }
    }

    /// Objects that cast shadows, in drawing order.
    pub fn casters(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().filter(|o| o.casts)
    }

    /// The same with the colours of its rectangles multiplied by those of an image that
    /// they have.
    #[must_use]
    pub fn with_light_image(&self, image: &LightImage) -> Self {
        let mut scene = self.clone();
        let means = image.means();
        for light in &mut scene.lights {
            if matches!(light.shape, LightShape::Rectangle { .. }) {
                light.colour = [0, 1, 2].map(|c| light.colour[c] * means[c] as f32);
            }
        }
        scene
    }

    /// The same without ambient light.
    #[must_use]
    pub fn without_ambient(&self) -> Self {
        Self {
            ambient: [0.0; 3],
            ambient_slope: [[0.0; 3]; 3],
            ..self.clone()
        }
    }

    /// Linear RGB where no surface is seen, in a direction that is not zero.
    pub fn behind(&self, towards: DVec3) -> [f32; 3] {
        match &self.backdrop {
            Some(map) => map.radiance(towards).map(|v| v as f32),
            None => self.background,
        }
    }

    /// Triangles of all objects.
    pub fn triangle_count(&self) -> usize {
        self.objects.iter().map(|o| o.mesh.triangles().len()).sum()
    }
}

/// A mesh with a material and its part in shadowing.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name for messages and reports.
    pub name: String,
    /// World-space geometry.
    pub mesh: Arc<Mesh>,
    /// Whether it casts shadow.
    pub casts: bool,
    /// Whether shadow falls on it.
    pub receives: bool,
    /// How it is shaded.
    pub material: Material,
    /// Triangles that are shaded differently; each is in one part at most.
    pub parts: Vec<MaterialPart>,
    /// Of each triangle the texture coordinates of its corners; none where the mesh has none.
    pub coordinates: Option<Arc<[CornerCoordinates]>>,
    /// Where the object was before it moved as a whole, if that is known.
    pub rest: Option<Rest>,
    /// Whether it may cast though its mesh is not closed, by its generalised silhouette.
    pub open: bool,
}

impl Object {
    /// An object that casts and receives.
    pub fn new(name: impl Into<String>, mesh: Mesh, material: Material) -> Self {
        Self {
            name: name.into(),
            mesh: Arc::new(mesh),
            casts: true,
            receives: true,
            material,
            parts: Vec::new(),
            coordinates: None,
            rest: None,
            open: false,
        }
    }

    /// All triangles by material: those of no part first, then part after part.
    pub fn painted(&self) -> Vec<MaterialPart> {
        let count = self.mesh.triangles().len() as u32;
        let mut own = vec![true; count as usize];
        for &t in self.parts.iter().flat_map(|p| &p.triangles) {
            if let Some(own) = own.get_mut(t as usize) {
                *own = false;
            }
        }
        let rest = MaterialPart {
            material: self.material,
            texture: None,
            triangles: (0..count).filter(|&t| own[t as usize]).collect(),
        };
        std::iter::once(rest)
            .chain(self.parts.iter().cloned())
            .filter(|p| !p.triangles.is_empty())
            .collect()
    }

    /// Texture coordinates of a triangle's corners; zeros where there are none.
    pub fn coordinates_of(&self, triangle: u32) -> CornerCoordinates {
        let all = self.coordinates.as_deref().unwrap_or_default();
        all.get(triangle as usize).copied().unwrap_or_default()
    }

    /// The same object, casting nothing (sheets such as floors).
    pub fn receiver_only(mut self) -> Self {
        self.casts = false;
        self
    }
}
