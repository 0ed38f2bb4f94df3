//! Clipping to, and sectors of, the square -1..1.

use gnomon_raster::{F32, Lanes, Mask};

/// Parameters of the part with `|x| <= w, |y| <= w` within `part`; empty where
/// the first is not below the second.
#[inline(always)]
pub(super) fn clip<L: Lanes>(
    l: L,
    a: [F32<L>; 3],
    b: [F32<L>; 3],
    part: [F32<L>; 2],
) -> [F32<L>; 2] {
    let mut bounds = part;
    for axis in [0, 1] {
        bounds = cut(l, a[2] - a[axis], b[2] - b[axis], bounds);
        bounds = cut(l, a[2] + a[axis], b[2] + b[axis], bounds);
    }
    bounds
}

/// Leaves out what is negative of a function with values at both ends.
#[inline(always)]
pub(super) fn cut<L: Lanes>(l: L, fa: F32<L>, fb: F32<L>, [from, to]: [F32<L>; 2]) -> [F32<L>; 2] {
    let zero = F32::splat(l, 0.0);
    let (na, nb) = (fa.lt(zero), fb.lt(zero));
    let t = fa / (fa - fb);
    // Nothing is left where both are outside.
    let none = na & nb;
    let from = none.select_f32(F32::splat(l, 2.0), na.select_f32(from.max(t), from));
    let to = none.select_f32(F32::splat(l, -1.0), nb.select_f32(to.min(t), to));
    [from, to]
}

/// Area of the square between the rays from the centre through p and q, on the
/// side where they are less than half a turn apart.
#[inline(always)]
pub(super) fn sector<L: Lanes>(l: L, p: [F32<L>; 2], q: [F32<L>; 2]) -> F32<L> {
    let zero = F32::splat(l, 0.0);
    let turn = p[0] * q[1] - p[1] * q[0];
    let (sp, sq) = (swept(l, p), swept(l, q));
    let ahead = turn.lt(zero).select_f32(sp - sq, sq - sp);
    ahead.lt(zero).select_f32(ahead + 4.0, ahead)
}

/// Area swept counter-clockwise from the direction (1, -1) to that of p, 0 to 4.
#[inline(always)]
fn swept<L: Lanes>(l: L, [x, y]: [F32<L>; 2]) -> F32<L> {
    let zero = F32::splat(l, 0.0);
    let flat: Mask<L> = x.abs().ge(y.abs());
    let (over, under) = (flat.select_f32(y, -x), flat.select_f32(x, y));
    let none = under.eq(zero);
    let slope = none.select_f32(zero, over / under);
    let positive = under.ge(zero);
    let sides = flat.select_f32(
        positive.select_f32(F32::splat(l, 0.5), F32::splat(l, 2.5)),
        positive.select_f32(F32::splat(l, 1.5), F32::splat(l, 3.5)),
    );
    sides + slope * 0.5
}
