//! Comparisons and stencil operations, from their definitions.

use gnomon_raster::state::{CompareFunction, StencilFaceState, StencilOperation};

/// `a COMPARE b`.
pub(super) fn compare(f: CompareFunction, a: u32, b: u32) -> bool {
    let allowed: [bool; 3] = match f {
        // less, equal, greater
        CompareFunction::Never => [false, false, false],
        CompareFunction::Less => [true, false, false],
        CompareFunction::Equal => [false, true, false],
        CompareFunction::LessEqual => [true, true, false],
        CompareFunction::Greater => [false, false, true],
        CompareFunction::NotEqual => [true, false, true],
        CompareFunction::GreaterEqual => [false, true, true],
        CompareFunction::Always => [true, true, true],
    };
    allowed[(a.cmp(&b) as i32 + 1) as usize]
}

/// Whether the comparison needs its second operand.
pub(super) fn looks(f: CompareFunction) -> bool {
    f != CompareFunction::Never && f != CompareFunction::Always
}

/// The stored value after an operation through the write mask.
pub(super) fn operate(op: StencilOperation, face: &StencilFaceState, old: u8, reference: u8) -> u8 {
    let v = u32::from(old);
    let new = match op {
        StencilOperation::Keep => v,
        StencilOperation::Zero => 0,
        StencilOperation::Replace => u32::from(reference),
        StencilOperation::Invert => 255 - v,
        StencilOperation::IncrementClamp => (v + 1).min(255),
        StencilOperation::DecrementClamp => v.max(1) - 1,
        StencilOperation::IncrementWrap => (v + 1) % 256,
        StencilOperation::DecrementWrap => (v + 255) % 256,
    } as u8;
    (old & !face.write_mask) | (new & face.write_mask)
}

/// Whether the operation can write at all.
pub(super) fn effective(op: StencilOperation, face: &StencilFaceState) -> bool {
    op != StencilOperation::Keep && face.write_mask != 0
}

/// Whether an effective operation needs the stored value.
pub(super) fn modifies(op: StencilOperation, face: &StencilFaceState) -> bool {
    use StencilOperation::{Keep, Replace, Zero};
    effective(op, face) && (!matches!(op, Keep | Replace | Zero) || face.write_mask != 0xff)
}
