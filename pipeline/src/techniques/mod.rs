//! The techniques, one file each; the list is [`crate::technique::techniques`].

mod casters;
mod given_visibility;
mod mixed_lights;
mod near_pyramid;
mod passes;
mod penumbra;
mod penumbra_wedges;
pub(crate) mod penumbra_wedges_restructured;
mod sampled_shadow_volumes;
mod shadow_volumes;
mod soft;
mod soft_shadow_volumes;
mod soft_shadow_volumes_optimised;
mod unshadowed;
mod visibility;
mod volume_draws;

pub(crate) use given_visibility::GivenVisibility;
pub(crate) use mixed_lights::MixedLights;
pub(crate) use penumbra_wedges::PenumbraWedges;
pub(crate) use penumbra_wedges_restructured::PenumbraWedgesRestructured;
pub(crate) use sampled_shadow_volumes::SampledShadowVolumes;
pub(crate) use shadow_volumes::ShadowVolumes;
pub(crate) use soft_shadow_volumes::SoftShadowVolumes;
pub(crate) use soft_shadow_volumes_optimised::SoftShadowVolumesOptimised;
pub(crate) use unshadowed::Unshadowed;
