//! The techniques, one file each; the list is [`crate::technique::techniques`].

mod given_visibility;
mod near_pyramid;
mod passes;
mod sampled_shadow_volumes;
mod shadow_volumes;
mod unshadowed;
mod visibility;
mod volume_draws;

pub(crate) use given_visibility::GivenVisibility;
pub(crate) use sampled_shadow_volumes::SampledShadowVolumes;
pub(crate) use shadow_volumes::ShadowVolumes;
pub(crate) use unshadowed::Unshadowed;
