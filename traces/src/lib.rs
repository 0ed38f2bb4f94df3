//! Frames in files: recorded, replayed, and judged by the memory of other hardware.
//!
//! Stands on the emulated GPU alone; of shaders it knows what a
//! [`ShaderTable`](gnomon_raster::shader::ShaderTable) tells it.

mod error;
mod format;
pub mod frozen;
pub mod history;
mod meta;
pub mod profile;
mod record;
mod replay;
mod run;
mod shape;
mod stream;
mod tiles;
mod trace;
pub mod witness;

pub use error::TraceError;
pub use meta::{Meta, Mode};
pub use record::{RecordOptions, Recorder, record};
pub use replay::{DrawDifference, ReplayDepth, ReplayDifference, Replayed, replay};
pub use shape::{DrawShape, FragmentShape, FrameShape, PassShape};
pub use trace::{FrameCounters, SectionNote, ShaderNote, Trace};
pub use witness::Witness;
