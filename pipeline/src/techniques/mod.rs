//! The techniques, one file each; the list is [`crate::technique::techniques`].

mod casters;
mod convolution_soft_shadows;
mod given_visibility;
mod light_view;
mod mapped;
mod near_pyramid;
mod passes;
mod pcf;
mod pcss;
mod penumbra;
mod penumbra_wedges;
pub(crate) mod penumbra_wedges_restructured;
mod sampled_shadow_volumes;
mod shadow_map;
mod shadow_maps_n;
mod shadow_volumes;
mod soft;
mod soft_shadow_volumes;
mod soft_shadow_volumes_optimised;
mod unshadowed;
mod visibility;
mod volume_draws;

pub(crate) use convolution_soft_shadows::ConvolutionSoftShadows;
pub(crate) use given_visibility::GivenVisibility;
pub(crate) use pcf::Pcf;
pub(crate) use pcss::Pcss;
pub(crate) use penumbra_wedges::PenumbraWedges;
pub(crate) use penumbra_wedges_restructured::PenumbraWedgesRestructured;
pub(crate) use sampled_shadow_volumes::SampledShadowVolumes;
pub(crate) use shadow_map::ShadowMap;
pub(crate) use shadow_maps_n::ShadowMapsN;
pub(crate) use shadow_volumes::ShadowVolumes;
pub(crate) use soft_shadow_volumes::SoftShadowVolumes;
pub(crate) use soft_shadow_volumes_optimised::SoftShadowVolumesOptimised;
pub(crate) use unshadowed::Unshadowed;
