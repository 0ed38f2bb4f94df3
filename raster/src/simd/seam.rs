//! Seams: where code that is inlined by force is kept apart.
//!
//! All lane code is `#[inline(always)]`, or it would lose the level's instructions.
//! Without optimisation each inlined operation keeps memory of its own on the stack,
//! as many times as it is inlined, and a kernel's frame grows to megabytes. So in
//! such builds (`gnomon_unoptimised`, set by `build.rs`) each operation and each step
//! of [`each3`] and [`each4`] is a function of its own, and its memory is given back
//! when it returns. In optimised builds nothing of that is there.

use super::Lanes;

/// `[f(0), f(1), f(2)]`, inlined without fail: `array::from_fn` may stay a call
/// of its own and would lose the level's instructions. Annotate the closure with
/// `#[inline(always)]`.
#[inline(always)]
pub fn each3<T>(mut f: impl FnMut(usize) -> T) -> [T; 3] {
    [step(&mut f, 0), step(&mut f, 1), step(&mut f, 2)]
}

/// `[f(0), f(1), f(2), f(3)]`, as [`each3`].
#[inline(always)]
pub fn each4<T>(mut f: impl FnMut(usize) -> T) -> [T; 4] {
    [
        step(&mut f, 0),
        step(&mut f, 1),
        step(&mut f, 2),
        step(&mut f, 3),
    ]
}

/// `f(i)`.
#[cfg_attr(gnomon_unoptimised, inline(never))]
#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn step<T>(f: &mut impl FnMut(usize) -> T, i: usize) -> T {
    f(i)
}

/// Runs `f` in a function of its own, compiled for the level: a seam that keeps
/// inlining from multiplying the code.
#[inline(always)]
pub(crate) fn outlined<L: Lanes, T>(l: L, f: impl FnOnce() -> T) -> T {
    l.apart(f)
}
