//! Settings of both techniques on soft shadow volumes, and their wedges to be looked
//! at.

use super::edges::SoftCasters;
use super::light::{SoftLight, split};
use crate::choices;
use crate::geometry::caster::CasterPolicy;
use crate::geometry::wedge::{Construction, Wedge, WedgeMesh, WedgeStatistics};
use crate::parts::casters::{OPEN_CASTERS, SKIP, open_casters};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::passes::View;
use crate::technique::{
    Choice, Condition, LightFact, LightKinds, Param, ParamInfo, Params, SceneWedges,
    TechniqueError, WedgeKind,
};
use crate::world::scene::Scene;

impl Choice for Construction {
    const NAMES: &'static [&'static str] = &["exact", "paper3", "paper4"];
    const ALL: &'static [Self] = &[Self::Exact, Self::BoundingSphere, Self::Tight];
}

pub(crate) const WEDGE: Param<Construction> = Param::choice(
    "wedge",
    "exact",
    "penumbra wedges: the penumbra itself, or as papers III and IV build them; same bits",
)
.when(Condition::Lights(LightFact::Extended));

choices! {
    /// The disc that stands for a sphere.
    pub(crate) enum SphereDisc {
        /// What it looks like.
        Seen = "seen",
        /// One of its own radius.
        Equator = "equator",
    }
}

pub(crate) const SPHERE: Param<SphereDisc> = Param::choice(
    "sphere",
    SphereDisc::Seen.word(),
    "a sphere as the disc that it looks like, or as one of its own radius",
)
.when(Condition::Lights(LightFact::Sphere));

/// Lights of both techniques on soft shadow volumes.
pub(crate) const SOFT_LIGHTS: LightKinds = LightKinds {
    directions: false,
    ..LightKinds::ALL
};

/// What both techniques are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SoftSettings {
    pub(crate) construction: Construction,
    pub(crate) sphere: SphereDisc,
    pub(crate) horizon: bool,
    pub(crate) open_casters: CasterPolicy,
    pub(crate) skip: bool,
    pub(crate) frame: FrameSettings,
}

impl SoftSettings {
    /// The parameters besides [`WEDGE`], whose default is the technique's.
    pub(crate) const PARAMS: &'static [ParamInfo] =
        &[SPHERE.info, HORIZON.info, OPEN_CASTERS.info, SKIP.info];

    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            construction: params.get(&WEDGE)?,
            sphere: params.get(&SPHERE)?,
            horizon: params.get(&HORIZON)?,
            open_casters: open_casters(params)?,
            skip: params.get(&SKIP)?,
            frame: FrameSettings::read(params)?,
        })
    }

    /// Whether spheres are seen as large as they look.
    pub(crate) fn seen(&self) -> bool {
        self.sphere == SphereDisc::Seen
    }

    /// The wedges of technique `name`, whose lights are split `k` times `k`.
    pub(crate) fn scene_wedges(
        &self,
        name: &'static str,
        scene: &Scene,
        k: u32,
    ) -> Result<SceneWedges, TechniqueError> {
        let casters = SoftCasters::new(scene, [1; 2], self.open_casters)?;
        let view = View::new(&scene.camera, [1; 2]);
        let mut meshes = Vec::new();
        for number in self.frame.lights(scene)? {
            for part in split(name, &scene.lights[number], number, k)? {
                let light =
                    SoftLight::new(name, &part, number, &view, casters.size(), self.seen())?;
                meshes.extend(self.meshes(&casters, &light));
            }
        }
        // Half-spaces, of edges that touch a light, have no faces to show.
        meshes.retain(|m| !m.triangles.is_empty());
        Ok(SceneWedges {
            kind: WedgeKind::Single(self.construction),
            meshes,
        })
    }

    fn meshes(&self, casters: &SoftCasters<'_>, light: &SoftLight) -> Vec<WedgeMesh> {
        let silhouettes = casters.silhouettes(light.centre);
        let edges = silhouettes.edges.iter().filter(|e| e.has_plane());
        let pairs = edges.flat_map(|e| light.sides.iter().map(move |s| (e, s)));
        let statistics = &mut WedgeStatistics::default();
        let mut meshes = Vec::new();
        for (edge, side) in pairs {
            let wedges = Wedge::of_edge(self.construction, &side.area, edge.ends, statistics);
            meshes.extend(wedges.iter().map(|w| w.volume.mesh()));
        }
        meshes
    }
}
