//! Shadow maps that are filtered before they are compared, as means of a few functions
//! of depth (docs/papers.md, baselines): variance, exponential variance and four moments.
//!
//! From the means of a kernel follows a bound of how much of it is farther than the
//! receiver. It is exact where the kernel holds two depths, the receiver's the farther
//! one; elsewhere light leaks.
//!
//! * [`bound`]: the bounds
//! * [`image`]: the functions as images
//! * [`filter`]: kernels of a fixed width, or as wide as the light seems through the
//!   blockers
//! * [`occluder_plane`]: a mask of all occluders, as if they were in one plane
//! * [`variance_soft`]: the same with blockers from the means themselves
//!
//! Depth is scaled linear depth, 0..=1 over the light view.

pub mod bound;
pub mod filter;
pub mod image;
pub mod occluder_plane;
pub mod variance_soft;

use gnomon_raster::math::exp;
use gnomon_raster::{F32, Lanes, uniforms};

use bound::{chebyshev, hamburger};

/// Which functions of depth are filtered. All have values in 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moments {
    /// Depth and its square (Donnelly and Lauritzen 2006).
    Variance,
    /// `exp(c (z - 1))`, `exp(-c z)` and their squares (Lauritzen and McCool 2008). The
    /// number is c.
    Exponential(f32),
    /// Four powers of `2z - 1`, in the combinations that quantise best (Peters and Klein
    /// 2015). The number is the share of a spread distribution that is mixed in, so that
    /// rounding leaves no impossible moments.
    Four(f32),
    /// 1 where there is an occluder, whatever its depth.
    Mask,
}
uniforms!(enum Moments { 0: Variance, 1: Exponential(exponent), 2: Four(spread), 3: Mask });

/// √3 / 2 and 2√3 / 9, of the odd powers' combinations.
const ODD: [f32; 2] = [0.866_025_4, 0.384_900_18];

impl Moments {
    /// How many functions there are.
    #[must_use]
    #[inline(always)]
    pub fn count(&self) -> usize {
        match self {
            Self::Mask => 1,
            Self::Variance => 2,
            Self::Exponential(_) | Self::Four(_) => 4,
        }
    }

    /// The functions of a depth.
    #[inline(always)]
    pub fn of<L: Lanes>(&self, l: L, depth: F32<L>) -> [F32<L>; 4] {
        let zero = F32::splat(l, 0.0);
        match *self {
            Self::Variance => [depth, depth * depth, zero, zero],
            Self::Exponential(c) => {
                let far = exp((depth - 1.0) * c);
                let near = exp(depth * -c);
                [far, far * far, near, near * near]
            }
            Self::Four(_) => combined(depth * 2.0 - 1.0),
            Self::Mask => {
                let one = F32::splat(l, 1.0);
                [depth.lt(one).select_f32(one, zero), zero, zero, zero]
            }
        }
    }

    /// An upper bound of the share of a kernel with these means that is no nearer than
    /// `depth`. No variance is taken to be less than `least`: what rounding makes.
    #[inline(always)]
    pub fn visible<L: Lanes>(&self, l: L, means: [F32<L>; 4], depth: F32<L>, least: f32) -> F32<L> {
        match *self {
            Self::Variance => chebyshev(l, [means[0], means[1]], depth, least),
            Self::Exponential(c) => {
                let far = exp((depth - 1.0) * c);
                let near = -exp(depth * -c);
                let by_far = chebyshev(l, [means[0], means[1]], far, least);
                let by_near = chebyshev(l, [-means[2], means[3]], near, least);
                by_far.min(by_near)
            }
            Self::Four(spread) => {
                let powers = powers(means);
                F32::splat(l, 1.0) - hamburger(l, powers, depth * 2.0 - 1.0, spread)
            }
            Self::Mask => F32::splat(l, 1.0) - means[0],
        }
    }
}

/// The combinations of t, t², t³ and t⁴ that are stored, 0..=1 for -1 ≤ t ≤ 1.
#[inline(always)]
fn combined<L: Lanes>(t: F32<L>) -> [F32<L>; 4] {
    let square = t * t;
    let (cube, fourth) = (square * t, square * square);
    [
        (t * 1.5 - cube * 2.0) + 0.5,
        (square - fourth) * 4.0,
        (t * ODD[0] - cube * ODD[1]) + 0.5,
        (square + fourth) * 0.5,
    ]
}

/// What [`combined`] was made of.
#[inline(always)]
fn powers<L: Lanes>(stored: [F32<L>; 4]) -> [F32<L>; 4] {
    let [a, b, c, d] = stored;
    let (a, c) = (a - 0.5, c - 0.5);
    // The odd pair's determinant is 2√3/3.
    let first = c * 1.732_050_8 - a * (1.0 / 3.0);
    let third = (c * 1.5 - a * ODD[0]) * ODD[0];
    [first, d + b * 0.125, third, d - b * 0.125]
}
