//! Cross-crate suites: the naive twin of the rasteriser, its scene description,
//! seeded random cases, and readers of the peers' files.

pub mod compare;
pub mod digest;
pub mod lcg;
pub mod tricov;
pub mod twin;
