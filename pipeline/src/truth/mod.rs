//! What the picture should have been, and how far off one is.

pub mod metrics;
pub mod oracle;
