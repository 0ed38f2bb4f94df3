//! Soft shadows from the exact depth complexity of a light along lines.
//!
//! The *depth complexity* D of a light point s, seen from a receiver p, is the number of
//! caster facets that the segment from p to s crosses, those counted that face s: s is
//! seen where D is 0 (Laine et al. 2005; docs/papers.md, beyond the papers). D changes only
//! where s crosses the image of a *contour edge*, an edge of which one facet faces p and
//! the other does not. So the light is crossed by parallel lines; on each, the crossings
//! with contour edges are sorted and swept, and the length where D is 0 is visible.
//! Sampling by lines errs less than by points, and without noise (Barringer et al. 2012;
//! Billen and Dutré 2016).
//!
//! * [`light`]: a light as lines
//! * [`patches`], [`edges`]: what of casters is needed, for each light
//! * [`blocks`], [`shaft`], [`lists`]: which edges matter to which pixels; [`kept_lists`]: what
//!   of that the next frame of an animation finds again
//! * [`walk`]: the rules, in f64, one receiver at a time: the twin of the shader
//!   `gnomon_shaders::line_samples`
//!
//! # Parallel work
//!
//! [`blocks`] and [`lists`] run on all threads. Each part of the work is a pure function of
//! its own input and parts are put together in the order of their numbers, so the result
//! cannot depend on how they were scheduled; tests hold it against that of one thread.

pub mod blocks;
pub mod edges;
pub mod kept_lists;
pub mod light;
pub mod lists;
pub mod patches;
pub mod shaft;
pub mod walk;

#[cfg(test)]
mod tests;
