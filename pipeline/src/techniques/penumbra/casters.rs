//! The casters of a scene and their soft volumes, light after light.

use glam::DVec3;

use super::light::LightSphere;
use super::report::Met;
use super::volume::SoftVolume;
use crate::caster::{Caster, CasterPolicy, Counting, UnknownPolicy};
use crate::light::HardLight;
use crate::mesh::Mesh;
use crate::scene::{Object, Scene};
use crate::silhouette::{Orientation, Silhouette, light_facing};
use crate::silhouette_loops::SilhouetteLoops;
use crate::technique::{ParamInfo, Params, TechniqueError};
use crate::wedge::paper1::LinkedSettings;

pub(in crate::techniques) const OPEN_CASTERS: ParamInfo = ParamInfo {
    name: "open-casters",
    default: "refuse",
    valid: "refuse|generalised",
    summary: "casters that are not closed: refuse them, or use the multiplicity-weighted silhouette",
};

/// A caster of a scene, examined once for all lights.
pub(in crate::techniques) struct Examined<'a> {
    /// Index into [`Scene::objects`].
    pub(in crate::techniques) number: usize,
    pub(in crate::techniques) object: &'a Object,
    pub(in crate::techniques) caster: Caster,
}

/// All casters of the scene.
pub(in crate::techniques) fn examine<'a>(
    scene: &'a Scene,
    technique: &'static str,
    params: &Params,
) -> Result<Vec<Examined<'a>>, TechniqueError> {
    let given = params.get(OPEN_CASTERS.name);
    let policy: CasterPolicy =
        given
            .parse()
            .map_err(|UnknownPolicy(value)| TechniqueError::BadValue {
                technique,
                key: OPEN_CASTERS.name,
                value,
                valid: OPEN_CASTERS.valid,
            })?;
    let objects = scene.objects.iter().enumerate();
    objects
        .filter(|(_, o)| o.casts && !o.mesh.triangles().is_empty())
        .map(|(number, object)| {
            let caster = Caster::of_object(object, policy)?;
            Ok(Examined {
                number,
                object,
                caster,
            })
        })
        .collect()
}

impl Examined<'_> {
    /// The wedges and the front volume for a spherical light; `met` counts what
    /// was special.
    pub(in crate::techniques) fn soft_volume(
        &self,
        sphere: &LightSphere,
        settings: &LinkedSettings,
        met: &mut Met,
    ) -> SoftVolume {
        let mesh = &self.object.mesh;
        let light = HardLight::Point(sphere.centre);
        let loops = self.loops(mesh, light, met);
        let cap = self.caster.volume(mesh, light).light_cap().to_vec();
        SoftVolume::new(&loops, cap, sphere, settings, met)
    }

    /// Points along each silhouette loop.
    fn loops(&self, mesh: &Mesh, light: HardLight, met: &mut Met) -> Vec<Vec<DVec3>> {
        let facing = light_facing(mesh, light);
        let orientation = match self.caster.counting(mesh, light) {
            Counting::LightFacing => Orientation::closed(&facing),
            Counting::AllTriangles => Orientation::generalised(&facing),
        };
        let silhouette = Silhouette::new(mesh, self.caster.adjacency(), &orientation);
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
