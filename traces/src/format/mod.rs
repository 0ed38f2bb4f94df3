//! The file format.

pub(crate) mod file;
pub(crate) mod section;
