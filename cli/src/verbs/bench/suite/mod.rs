//! What a benchmark measures: from the command line or a file, checked.

mod check;
mod entry;
mod file;
mod grid;
mod request;

pub(super) use check::{Subject, Suite, too_many};
pub(super) use entry::Entry;
pub(super) use file::{is_suite, parse};
pub(super) use request::{Given, Request};

/// The built-in suite.
pub(super) const STANDARD: &str = include_str!("standard.toml");
