//! Deferred shadowing (Tamura et al. 2006): light of vertices under an environment, less
//! what other objects hide of it at each pixel.
//!
//! * [`radiance`]: radiance textures, one pixel a vertex, and surfaces with them (§6.1)
//! * [`maps`]: occlusion maps, a box across and down (§4.2.2)
//! * [`obscured`]: light that occlusion maps take away (§4.2.4, §5.2)
//! * [`lit`]: what is left (equation 3)

pub mod lit;
pub mod maps;
pub mod obscured;
pub mod radiance;
