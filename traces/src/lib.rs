//! Frames in files: recorded, replayed, and judged by the memory of other hardware.
//!
//! Stands on the emulated GPU alone; of shaders it knows what a
//! [`ShaderTable`](gnomon_raster::shader::ShaderTable) tells it.

mod difference;
mod error;
mod format;
mod shape;

pub use difference::{Place, StateDifference, compare_states};
pub use error::TraceError;
pub use shape::{DrawShape, FragmentShape, FrameShape, PassShape};
