//! State in words and signs.

use gnomon_raster::FragmentEnd;
use gnomon_raster::state::{CompareFunction, StencilOperation};

/// The sign of a comparison of what comes with what is stored.
pub(crate) fn sign(f: CompareFunction) -> &'static str {
    match f {
        CompareFunction::Never => "never",
        CompareFunction::Less => "<",
        CompareFunction::Equal => "=",
        CompareFunction::LessEqual => "≤",
        CompareFunction::Greater => ">",
        CompareFunction::NotEqual => "≠",
        CompareFunction::GreaterEqual => "≥",
        CompareFunction::Always => "always",
    }
}

/// What a stencil operation does.
pub(crate) fn operation(op: StencilOperation) -> &'static str {
    match op {
        StencilOperation::Keep => "keep",
        StencilOperation::Zero => "zero",
        StencilOperation::Replace => "replace",
        StencilOperation::IncrementClamp => "+1 clamped",
        StencilOperation::DecrementClamp => "-1 clamped",
        StencilOperation::Invert => "invert",
        StencilOperation::IncrementWrap => "+1",
        StencilOperation::DecrementWrap => "-1",
    }
}

/// The stable name of how a fragment ended.
pub fn end_name(end: FragmentEnd) -> &'static str {
    match end {
        FragmentEnd::Hiz => "hiz",
        FragmentEnd::Bounds => "bounds",
        FragmentEnd::Stencil => "stencil",
        FragmentEnd::Depth => "depth",
        FragmentEnd::Discarded => "discarded",
        FragmentEnd::Written => "written",
    }
}
