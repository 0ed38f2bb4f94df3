//! The techniques, one file each, and the list of them.
//!
//! To add one, write its file here and add one line to [`all`]; command line,
//! suites and tables pick it up from there. A crate of its own adds one to a
//! [`Registry`] instead.

mod backprojection;
mod cone_culling;
mod convolution_soft_shadows;
mod deferred_shadowing;
mod heckbert_herf;
mod line_sampled_shadow_volumes;
mod mixed_lights;
mod moment_maps;
mod pcf;
mod pcss;
mod penumbra_wedges;
pub(crate) mod penumbra_wedges_restructured;
mod ray_traced;
mod registry;
mod sampled_shadow_volumes;
mod shadow_map;
mod shadow_maps_n;
mod shadow_volumes;
mod smoothies;
mod soft_shadow_volumes;
mod soft_shadow_volumes_optimised;
mod unshadowed;

use backprojection::BackprojectedMaps;
use cone_culling::ConeCulling;
use convolution_soft_shadows::ConvolutionSoftShadows;
use deferred_shadowing::DeferredShadowing;
use heckbert_herf::HeckbertHerf;
use line_sampled_shadow_volumes::LineSampledShadowVolumes;
use mixed_lights::MixedLights;
use moment_maps::MomentMaps;
use pcf::Pcf;
use pcss::Pcss;
use penumbra_wedges::PenumbraWedges;
use penumbra_wedges_restructured::PenumbraWedgesRestructured;
use ray_traced::RayTraced;
use sampled_shadow_volumes::SampledShadowVolumes;
use shadow_map::ShadowMap;
use shadow_maps_n::ShadowMapsN;
use shadow_volumes::ShadowVolumes;
use smoothies::Smoothies;
use soft_shadow_volumes::SoftShadowVolumes;
use soft_shadow_volumes_optimised::SoftShadowVolumesOptimised;
use unshadowed::Unshadowed;

use registry::find_in;
pub use registry::{Registry, RegistryError};

use crate::technique::{Technique, TechniqueError};

/// All techniques, in the order in which they are listed.
pub fn all() -> &'static [&'static dyn Technique] {
    static LIST: &[&dyn Technique] = &[
        &Unshadowed,
        &ShadowVolumes,
        &SampledShadowVolumes,
        &PenumbraWedges,
        &PenumbraWedgesRestructured,
        &SoftShadowVolumes,
        &SoftShadowVolumesOptimised,
        &LineSampledShadowVolumes,
        &ShadowMap,
        &Pcf,
        &Pcss,
        &ShadowMapsN,
        &MomentMaps::Variance,
        &MomentMaps::Exponential,
        &MomentMaps::Four,
        &MomentMaps::VarianceSoft,
        &MomentMaps::Mask,
        &HeckbertHerf,
        &BackprojectedMaps::Areas,
        &BackprojectedMaps::Bits,
        &RayTraced,
        &ConvolutionSoftShadows,
        &DeferredShadowing,
        &ConeCulling,
        &Smoothies,
        &MixedLights,
    ];
    LIST
}

