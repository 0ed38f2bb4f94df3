//! How far a picture is from the truth.
//!
//! [`visibility`] compares what shadow algorithms compute, the visible share of
//! a light per pixel, before any shading; [`banding`] looks for steps in
//! penumbrae that the truth does not have. [`psnr`], [`ssim`] and [`flip`]
//! compare shaded 8-bit sRGB pictures, as they are seen. Acceptance thresholds
//! belong on visibility; the others are for reports.
//!
//! Everything is f64; rows may be filtered in parallel, but sums are taken in pixel
//! order by one thread.

pub mod banding;
mod error;
mod filter;
pub mod flip;
mod picture;
pub mod psnr;
#[cfg(test)]
mod samples;
pub mod ssim;
pub mod visibility;

pub use error::MetricError;
pub use picture::{Picture, rgb_of};
