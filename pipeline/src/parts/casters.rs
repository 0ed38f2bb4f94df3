//! The casters of a scene, examined once for all its lights.

use crate::geometry::caster::{Caster, CasterPolicy, Counting, UnknownPolicy};
use crate::geometry::silhouette::{Orientation, Silhouette, light_facing};
use crate::technique::{ParamInfo, Params, TechniqueError};
use crate::world::light::HardLight;
use crate::world::scene::{Object, Scene};

pub(crate) const OPEN_CASTERS: ParamInfo = ParamInfo {
    name: "open-casters",
    default: "refuse",
    valid: "refuse|generalised",
    summary: "casters that are not closed: refuse them, or use the multiplicity-weighted silhouette",
};

pub(crate) const SKIP: ParamInfo = ParamInfo {
    name: "skip",
    default: "on",
    valid: "on|off",
    summary: "leave out casters whose volume is outside the view; same bits",
};

/// An object that casts shadows.
pub(crate) struct Examined<'a> {
    /// Index into [`Scene::objects`].
    pub(crate) number: usize,
    pub(crate) object: &'a Object,
    pub(crate) caster: Caster,
}

/// All casters of the scene, for `technique`, which has [`OPEN_CASTERS`].
///
/// # Errors
/// A caster is not closed and must be.
pub(crate) fn examine<'a>(
    technique: &'static str,
    scene: &'a Scene,
    params: &Params,
) -> Result<Vec<Examined<'a>>, TechniqueError> {
    let bad = |UnknownPolicy(value)| TechniqueError::BadValue {
        technique,
        key: OPEN_CASTERS.name,
        value,
        valid: OPEN_CASTERS.valid,
    };
    let policy: CasterPolicy = params.get(OPEN_CASTERS.name).parse().map_err(bad)?;
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
    /// The silhouette edges seen from `light`.
    pub(crate) fn silhouette(&self, light: HardLight) -> Silhouette {
        let mesh = &self.object.mesh;
        Silhouette::new(mesh, self.caster.adjacency(), &self.orientation(light))
    }

    /// How often each triangle casts, seen from `light`.
    pub(crate) fn orientation(&self, light: HardLight) -> Orientation {
        let mesh = &self.object.mesh;
        let facing = light_facing(mesh, light);
        match self.caster.counting(mesh, light) {
            Counting::LightFacing => Orientation::closed(&facing),
            Counting::AllTriangles => Orientation::generalised(&facing),
        }
    }
}
