//! The techniques, one file each, and the list of them.
//!
//! To add one, write its file here and add one line to [`all`]; command line,
//! suites and tables pick it up from there. A crate of its own adds one to a
//! [`Registry`] instead.

mod convolution_soft_shadows;
mod mixed_lights;
mod pcf;
mod pcss;
mod penumbra_wedges;
pub(crate) mod penumbra_wedges_restructured;
mod registry;
mod sampled_shadow_volumes;
mod shadow_map;
mod shadow_maps_n;
mod shadow_volumes;
mod soft_shadow_volumes;
mod soft_shadow_volumes_optimised;
mod unshadowed;

use convolution_soft_shadows::ConvolutionSoftShadows;
use mixed_lights::MixedLights;
use pcf::Pcf;
use pcss::Pcss;
use penumbra_wedges::PenumbraWedges;
use penumbra_wedges_restructured::PenumbraWedgesRestructured;
use sampled_shadow_volumes::SampledShadowVolumes;
use shadow_map::ShadowMap;
use shadow_maps_n::ShadowMapsN;
use shadow_volumes::ShadowVolumes;
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
        &ShadowMap,
        &Pcf,
        &Pcss,
        &ShadowMapsN,
        &ConvolutionSoftShadows,
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
    use super::*;
    use crate::technique::Params;

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
}
