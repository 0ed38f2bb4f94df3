//! The stencil test and its operations on all 64 pixels of a block at once.

use fearless_simd::{Simd, SimdBase as _, SimdInt as _, SimdMask as _, mask8x64, u8x64};

use super::config::StencilFace;
use crate::simd::Lanes;
use crate::state::{CompareFunction, StencilOperation};
use crate::texture::Block;

type Bytes<L> = u8x64<<L as Lanes>::Isa>;

#[inline(always)]
fn load<L: Lanes>(l: L, b: &Block<u8>) -> Bytes<L> {
    u8x64::from_slice(l.isa(), &b.0)
}

/// Pixels of `mask` that pass the stencil test.
#[inline(always)]
pub(super) fn test<L: Lanes>(l: L, face: &StencilFace, stored: &Block<u8>, mask: u64) -> u64 {
    let s = &face.state;
    match s.compare {
        CompareFunction::Always => return mask,
        CompareFunction::Never => return 0,
        _ => {}
    }
    let stored = load(l, stored) & u8x64::splat(l.isa(), s.read_mask);
    let reference = u8x64::splat(l.isa(), face.reference & s.read_mask);
    let pass = match s.compare {
        CompareFunction::Less => reference.simd_lt(stored),
        CompareFunction::LessEqual => reference.simd_le(stored),
        CompareFunction::Greater => reference.simd_gt(stored),
        CompareFunction::GreaterEqual => reference.simd_ge(stored),
        CompareFunction::Equal => reference.simd_eq(stored),
        _ => !reference.simd_eq(stored),
    };
    pass.to_bitmask() & mask
}

/// Adds `step` (±1, modulo 256) to the pixels of `mask`.
#[inline(always)]
pub(super) fn add<L: Lanes>(l: L, block: &mut Block<u8>, mask: u64, step: i8) {
    let isa = l.isa();
    let old = load(l, block);
    let new = old + u8x64::splat(isa, step as u8);
    isa.select_u8x64(mask8x64::from_bitmask(isa, mask), new, old)
        .store_slice(&mut block.0);
}

/// Adds `step` to every pixel.
#[inline(always)]
pub(super) fn add_to_all<L: Lanes>(l: L, block: &mut Block<u8>, step: i8) {
    (load(l, block) + u8x64::splat(l.isa(), step as u8)).store_slice(&mut block.0);
}

/// Applies `op` to the pixels of `mask`; gives those whose byte stayed the same.
#[inline(always)]
pub(super) fn apply<L: Lanes>(
    l: L,
    face: &StencilFace,
    op: StencilOperation,
    block: &mut Block<u8>,
    mask: u64,
) -> u64 {
    let isa = l.isa();
    let old = load(l, block);
    let one = u8x64::splat(isa, 1);
    let new = match op {
        StencilOperation::Keep => old,
        StencilOperation::Zero => u8x64::splat(isa, 0),
        StencilOperation::Replace => u8x64::splat(isa, face.reference),
        StencilOperation::Invert => !old,
        StencilOperation::IncrementClamp => old.saturating_add(one),
        StencilOperation::DecrementClamp => old.saturating_sub(one),
        StencilOperation::IncrementWrap => old + one,
        StencilOperation::DecrementWrap => old - one,
    };
    let writable = face.state.write_mask;
    let whole = writable == 0xff;
    let new = if whole {
        new
    } else {
        let w = u8x64::splat(isa, writable);
        (new & w) | (old & !w)
    };
    let stored = if mask == u64::MAX {
        new
    } else {
        isa.select_u8x64(mask8x64::from_bitmask(isa, mask), new, old)
    };
    stored.store_slice(&mut block.0);
    let never_same = whole
        && matches!(
            op,
            StencilOperation::IncrementWrap
                | StencilOperation::DecrementWrap
                | StencilOperation::Invert
        );
    if never_same {
        0
    } else {
        old.simd_eq(new).to_bitmask() & mask
    }
}
