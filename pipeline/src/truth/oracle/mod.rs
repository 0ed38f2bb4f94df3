//! Truth in f64: what a shadow algorithm's picture should have been.
//!
//! Nothing here knows of silhouettes, volumes or rasterisation: [`hard`] casts
//! rays through a [`bvh`]; [`area`] integrates soft shadows exactly and
//! [`sampled`] does so by rays, for a second opinion; [`plates`](crate::world::plates) is a closed
//! form. [`cache`] keeps what was computed.

pub mod area;
pub mod bvh;
pub mod cache;
pub mod environment;
pub mod hard;
pub mod sampled;
pub mod surfaces;
pub mod transport;
