//! What views are fitted to: the receivers that the camera sees and the casters.

use std::sync::OnceLock;

use glam::DVec3;

use crate::geometry::winding::mesh_winding;
use crate::world::adjacency::EdgeAdjacency;
use crate::world::mesh::Mesh;
use crate::world::scene::{Pyramid, Scene};

/// Receivers and casters of a scene, gathered once for all its lights.
pub(crate) struct Surroundings<'a> {
    /// Corners of the receivers' triangles inside the camera's pyramid.
    corners: Vec<DVec3>,
    /// Where each polygon's corners end.
    ends: Vec<usize>,
    /// What each polygon is a part of.
    owners: Vec<Owner>,
    /// Casters: number in the scene, and mesh.
    pub(super) casters: Vec<(usize, &'a Mesh)>,
    scene: &'a Scene,
    /// Whether each polygon is on the far side of its object; found when asked for.
    hidden: OnceLock<Vec<bool>>,
}

/// A triangle of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Owner {
    /// Number in the scene.
    pub(crate) object: usize,
    /// Number in the mesh.
    pub(crate) triangle: usize,
}

impl<'a> Surroundings<'a> {
    /// Of a picture of `size` (width, height).
    pub(crate) fn new(scene: &'a Scene, size: [u32; 2]) -> Self {
        let mut all = Self {
            corners: Vec::new(),
            ends: Vec::new(),
            owners: Vec::new(),
            casters: Vec::new(),
            scene,
            hidden: OnceLock::new(),
        };
        let pyramid = Pyramid::new(&scene.camera, size);
        for (number, object) in scene.objects.iter().enumerate() {
            if object.receives {
                all.gather(number, &object.mesh, &pyramid);
            }
            if object.casts && !object.mesh.triangles().is_empty() {
                all.casters.push((number, &object.mesh));
            }
        }
        all
    }

    fn gather(&mut self, object: usize, mesh: &Mesh, pyramid: &Pyramid) {
        let (mut polygon, mut scratch) = (Vec::new(), Vec::new());
        for triangle in 0..mesh.triangles().len() {
            polygon.clear();
            polygon.extend(mesh.corners(triangle));
            pyramid.clip(&mut polygon, &mut scratch);
            if !polygon.is_empty() {
                self.corners.extend_from_slice(&polygon);
                self.ends.push(self.corners.len());
                self.owners.push(Owner { object, triangle });
            }
        }
    }

    /// Casters: number in the scene, and mesh.
    pub(crate) fn casters(&self) -> &[(usize, &'a Mesh)] {
        &self.casters
    }

    /// Convex polygons, world space, whose union holds every receiver seen.
    pub(super) fn receivers(&self) -> impl Iterator<Item = &[DVec3]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let polygon = &self.corners[start..end];
            start = end;
            polygon
        })
    }

    /// The same with the triangles that they are parts of.
    pub(crate) fn owned_receivers(&self) -> impl Iterator<Item = (Owner, &[DVec3])> {
        self.owners.iter().copied().zip(self.receivers())
    }

    /// The same without those on the far side of a closed object, which are not seen.
    pub(super) fn seen_receivers(&self) -> impl Iterator<Item = &[DVec3]> {
        let hidden = self.hidden.get_or_init(|| self.find_hidden());
        let all = self.receivers().zip(hidden);
        all.filter(|(_, hidden)| !**hidden)
            .map(|(polygon, _)| polygon)
    }

    fn find_hidden(&self) -> Vec<bool> {
        let eye = self.scene.camera.eye;
        let objects = self.scene.objects.iter();
        let outwards: Vec<f64> = objects.map(|o| outwards(&o.mesh, eye)).collect();
        let hidden = |owner: &Owner| {
            let mesh = &self.scene.objects[owner.object].mesh;
            let [a, b, c] = mesh.corners(owner.triangle);
            outwards[owner.object] * (b - a).cross(c - a).dot(eye - a) < 0.0
        };
        self.owners.iter().map(hidden).collect()
    }

    /// Largest distance of a receiver's corner from a point.
    pub(super) fn radius(&self, from: DVec3) -> f64 {
        let distances = self.corners.iter().map(|p| (*p - from).length());
        distances.fold(0.0, f64::max)
    }

    /// Mean of the receivers' corners; `None` where nothing is seen.
    pub(crate) fn middle(&self) -> Option<DVec3> {
        let count = self.corners.len() as f64;
        let sum = self.corners.iter().sum::<DVec3>();
        (count > 0.0).then(|| sum / count)
    }
}

/// 1 where the mesh's triangles face outwards, -1 where they face inwards; 0 where it
/// is open or the eye is inside, so that both sides may be seen.
fn outwards(mesh: &Mesh, eye: DVec3) -> f64 {
    let edges = EdgeAdjacency::new(mesh.triangles());
    if edges.closedness(mesh).is_closed() && mesh_winding(mesh, eye) == 0 {
        mesh.signed_volume().signum()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    #[test]
    fn receivers_are_what_the_camera_sees() {
        let scene = builtin::build("cylinder").unwrap();
        let size = [96, 64];
        let seen = Surroundings::new(&scene, size);
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let clip = scene.camera.clip_from_world(aspect);
        for p in seen.receivers().flatten() {
            let row = |r: usize| {
                let m = clip[r].map(f64::from);
                m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3]
            };
            let w = row(3) * (1.0 + 1e-5);
            assert!(row(0).abs() <= w && row(1).abs() <= w && w > 0.0, "{p}");
        }
        // The floor is far larger than what is seen of it, and the caster is seen.
        assert!(seen.receivers().count() > 10);
        let cut = |p: &&DVec3| p.y == 0.0 && p.x.abs() < 5.0 && p.z.abs() < 5.0;
        assert!(seen.receivers().flatten().filter(cut).count() > 2);
        assert_eq!(seen.casters.len(), 1);
    }

    #[test]
    fn nothing_is_seen_by_a_camera_that_looks_away() {
        let mut scene = builtin::build("cylinder").unwrap();
        scene.camera.target = scene.camera.eye + DVec3::new(0.0, 5.0, 1.0);
        let seen = Surroundings::new(&scene, [96, 64]);
        assert_eq!((seen.receivers().count(), seen.middle()), (0, None));
    }
}
