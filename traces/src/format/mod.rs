//! The file format.

pub(crate) mod blob;
pub(crate) mod columns;
pub(crate) mod counters;
pub(crate) mod decode;
pub(crate) mod encode;
pub(crate) mod events;
pub(crate) mod file;
mod numbers;
pub(crate) mod section;
pub(crate) mod v1;
