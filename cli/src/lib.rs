//! Gnomon: a software GPU for shadow algorithms that gives the same bits on every machine
//! and counts every byte that they move.
//!
//! This crate has what a user needs in one place; each module is a package of its own:
//! [`raster`] the GPU, [`shaders`] over lanes, [`traces`] of frames, [`golden`] tests, and
//! the [`pipeline`] of scenes and shadow techniques. [`prelude`] is for first frames:
//!
//! ```
//! use gnomon::prelude::*;
//!
//! let mut frame = FrameBuilder::new(64, 64)?;
//! let corners = [[-0.8, -0.8, 0.5], [0.8, -0.8, 0.5], [0.0, 0.8, 0.5]];
//! frame.draw(TriangleDraw::new("orange", &corners).shade(|f| {
//!     ScalarFragmentOutput::color([1.0, f.y as f32 / 64.0, 0.0, 1.0])
//! }));
//! let drawn = frame.build().draw(GpuConfig::default())?;
//! assert_eq!(drawn.output("color")?.read_rgba8()?[64 * 32 + 32], [255, 128, 0, 255]);
//! let counted = drawn.report.passes[0].totals();
//! assert_eq!(counted.traffic.color[0].write_bytes, 4 * counted.fragments.written);
//! # Ok::<(), Error>(())
//! ```
//!
//! # Features
//!
//! * `documents`: results as JSON, as the program prints them. `cli` has it.
//! * `cli` (default): the program. `run` is all of it, `main_with` the same with techniques
//!   of other crates, `draw` is for programs that plot what they measured. Libraries and
//!   tests leave it out with `default-features = false`.

#[cfg(feature = "cli")]
mod command_line;
pub mod conformance;
#[cfg(feature = "documents")]
pub mod documents;
#[cfg(feature = "cli")]
pub mod draw;
#[cfg(feature = "cli")]
mod error;
#[cfg(feature = "cli")]
mod flags;
#[cfg(feature = "cli")]
mod help;
#[cfg(feature = "cli")]
mod output;
#[cfg(feature = "cli")]
mod overlay;
pub mod prelude;
#[cfg(feature = "cli")]
mod prepared;
#[cfg(feature = "cli")]
mod program;
#[cfg(feature = "cli")]
mod threads;
#[cfg(feature = "cli")]
mod traces_of_frames;
#[cfg(feature = "cli")]
mod verbs;

pub use gnomon_golden as golden;
pub use gnomon_golden::assert_frame;
pub use gnomon_pipeline as pipeline;
pub use gnomon_raster as raster;
pub use gnomon_shaders as shaders;
pub use gnomon_traces as traces;
#[cfg(feature = "cli")]
pub use program::{main_with, run, run_with};
