//! A scene in other units, somewhere else.

use std::sync::Arc;

use glam::DVec3;

use super::{Camera, Scene};
use crate::world::error::{MeshError, PolygonError};
use crate::world::light::{ConvexPolygon, LightShape};
use crate::world::mesh::{Mesh, Shading, narrow, widen};

/// Why a scene cannot be where it was asked for.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum PlacedError {
    /// A mesh leaves the range of f32.
    #[error("object '{object}' cannot be placed there: {source}")]
    Mesh {
        /// Name of the object.
        object: String,
        /// What is wrong with its mesh.
        source: MeshError,
    },
    /// A polygon light degenerates.
    #[error("light {light} cannot be placed there: {source}")]
    Light {
        /// Number of the light.
        light: usize,
        /// What is wrong with it.
        source: PolygonError,
    },
}

impl Scene {
    /// The scene scaled about the world's origin, then moved; camera, near plane
    /// and lights with it. Mesh positions are rounded to f32 once, where they come
    /// to lie; shading is flat.
    ///
    /// # Errors
    /// Positions leave the range of f32, or a polygon light has no extent there.
    pub fn placed(&self, scale: f64, offset: DVec3) -> Result<Self, PlacedError> {
        let place = |p: DVec3| p * scale + offset;
        let mut placed = self.clone();
        placed.camera = Camera {
            eye: place(self.camera.eye),
            target: place(self.camera.target),
            near: self.camera.near * scale,
            ..self.camera
        };
        for object in &mut placed.objects {
            let positions = object.mesh.positions().iter();
            let positions = positions.map(|p| narrow(place(widen(*p)))).collect();
            object.rest = None;
            let mesh = Mesh::new(positions, object.mesh.triangles().to_vec(), Shading::Flat);
            object.mesh = Arc::new(mesh.map_err(|source| PlacedError::Mesh {
                object: object.name.clone(),
                source,
            })?);
        }
        for (number, light) in placed.lights.iter_mut().enumerate() {
            place_light(&mut light.shape, scale, place).map_err(|source| PlacedError::Light {
                light: number,
                source,
            })?;
        }
        Ok(placed)
    }
}

fn place_light(
    shape: &mut LightShape,
    scale: f64,
    place: impl Fn(DVec3) -> DVec3,
) -> Result<(), PolygonError> {
    match shape {
        LightShape::Point { position } => *position = place(*position),
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => {
            *centre = place(*centre);
            *edge_u *= scale;
            *edge_v *= scale;
        }
        LightShape::Polygon(polygon) => {
            let vertices: Vec<DVec3> = polygon.vertices().iter().map(|v| place(*v)).collect();
            *polygon = ConvexPolygon::new(vertices)?;
        }
        LightShape::Disc { centre, radius, .. } | LightShape::Sphere { centre, radius } => {
            *centre = place(*centre);
            *radius *= scale;
        }
        LightShape::Directional { .. } => {}
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    #[test]
    fn everything_is_scaled_and_moved() {
        let scene = builtin::build("cylinder").unwrap();
        let offset = DVec3::new(8.0, 0.0, -16.0);
        let placed = scene.placed(4.0, offset).unwrap();
        assert_eq!(placed.camera.eye, scene.camera.eye * 4.0 + offset);
        assert_eq!(placed.camera.near, scene.camera.near * 4.0);
        let [a, b] = [&scene, &placed].map(|s| s.objects[1].mesh.bounds().unwrap());
        assert!((b.0 - (a.0 * 4.0 + offset)).length() < 1e-5);
        assert!((b.1 - (a.1 * 4.0 + offset)).length() < 1e-5);
        let back = placed.placed(0.25, offset * -0.25).unwrap();
        assert_eq!(back.lights, scene.lights);
    }

    #[test]
    fn what_leaves_the_range_is_refused_by_name() {
        let scene = builtin::build("cylinder").unwrap();
        let error = scene.placed(1e300, DVec3::ZERO).unwrap_err();
        assert!(error.to_string().contains("'floor'"), "{error}");
    }
}
