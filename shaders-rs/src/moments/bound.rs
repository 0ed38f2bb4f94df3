//! How much of a distribution lies beyond a depth, at most, given its moments.

use gnomon_raster::{F32, Lanes};

/// The one-tailed bound of Chebyshev: at most this share lies at or beyond `depth`,
/// given the means of depth and of its square (Donnelly and Lauritzen 2006).
#[inline(always)]
pub fn chebyshev<L: Lanes>(l: L, [mean, square]: [F32<L>; 2], depth: F32<L>, least: f32) -> F32<L> {
    let one = F32::splat(l, 1.0);
    let variance = (square - mean * mean).max(F32::splat(l, least));
    let beyond = depth - mean;
    let share = variance / (variance + beyond * beyond);
    beyond.gt(F32::splat(l, 0.0)).select_f32(share, one)
}

/// Means of even powers of the distribution that is mixed in: that for which the bound
/// is least wrong after quantisation (Peters and Klein 2015).
const SPREAD: f32 = 0.628;

/// Two roots of the quadratic whose zeros, with the depth, carry all of the sharpest
/// distribution.
struct Roots<L: Lanes> {
    low: F32<L>,
    high: F32<L>,
}

/// At least this share lies before `depth`, given the means of four powers of depths in
/// -1..=1: the bound of Hamburger's moment problem (Peters and Klein 2015, algorithm 3).
#[inline(always)]
pub fn hamburger<L: Lanes>(l: L, means: [F32<L>; 4], depth: F32<L>, spread: f32) -> F32<L> {
    let zero = F32::splat(l, 0.0);
    let [a, b, c, d] = means;
    let kept = 1.0 - spread;
    let b1 = [a * kept, b * kept + SPREAD * spread];
    let b3 = [c * kept, d * kept + SPREAD * spread];
    let Roots { low, high } = roots(l, [b1[0], b1[1], b3[0], b3[1]], depth);
    let before_one = mixed(b1, depth, high) / ((high - low) * (depth - low));
    let behind_none = F32::splat(l, 1.0) - mixed(b1, low, high) / ((depth - low) * (depth - high));
    let beyond_high = depth.gt(high).select_f32(behind_none, before_one);
    depth.gt(low).select_f32(beyond_high, zero).clamp(0.0, 1.0)
}

/// The mean of `(z − x) (z − y)` over the depths `z` whose first two means are `b1`.
#[inline(always)]
fn mixed<L: Lanes>(b1: [F32<L>; 2], x: F32<L>, y: F32<L>) -> F32<L> {
    (x * y - b1[0] * (x + y)) + b1[1]
}

/// Solves for the polynomial that is orthogonal to those through `depth`, by the
/// Cholesky factors of the matrix of moments.
#[inline(always)]
fn roots<L: Lanes>(l: L, [b1, b2, b3, b4]: [F32<L>; 4], depth: F32<L>) -> Roots<L> {
    let tiny = F32::splat(l, f32::MIN_POSITIVE);
    let variance = (b2 - b1 * b1).max(tiny);
    let skew = b3 - b1 * b2;
    let factor = skew / variance;
    let rest = ((b4 - b2 * b2) - skew * factor).max(tiny);
    // Forward, diagonal, back substitution of (1, z, z²).
    let second = (depth - b1) / variance;
    let third = ((depth * depth - b2) - factor * (depth - b1)) / rest;
    let second = second - factor * third;
    let first = (F32::splat(l, 1.0) - b1 * second) - b2 * third;
    quadratic(l, [first, second, third])
}

/// The zeros of `first + second x + third x²`, which are real but for rounding, apart by
/// something. Where it is nearly linear one is far away.
#[inline(always)]
fn quadratic<L: Lanes>(l: L, [first, second, third]: [F32<L>; 3]) -> Roots<L> {
    let zero = F32::splat(l, 0.0);
    let least = second.abs() * FARTHEST + F32::splat(l, f32::MIN_POSITIVE);
    let third = away_from_zero(third, least);
    let root = (second * second - third * first * 4.0).max(zero).sqrt();
    let larger = second + second.lt(zero).select_f32(-root, root);
    let larger = away_from_zero(larger * -0.5, F32::splat(l, f32::MIN_POSITIVE));
    let (x, y) = (larger / third, first / larger);
    let low = x.min(y);
    Roots {
        low,
        high: x.max(y).max(low + APART),
    }
}

/// Reciprocal of the largest root that is told from a linear function's.
const FARTHEST: f32 = 1e-6;
/// Least distance between roots.
const APART: f32 = 1e-9;

/// At least `least` in size, with its sign.
#[inline(always)]
fn away_from_zero<L: Lanes>(value: F32<L>, least: F32<L>) -> F32<L> {
    let size = value.abs().max(least);
    value
        .lt(F32::splat(value.lanes(), 0.0))
        .select_f32(-size, size)
}
