//! How far a picture is from the truth.
//!
//! [`visibility`] compares what shadow algorithms compute, the visible share of
//! a light per pixel, before any shading; [`banding`] looks for steps in
//! penumbrae that the truth does not have, [`roughness`] for teeth along
//! straight edges. [`psnr`], [`ssim`] and [`flip`] compare shaded 8-bit sRGB
//! pictures, as they are seen. Acceptance thresholds belong on visibility; the
//! others are for reports.
//!
//! Hard shadows, measured against the exact shadow of the area light: right in
//! umbra and light, up to half the light wrong in between.
//!
//! ```
//! use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
//! use gnomon_pipeline::truth::oracle::area::{LightRegion, VisibilityImage};
//! use gnomon_pipeline::measure::render::{self, RenderSettings};
//! use gnomon_pipeline::world::scene::builtin;
//! use gnomon_pipeline::{technique, techniques};
//!
//! let scene = builtin::build("cylinder")?;
//! let truth = VisibilityImage::of_scene(&scene, 0, [64, 48], &|| {})?;
//! let shadows = techniques::find("shadow-volumes")?;
//! let params = technique::Params::parse(shadows, ["method=zfail"])?;
//! let settings = RenderSettings { size: [64, 48], ..RenderSettings::default() };
//! let picture = render::render(&scene, shadows, &params, &settings)?;
//! let error = VisibilityError::measure(&truth, picture.size, &picture.visibility)?;
//! let rmse = |region| error.of_region(region).unwrap().rmse;
//! assert!(rmse(LightRegion::Umbra) < 0.1 && rmse(LightRegion::Lit) < 0.1);
//! assert!(rmse(LightRegion::Penumbra) > 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Everything is f64; rows may be filtered in parallel, but sums are taken in pixel
//! order by one thread.

pub mod banding;
mod error;
mod filter;
pub mod flip;
mod picture;
pub mod psnr;
pub mod roughness;
#[cfg(test)]
mod samples;
pub mod ssim;
pub mod visibility;

pub use error::MetricError;
pub use picture::{Picture, rgb_of};
