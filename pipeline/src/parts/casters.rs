//! The casters of a scene, examined once for all its lights.

use crate::geometry::caster::{Caster, CasterPolicy, Counting};
use crate::geometry::silhouette::{Orientation, Silhouette};
use crate::geometry::slivers::{Slivers, facing};
use crate::technique::{Choice, Param, Params, TechniqueError};
use crate::world::light::HardLight;
use crate::world::scene::{Object, Scene};

impl Choice for CasterPolicy {
    const NAMES: &'static [&'static str] = &CasterPolicy::NAMES;
    const ALL: &'static [Self] = &[Self::RequireClosed, Self::Generalised];
}

pub(crate) const OPEN_CASTERS: Param<CasterPolicy> = Param::choice(
    "open-casters",
    CasterPolicy::RequireClosed.name(),
    "casters that are not closed: refuse them (models named on the command line only if \
     this is given), or use the multiplicity-weighted silhouette",
);

/// What to do with open casters: as told, or else as the objects say.
pub(crate) fn open_casters(params: &Params) -> Result<CasterPolicy, TechniqueError> {
    let told = params.get(&OPEN_CASTERS)?;
    Ok(match params.is_given(OPEN_CASTERS.info.name) {
        true => told,
        false => CasterPolicy::AsObjectsSay,
    })
}

pub(crate) const SKIP: Param<bool> = Param::switch(
    "skip",
    true,
    "leave out casters whose volume is outside the view; same bits",
);

/// An object that casts shadows.
pub(crate) struct Examined<'a> {
    /// Index into [`Scene::objects`].
    pub(crate) number: usize,
    pub(crate) object: &'a Object,
    pub(crate) caster: Caster,
}

/// All casters of the scene.
///
/// # Errors
/// A caster is not closed and must be.
pub(crate) fn examine(
    scene: &Scene,
    policy: CasterPolicy,
) -> Result<Vec<Examined<'_>>, TechniqueError> {
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
        let facing = facing(mesh, self.caster.adjacency(), light, Slivers::WithoutArea);
        match self.caster.counting(mesh, light) {
            Counting::LightFacing => Orientation::closed(&facing),
            Counting::AllTriangles => Orientation::generalised(&facing),
        }
    }
}
