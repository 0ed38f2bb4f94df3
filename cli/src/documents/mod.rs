//! Results as the command line tells them with `--json`, for programs that link the library:
//! `docs/json.md` describes every key. Keys are only ever added.
//!
//! Each document is made of what [`pipeline`](crate::pipeline) or [`traces`](crate::traces)
//! gives, and is written with `serde`:
//!
//! ```
//! use gnomon::documents::TechniquesDocument;
//! use gnomon::pipeline::techniques::Registry;
//!
//! let registry = Registry::built_in();
//! let known = TechniquesDocument::new(&[registry.find("pcss")?]);
//! assert!(serde_json::to_string(&known)?.contains("\"name\":\"samples\""));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod compare;
mod draws;
mod object;
mod pixel;
mod render;
mod scenes;
mod sums;
mod techniques;
mod trace;
mod traffic;
mod words;

pub use array::numpy_type;
pub use compare::{CompareDocument, CompareInputs, ResultDocument};
pub use object::Object;
pub use pixel::PixelDocument;
pub use render::{
    FileDocument, Hashes, RenderDocument, RenderInputs, WarningDocument, WedgeWorkDocument,
};
pub use scenes::ScenesDocument;
pub use sums::{clears, frame_bytes, frame_counters};
pub use techniques::TechniquesDocument;
pub use trace::TraceDocument;
pub use traffic::{By, TrafficDocument, dram_bytes};
pub use words::end_name;

#[cfg(feature = "cli")]
pub(crate) use compare::count_by_reason;
#[cfg(feature = "cli")]
pub(crate) use render::worker_threads;
#[cfg(feature = "cli")]
pub(crate) use words::{operation, sign};
