//! Clipping to, and sectors of, the unit disc.

use gnomon_raster::{F32, Lanes, Mask, math};

/// Parameters of the part with `x^2 + y^2 <= w^2, w >= 0` within `part`: a convex
/// cone, so one interval; empty where the first is not below the second.
#[inline(always)]
pub(super) fn clip<L: Lanes>(
    l: L,
    a: [F32<L>; 3],
    b: [F32<L>; 3],
    [start, end]: [F32<L>; 2],
) -> [F32<L>; 2] {
    let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let [low, high] = roots(l, form(d, d), form(a, d), form(a, a));
    let low = low.max(start).min(end);
    let high = high.max(start).min(end);
    let first = inside(l, a, d, [start, low]);
    let middle = inside(l, a, d, [low, high]);
    let last = inside(l, a, d, [high, end]);
    let (none_from, none_to) = (F32::splat(l, 2.0), F32::splat(l, -1.0));
    let from = first.select_f32(
        start,
        middle.select_f32(low, last.select_f32(high, none_from)),
    );
    let to = last.select_f32(end, middle.select_f32(high, first.select_f32(low, none_to)));
    [from, to]
}

/// Whether the middle of a part of `a + t d` is in the cone; empty parts are not.
#[inline(always)]
fn inside<L: Lanes>(l: L, a: [F32<L>; 3], d: [F32<L>; 3], [from, to]: [F32<L>; 2]) -> Mask<L> {
    let t = (from + to) * 0.5;
    let m = [a[0] + d[0] * t, a[1] + d[1] * t, a[2] + d[2] * t];
    let zero = F32::splat(l, 0.0);
    from.lt(to) & m[2].ge(zero) & form(m, m).le(zero)
}

#[inline(always)]
fn form<L: Lanes>(p: [F32<L>; 3], q: [F32<L>; 3]) -> F32<L> {
    (p[0] * q[0] + p[1] * q[1]) - p[2] * q[2]
}

/// Real roots of `a t^2 + 2 b t + c`, rising, by the formula that cancels no
/// digits; 0 for those that do not exist.
#[inline(always)]
fn roots<L: Lanes>(l: L, a: F32<L>, b: F32<L>, c: F32<L>) -> [F32<L>; 2] {
    let zero = F32::splat(l, 0.0);
    let discriminant = b * b - a * c;
    let real = discriminant.ge(zero);
    let root = real.select_f32(discriminant, zero).sqrt();
    let q = b.lt(zero).select_f32(root - b, -b - root);
    let limit = F32::splat(l, f32::INFINITY);
    let (s, t) = (q / a, c / q);
    let s = (s.abs().lt(limit) & real).select_f32(s, zero);
    let t = (t.abs().lt(limit) & real).select_f32(t, zero);
    [s.min(t), s.max(t)]
}

/// Area of the disc between the rays through p and q, less than half a turn.
#[inline(always)]
pub(super) fn sector<L: Lanes>(p: [F32<L>; 2], q: [F32<L>; 2]) -> F32<L> {
    let cross = p[0] * q[1] - p[1] * q[0];
    // No difference of two arctangents, so no cut where they jump.
    math::atan2(cross.abs(), math::dot2(p, q)) * 0.5
}
