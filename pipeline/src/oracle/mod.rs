//! Truth in f64: what a shadow algorithm's picture should have been.

pub mod plates;
