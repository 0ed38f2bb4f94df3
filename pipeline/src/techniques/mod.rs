//! The techniques, one file each; the list is [`crate::technique::techniques`].

mod near_pyramid;
mod passes;
mod shadow_volumes;
mod unshadowed;
mod visibility;
mod volume_draws;

pub(crate) use shadow_volumes::ShadowVolumes;
pub(crate) use unshadowed::Unshadowed;
