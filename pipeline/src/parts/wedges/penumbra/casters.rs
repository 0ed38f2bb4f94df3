//! The soft volumes of casters, light after light.

use glam::DVec3;

use super::light::LightSphere;
use super::report::LinkedReport;
use super::volume::SoftVolume;
use crate::geometry::silhouette_loops::SilhouetteLoops;
use crate::geometry::wedge::paper1::LinkedSettings;
use crate::parts::casters::Examined;
use crate::world::light::HardLight;
use crate::world::mesh::Mesh;

impl Examined<'_> {
    /// The wedges and the front volume for a spherical light; `met` counts what
    /// was special.
    pub(crate) fn soft_volume(
        &self,
        sphere: &LightSphere,
        settings: &LinkedSettings,
        met: &mut LinkedReport,
    ) -> SoftVolume {
        let mesh = &self.object.mesh;
        let light = HardLight::Point(sphere.centre);
        let loops = self.loops(mesh, light, met);
        let cap = self.caster.volume(mesh, light).light_cap().to_vec();
        SoftVolume::new(&loops, cap, sphere, settings, met)
    }

    /// Points along each silhouette loop.
    fn loops(&self, mesh: &Mesh, light: HardLight, met: &mut LinkedReport) -> Vec<Vec<DVec3>> {
        let silhouette = self.silhouette(light);
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
