//! The techniques, one file each; the list is [`crate::technique::techniques`].

mod near_pyramid;
mod passes;
mod penumbra;
mod penumbra_wedges;
pub(crate) mod penumbra_wedges_restructured;
mod shadow_volumes;
mod soft;
mod soft_shadow_volumes;
mod soft_shadow_volumes_optimised;
mod unshadowed;
mod visibility;

pub(crate) use penumbra_wedges::PenumbraWedges;
pub(crate) use penumbra_wedges_restructured::PenumbraWedgesRestructured;
pub(crate) use shadow_volumes::ShadowVolumes;
pub(crate) use soft_shadow_volumes::SoftShadowVolumes;
pub(crate) use soft_shadow_volumes_optimised::SoftShadowVolumesOptimised;
pub(crate) use unshadowed::Unshadowed;
