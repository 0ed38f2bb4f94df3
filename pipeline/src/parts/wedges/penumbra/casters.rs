//! The soft volumes of casters, light after light.

use glam::DVec3;

use super::light::LightSphere;
use super::report::LinkedReport;
use super::volume::SoftVolume;
use crate::geometry::caster::Counting;
use crate::geometry::silhouette::{Orientation, Silhouette};
use crate::geometry::silhouette_loops::SilhouetteLoops;
use crate::geometry::slivers::{Slivers, facing};
use crate::geometry::volume::{select, turned};
use crate::geometry::wedge::paper1::LinkedSettings;
use crate::parts::casters::Examined;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

impl Examined<'_> {
    /// The wedges and the front volume for a spherical light, to `length` behind
    /// each silhouette loop or to infinity; `met` counts what was special.
    pub(crate) fn soft_volume(
        &self,
        sphere: &LightSphere,
        settings: &LinkedSettings,
        length: Option<f64>,
        met: &mut LinkedReport,
    ) -> SoftVolume {
        let mesh = &self.object.mesh;
        let light = HardLight::Point(sphere.centre);
        // A loop round a needle would have wedges as wide as any.
        let facing = facing(mesh, self.caster.adjacency(), light, Slivers::Needles);
        let counting = self.caster.counting(mesh, light);
        let (orientation, cap) = match counting {
            Counting::LightFacing => (Orientation::closed(&facing), select(mesh, &facing, true)),
            Counting::AllTriangles => (
                Orientation::generalised(&facing),
                turned(mesh, &facing, true),
            ),
        };
        let loops = self.loops(mesh, &orientation, met);
        let encloses = counting == Counting::AllTriangles && self.caster.report().is_closed();
        let length = length.filter(|_| !encloses);
        let volume = SoftVolume::new(&loops, cap, sphere, settings, length, met);
        if encloses {
            return volume.enclosing(mesh, sphere.centre);
        }
        volume
    }

    /// Points along each silhouette loop.
    fn loops(
        &self,
        mesh: &Mesh,
        orientation: &Orientation,
        met: &mut LinkedReport,
    ) -> Vec<Vec<DVec3>> {
        let silhouette = Silhouette::new(mesh, self.caster.adjacency(), orientation);
        // Silhouettes of orientations always balance; none is drawn if not.
        let Ok(loops) = SilhouetteLoops::new(&silhouette) else {
            met.unbalanced += 1;
            return Vec::new();
        };
        met.loops += loops.loops.len() as u64;
        loops
            .vertices(&silhouette)
            .map(|indices| indices.iter().map(|&i| mesh.position(i)).collect())
            .collect()
    }
}
