//! Which meshes may cast, and which volume each gets.
//!
//! A closed caster uses light-facing triangles only. A caster that is not
//! closed would leave stray stencil counts, so it is refused, unless the user
//! asks for the generalised silhouette, which is right for any mesh at about
//! twice the fill.

use thiserror::Error;

use crate::geometry::volume::ShadowVolume;
use crate::geometry::winding::mesh_winding;
use crate::world::adjacency::{ClosednessReport, EdgeAdjacency};
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;
use crate::world::scene::Object;

/// What to do with casters that are not closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CasterPolicy {
    /// Refuse them with a message that says what is wrong.
    #[default]
    RequireClosed,
    /// Give them the generalised, multiplicity-weighted silhouette.
    Generalised,
    /// That for objects which may be open, as [`Object::open`] says; refuse others. What
    /// techniques do that are told nothing.
    AsObjectsSay,
}

impl CasterPolicy {
    /// Values of the parameter `open-casters`.
    pub const NAMES: [&str; 2] = ["refuse", "generalised"];

    /// The parameter value that selects this policy, or that stands where none is given.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RequireClosed | Self::AsObjectsSay => Self::NAMES[0],
            Self::Generalised => Self::NAMES[1],
        }
    }

    /// Whether an open `object` may cast.
    fn allows(self, object: &Object) -> bool {
        match self {
            Self::RequireClosed => false,
            Self::Generalised => true,
            Self::AsObjectsSay => object.open,
        }
    }
}

/// A caster that is not closed, under [`CasterPolicy::RequireClosed`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "object '{object}' is not closed and cannot cast a shadow volume: {report}. \
     Close the mesh, let it only receive, or ask for the generalised silhouette \
     with --set open-casters=generalised (compare: --set TECHNIQUE.open-casters=generalised)"
)]
pub struct RefusedCaster {
    /// Name of the object.
    pub object: String,
    /// What is wrong with its mesh.
    pub report: Box<ClosednessReport>,
}

/// Which triangles of a caster count as blockers, one each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counting {
    /// Light-facing triangles: each layer of a closed caster counts once.
    LightFacing,
    /// All triangles: a closed caster would count twice.
    AllTriangles,
}

/// A mesh examined as a caster; independent of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct Caster {
    adjacency: EdgeAdjacency,
    report: ClosednessReport,
}

impl Caster {
    /// Examines the mesh, whatever its state.
    pub fn new(mesh: &Mesh) -> Self {
        let adjacency = EdgeAdjacency::new(mesh.triangles());
        let report = adjacency.closedness(mesh);
        Self { adjacency, report }
    }

    /// Examines an object under a policy.
    ///
    /// # Errors
    /// The mesh is not closed and the policy requires it.
    pub fn of_object(object: &Object, policy: CasterPolicy) -> Result<Self, RefusedCaster> {
        let caster = Self::new(&object.mesh);
        if caster.report.is_closed() || policy.allows(object) {
            return Ok(caster);
        }
        Err(RefusedCaster {
            object: object.name.clone(),
            report: Box::new(caster.report),
        })
    }

    /// Edge adjacency of the mesh.
    pub fn adjacency(&self) -> &EdgeAdjacency {
        &self.adjacency
    }

    /// What is wrong with the mesh, if anything.
    pub fn report(&self) -> &ClosednessReport {
        &self.report
    }

    /// Which triangles block the light: the light-facing ones of a closed mesh
    /// that does not enclose the light, else all. `mesh` must be the one examined.
    pub fn counting(&self, mesh: &Mesh, light: HardLight) -> Counting {
        if self.report.is_closed() && !encloses(mesh, light) {
            Counting::LightFacing
        } else {
            Counting::AllTriangles
        }
    }

    /// The shadow volume for `light`, by [`Caster::counting`].
    pub fn volume(&self, mesh: &Mesh, light: HardLight) -> ShadowVolume {
        match self.counting(mesh, light) {
            Counting::LightFacing => ShadowVolume::of_closed(mesh, &self.adjacency, light),
            Counting::AllTriangles => ShadowVolume::generalised(mesh, &self.adjacency, light),
        }
    }
}

/// Whether a point light is inside the closed mesh. Solid angles are slow, so
/// the bounding box decides first.
fn encloses(mesh: &Mesh, light: HardLight) -> bool {
    let (HardLight::Point(p), Some((low, high))) = (light, mesh.bounds()) else {
        return false;
    };
    p.cmpge(low).all() && p.cmple(high).all() && mesh_winding(mesh, p) != 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::winding::volume_winding;
    use crate::world::mesh::Shading;
    use crate::world::scene::Material;
    use crate::world::shape;
    use glam::DVec3;

    fn open_cylinder() -> Object {
        let mut shape = shape::cylinder(32, 0.5, 0.0, 1.5);
        shape.triangles.drain(64..96);
        let mesh = shape.into_mesh(Shading::Smooth).unwrap();
        Object::new("tin", mesh, Material::matt([1.0; 3]))
    }

    #[test]
    fn an_open_caster_is_refused_with_names_and_counts() {
        let refused = Caster::of_object(&open_cylinder(), CasterPolicy::RequireClosed);
        let message = refused.unwrap_err().to_string();
        for part in [
            "'tin'",
            "32 boundary",
            "0-1 (used 1x)",
            "open-casters=generalised",
        ] {
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn an_open_caster_is_right_when_generalised() {
        let tin = open_cylinder();
        let caster = Caster::of_object(&tin, CasterPolicy::Generalised).unwrap();
        let volume = caster.volume(
            &tin.mesh,
            HardLight::Directional(DVec3::new(0.0, 1.0, 0.01)),
        );
        // Below the rim only the lid blocks (and not the side walls).
        assert_eq!(volume_winding(&volume, DVec3::new(0.1, -1.0, 0.1)), 1);
        assert_eq!(volume_winding(&volume, DVec3::new(0.8, -1.0, 0.1)), 0);
    }

    #[test]
    fn a_light_inside_a_closed_caster_lights_the_inside_only() {
        let room = shape::cuboid(DVec3::ZERO, DVec3::splat(4.0))
            .into_mesh(Shading::Flat)
            .unwrap();
        let caster = Caster::new(&room);
        let light = HardLight::Point(DVec3::new(0.3, 1.0, 0.2));
        assert_eq!(caster.counting(&room, light), Counting::AllTriangles);
        let volume = caster.volume(&room, light);
        assert_eq!(volume_winding(&volume, DVec3::new(1.0, -1.0, 0.5)), 0);
        assert_eq!(volume_winding(&volume, DVec3::new(5.0, -1.0, 0.5)), 1);
    }
}
