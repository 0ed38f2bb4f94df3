//! The penumbra wedges that a technique builds for a scene, to be looked at: the
//! same casters, silhouettes and constructions as in its frame, without drawing.

use super::soft_shadow_volumes::WEDGE;
use super::soft_shadow_volumes_optimised::SPLIT;
use crate::geometry::wedge::paper1::{LinkedSettings, LinkedWedge};
use crate::geometry::wedge::{Construction, Wedge, WedgeMesh, WedgeStatistics};
use crate::parts::casters;
use crate::parts::passes::{self, View};
use crate::parts::wedges::penumbra::EXTRA_WEDGES;
use crate::parts::wedges::penumbra::light::LightSphere;
use crate::parts::wedges::penumbra::report::Met;
use crate::parts::wedges::soft::edges::Casters;
use crate::parts::wedges::soft::light::{SoftLight, split};
use crate::parts::wedges::soft::wedges::construction;
use crate::technique::{Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// How a technique's wedges are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WedgeKind {
    /// Each edge on its own (papers III and IV, and the exact penumbra).
    Single(Construction),
    /// Linked along silhouette loops (papers I and II).
    Linked,
}

impl WedgeKind {
    /// In a few words, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single(Construction::Exact) => "exact",
            Self::Single(Construction::BoundingSphere) => "round a sphere, paper III",
            Self::Single(Construction::Tight) => "tight, paper IV",
            Self::Linked => "linked, paper I",
        }
    }
}

/// Wedges of all lights that shine.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneWedges {
    /// How they are built.
    pub kind: WedgeKind,
    /// Closed meshes, world space, light after light.
    pub meshes: Vec<WedgeMesh>,
}

/// Whether a technique has wedges, and of what kind.
pub fn kind(technique: &dyn Technique, params: &Params) -> Option<WedgeKind> {
    let has = |name: &str| technique.params().iter().any(|p| p.name == name);
    if has(WEDGE.name) {
        return Some(WedgeKind::Single(construction(params)));
    }
    has(EXTRA_WEDGES.name).then_some(WedgeKind::Linked)
}

/// The wedges of a technique's frame; `None` for techniques without any.
///
/// # Errors
/// As the frame: a caster that is not closed, or a light that it is not made for.
pub fn of_scene(
    scene: &Scene,
    technique: &dyn Technique,
    params: &Params,
) -> Result<Option<SceneWedges>, TechniqueError> {
    let Some(kind) = kind(technique, params) else {
        return Ok(None);
    };
    let name = technique.name();
    let meshes = match kind {
        WedgeKind::Linked => linked(name, scene, params)?,
        WedgeKind::Single(construction) => single(technique, scene, params, construction)?,
    };
    Ok(Some(SceneWedges { kind, meshes }))
}

fn linked(
    name: &'static str,
    scene: &Scene,
    params: &Params,
) -> Result<Vec<WedgeMesh>, TechniqueError> {
    let casters = casters::examine(name, scene, params)?;
    let settings = LinkedSettings {
        extra_wedges: params.get(EXTRA_WEDGES.name) != "off",
        ..LinkedSettings::default()
    };
    let mut meshes = Vec::new();
    for light in passes::lights(scene, params)? {
        let Some(sphere) = LightSphere::of(&scene.lights[light]) else {
            continue;
        };
        for caster in &casters {
            let volume = caster.soft_volume(&sphere, &settings, &mut Met::default());
            meshes.extend(volume.wedges.iter().map(LinkedWedge::mesh));
        }
    }
    Ok(meshes)
}

fn single(
    technique: &dyn Technique,
    scene: &Scene,
    params: &Params,
    construction: Construction,
) -> Result<Vec<WedgeMesh>, TechniqueError> {
    let name = technique.name();
    let casters = Casters::new(name, scene, params)?;
    let view = View::new(&scene.camera, [1; 2]);
    let splits = technique.params().iter().any(|p| p.name == SPLIT.name);
    let k = if splits {
        params.get(SPLIT.name).parse().unwrap_or(1)
    } else {
        1
    };
    let mut meshes = Vec::new();
    for number in passes::lights(scene, params)? {
        for part in split(name, &scene.lights[number], number, k)? {
            let light = SoftLight::new(name, &part, number, &view, true)?;
            let silhouettes = casters.silhouettes(light.centre);
            let edges = silhouettes.edges.iter().filter(|e| e.has_plane());
            for (edge, side) in edges.flat_map(|e| light.sides.iter().map(move |s| (e, s))) {
                let met = &mut WedgeStatistics::default();
                let wedges = Wedge::of_edge(construction, &side.area, edge.ends, met);
                meshes.extend(wedges.iter().map(|w| w.volume.mesh()));
            }
        }
    }
    // Half-spaces, of edges that touch a light, have no faces to show.
    meshes.retain(|m| !m.triangles.is_empty());
    Ok(meshes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques::{self, find};
    use crate::world::scene::builtin;

    fn wedges(scene: &str, technique: &str, set: &[&str]) -> Option<SceneWedges> {
        let scene = builtin::build(scene).unwrap();
        let technique = find(technique).unwrap();
        let params = Params::parse(technique, set).unwrap();
        of_scene(&scene, technique, &params).unwrap()
    }

    /// One closed mesh per silhouette edge, whatever the construction.
    #[test]
    fn every_construction_shows_the_wedges_of_all_edges() {
        let count = |technique: &str, set: &[&str], kind: WedgeKind| {
            let found = wedges("cylinder", technique, set).unwrap();
            assert_eq!(found.kind, kind);
            assert!(found.meshes.iter().all(|m| m.open_edges() == 0));
            found.meshes.len()
        };
        let edges = count(
            "soft-shadow-volumes",
            &[],
            WedgeKind::Single(Construction::Exact),
        );
        assert!(edges > 30);
        for (name, construction) in [
            ("paper3", Construction::BoundingSphere),
            ("paper4", Construction::Tight),
        ] {
            let set = format!("wedge={name}");
            let kind = WedgeKind::Single(construction);
            assert_eq!(count("soft-shadow-volumes", &[&set], kind), edges);
        }
        let optimised = "soft-shadow-volumes-optimised";
        let tight = WedgeKind::Single(Construction::Tight);
        assert_eq!(count(optimised, &[], tight), edges);
        assert!(count(optimised, &["split=2"], tight) > 3 * edges);
        for technique in ["penumbra-wedges", "penumbra-wedges-restructured"] {
            assert!(count(technique, &["extra-wedges=off"], WedgeKind::Linked) >= edges);
        }
        assert_eq!(wedges("cylinder", "shadow-volumes", &[]), None);
        assert!(
            techniques::all()
                .iter()
                .filter(|t| kind(**t, &Params::defaults(**t)).is_some())
                .count()
                >= 4
        );
    }
}
