//! Truth in f64: what a shadow algorithm's picture should have been.
//!
//! Nothing here knows of silhouettes, volumes or rasterisation: [`hard`] casts
//! rays through a [`bvh`], [`plates`] is a closed form.

pub mod bvh;
pub mod hard;
pub mod plates;
