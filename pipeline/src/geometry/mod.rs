//! Shadow geometry in f64, from meshes and lights alone: silhouettes, volumes,
//! wedges, what is seen of a light past an edge, and the Fourier expansion of
//! convolution shadow maps.

pub mod area_light;
pub mod caster;
pub mod convolution;
pub mod coverage;
pub mod harmonics;
pub(crate) mod layers;
pub(crate) mod light_contact;
pub mod line_sampling;
pub(crate) mod outlines;
pub mod silhouette;
pub mod silhouette_loops;
pub(crate) mod slivers;
pub mod smoothie;
pub mod volume;
pub mod wedge;
pub mod winding;
