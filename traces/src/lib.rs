//! Frames in files: recorded, replayed, and judged by the memory of other hardware.
//!
//! Stands on the emulated GPU alone; of shaders it knows what a
//! [`ShaderTable`](gnomon_raster::shader::ShaderTable) tells it.

pub mod chrome;
mod difference;
mod error;
pub mod findings;
mod format;
pub mod frozen;
mod guard;
mod hashes;
pub mod history;
pub mod judged;
pub mod maps;
mod meta;
pub mod profile;
mod record;
mod replay;
pub mod report;
mod run;
mod shape;
mod stream;
mod trace;
mod trim;
mod walk;
pub mod witness;

pub use difference::*;
pub use error::TraceError;
pub use guard::guarded;
pub use hashes::DrawHashes;
pub use meta::{Meta, Mode};
pub use record::{RecordOptions, Recorder, record};
pub use replay::{DrawDifference, ReplayDepth, ReplayDifference, Replayed, replay};
pub use shape::{DrawShape, FragmentShape, FrameShape, PassShape};
pub use trace::{FrameCounters, SectionNote, ShaderNote, Trace};
pub use trim::{Keep, trim};
pub use walk::{Until, draw_until};
pub use witness::{Contents, Witness};
