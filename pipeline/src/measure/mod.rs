//! Frames are run here, timed and read back; their traffic and errors are found.

pub mod carries;
pub mod comparison;
pub mod heat;
pub mod render;
pub mod stress;
mod supersample;
pub mod tile_traffic;
pub mod visibility_sum;
pub mod watch;
pub mod wedge_work;
