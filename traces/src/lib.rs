//! Frames in files: recorded, replayed, and judged by the memory of other hardware.
//!
//! Stands on the emulated GPU alone; of shaders it knows what a
//! [`ShaderTable`](gnomon_raster::shader::ShaderTable) tells it.

pub mod history;
mod shape;

pub use shape::{DrawShape, FragmentShape, FrameShape, PassShape};