/// The built-in technique called `name`.
///
/// # Errors
/// There is none: the error lists all names and suggests the nearest.
pub fn find(name: &str) -> Result<&'static dyn Technique, TechniqueError> {
    find_in(all(), name)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::wedge::Construction;
    use crate::technique::{
        Params, PassRole, SceneWedges, ShadowKind, Source, WedgeKind, WedgeUse,
    };
    use crate::world::light::{ConvexPolygon, Light, LightShape};
    use crate::world::scene::builtin;

    #[test]
    fn techniques_are_found_by_name() {
        for technique in all() {
            assert_eq!(find(technique.name()).unwrap().name(), technique.name());
            assert!(!technique.summary().is_empty());
        }
        let message = find("shadow-volume").err().unwrap().to_string();
        assert!(
            message.contains("did you mean 'shadow-volumes'") && message.contains("unshadowed"),
            "{message}"
        );
    }

    #[test]
    fn defaults_are_valid_values() {
        for technique in all() {
            for info in technique.params() {
                let given = format!("{}={}", info.name, info.default);
                Params::parse(*technique, [given]).unwrap();
            }
        }
    }

    fn wedges(technique: &str, set: &[&str]) -> Option<SceneWedges> {
        let scene = builtin::build("cylinder").unwrap();
        let technique = find(technique).unwrap();
        let params = Params::parse(technique, set).unwrap();
        technique.wedges(&scene, &params).unwrap()
    }

    /// One closed mesh per silhouette edge, whatever the construction.
    #[test]
    fn every_construction_shows_the_wedges_of_all_edges() {
        let count = |technique: &str, set: &[&str], kind: WedgeKind| {
            let found = wedges(technique, set).unwrap();
            assert_eq!(found.kind, kind);
            assert!(found.meshes.iter().all(|m| m.open_edges() == 0));
            found.meshes.len()
        };
        let single = WedgeKind::Single;
        let edges = count("soft-shadow-volumes", &[], single(Construction::Exact));
        assert!(edges > 30);
        for (name, construction) in [
            ("paper3", Construction::BoundingSphere),
            ("paper4", Construction::Tight),
        ] {
            let set = format!("wedge={name}");
            let kind = single(construction);
            assert_eq!(count("soft-shadow-volumes", &[&set], kind), edges);
        }
        let optimised = "soft-shadow-volumes-optimised";
        let tight = single(Construction::Tight);
        assert_eq!(count(optimised, &[], tight), edges);
        assert!(count(optimised, &["split=2"], tight) > 3 * edges);
        for technique in ["penumbra-wedges", "penumbra-wedges-restructured"] {
            assert!(count(technique, &["extra-wedges=off"], WedgeKind::Linked) >= edges);
        }
    }

    /// Whoever says that it has wedges shows some, and nobody else does.
    #[test]
    fn capabilities_say_who_has_wedges() {
        let mut with = 0;
        for technique in all() {
            let kind = wedges(technique.name(), &[]).map(|w| w.kind);
            let told = match technique.capabilities().wedges {
                WedgeUse::None => kind.is_none(),
                WedgeUse::Single => matches!(kind, Some(WedgeKind::Single(_))),
                WedgeUse::Linked => kind == Some(WedgeKind::Linked),
            };
            assert!(told, "{} {kind:?}", technique.name());
            with += usize::from(kind.is_some());
        }
        assert!(with >= 4);
    }

    /// A frame has a role for each pass, and shading is told from shadows by it.
    #[test]
    fn every_pass_has_a_role() {
        let scene = builtin::build("creature").unwrap();
        for technique in all() {
            let params = Params::defaults(*technique);
            let frame = technique.frame(&scene, [24, 16], &params).unwrap();
            let (name, roles) = (technique.name(), frame.roles.passes());
            let passes = &frame.recording.list.passes;
            assert_eq!(roles.len(), passes.len(), "{name}");
            for (role, pass) in roles.iter().zip(passes) {
                assert_ne!(*role, PassRole::Other, "{name}: {}", pass.label);
                let shades = ["ambient", "lit"].iter().any(|w| pass.label.starts_with(w));
                assert_eq!(role.is_shading(), shades, "{name}: {}", pass.label);
            }
            let shadows = roles.iter().any(|r| !r.is_shading());
            let none = technique.capabilities().shadows == ShadowKind::None;
            assert_eq!(shadows, !none, "{name}");
        }
    }

    /// Light kinds that a technique says it takes it takes, and refuses the others.
    #[test]
    fn capabilities_say_which_lights_are_taken() {
        let at = DVec3::new(0.5, 4.0, 0.3);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let corners = corners.map(|[x, z]| at + DVec3::new(x, 0.0, z)).to_vec();
        let shapes = [
            LightShape::Point { position: at },
            LightShape::Directional { towards: at },
            Light::horizontal_square(at, 1.0).shape,
            LightShape::Disc {
                centre: at,
                normal: DVec3::Y,
                radius: 0.5,
            },
            LightShape::Sphere {
                centre: at,
                radius: 0.5,
            },
            LightShape::Polygon(ConvexPolygon::new(corners).unwrap()),
        ];
        let mut scene = builtin::build("cylinder").unwrap();
        for technique in all() {
            if technique.capabilities().source == Source::Techniques {
                continue; // those of its parts
            }
            for shape in &shapes {
                scene.lights[0].shape = shape.clone();
                let params = Params::defaults(*technique);
                let taken = technique.frame(&scene, [16, 12], &params).is_ok();
                let told = technique.capabilities().lights.contains(shape);
                assert_eq!(taken, told, "{} {shape:?}", technique.name());
            }
        }
    }
}
