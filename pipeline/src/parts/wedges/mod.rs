//! Penumbra wedges: linked ones of papers I and II ([`penumbra`]), those of single
//! edges of papers III and IV ([`soft`]).

pub(crate) mod penumbra;
pub(crate) mod soft;

/// Label of the draws that add the coverage of a wedge to a buffer.
pub(crate) const COVERAGE_DRAW: &str = "penumbra";
