//! Penumbra wedges: linked ones of papers I and II ([`penumbra`]), those of single
//! edges of papers III and IV ([`soft`]).

pub(crate) mod penumbra;
pub(crate) mod soft;
