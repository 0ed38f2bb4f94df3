//! Frames in files: recorded, replayed, and judged by the memory of other hardware.
//!
//! Stands on the emulated GPU alone; of shaders it knows what a
//! [`ShaderTable`](gnomon_raster::shader::ShaderTable) tells it.

mod difference;
mod error;
mod format;
mod hashes;
pub mod history;
mod prefix;
pub mod profile;
mod shape;
pub mod witness;

pub use difference::*;
pub use error::TraceError;
pub use hashes::DrawHashes;
pub use shape::{DrawShape, FragmentShape, FrameShape, PassShape};
pub use witness::Witness;
