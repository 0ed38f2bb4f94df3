//! What the memory of other hardware would make of a frame's accesses.

pub mod codec;
