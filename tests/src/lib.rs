//! Cross-crate suites: the naive twin of the rasteriser, its scene description,
//! seeded random cases, uses of the API to break, and readers of the peers' files.

pub mod api;
pub mod check;
pub mod compare;
pub mod digest;
pub mod gpu_run;
pub mod lcg;
pub mod npy;
pub mod parallel;
pub mod random;
pub mod shrink;
pub mod sources;
pub mod tricov;
pub mod twin;
