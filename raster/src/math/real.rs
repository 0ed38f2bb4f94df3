//! What the algorithms of this folder compute on: sixteen lanes, or one `f32`.
//!
//! Each function is written once, over [`Real`]; the lanes and the scalar twin
//! are two instantiations of the same expression tree, and so agree to the bit.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::simd::{F32, I32, LANES, Lanes, Mask};

/// A float or sixteen of them: correctly rounded arithmetic, comparisons and a
/// few exact bit operations. Implemented by `f32` and [`F32`] only.
pub trait Real:
    Sealed
    + Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// A truth value, or one a lane.
    type Test: Copy
        + BitAnd<Output = Self::Test>
        + BitOr<Output = Self::Test>
        + Not<Output = Self::Test>;

    /// The constant, as wide as `self`.
    fn lit(self, x: f32) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Largest integer not above.
    fn floor(self) -> Self;
    /// Nearest integer, ties to even.
    fn rint(self) -> Self;
    /// `self < o`.
    fn lt(self, o: Self) -> Self::Test;
    /// `self == o`.
    fn eq(self, o: Self) -> Self::Test;
    /// Whether the sign bit is set; of a NaN it may be on one machine and not on another.
    fn negative(self) -> Self::Test;
    /// `if test { yes } else { no }`.
    fn pick(test: Self::Test, yes: Self, no: Self) -> Self;
    /// `self` with its sign flipped where `of` has the sign bit set; `of` is no NaN.
    fn flip_by(self, of: Self) -> Self;
    /// The leading 12 significant bits; the rest cut off.
    fn head(self) -> Self;
    /// 2^k of an integer −126 ≤ k ≤ 127.
    fn pow2(k: Self) -> Self;
    /// `x = m·2^k` with √½ ≤ m < √2 for a normal positive x.
    fn split(self) -> (Self, Self);
    /// Replaces `values` by `f(self)` where `test` holds; for rare cases.
    fn patch(self, test: Self::Test, values: [Self; 3], f: fn(f32) -> [f32; 3]) -> [Self; 3];

    /// `self > o`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn gt(self, o: Self) -> Self::Test {
        o.lt(self)
    }

    /// `if lo < self { self } else { lo }`, then `if it < hi { it } else { hi }`; NaN becomes `lo`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn limit(self, lo: f32, hi: f32) -> Self {
        let (lo, hi) = (self.lit(lo), self.lit(hi));
        let raised = Self::pick(self.gt(lo), self, lo);
        Self::pick(raised.lt(hi), raised, hi)
    }

    /// Every NaN replaced by 0x7fc0_0000.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn one_nan(self) -> Self {
        Self::pick(self.eq(self), self, self.lit(NAN))
    }
}

/// Keeps [`Real`] to the two types whose operations are known to agree.
pub trait Sealed {}

impl Sealed for f32 {}
impl<L: Lanes> Sealed for F32<L> {}

/// The canonical NaN.
pub(super) const NAN: f32 = f32::from_bits(0x7fc0_0000);

const SIGN: u32 = 0x8000_0000;
const HEAD: u32 = 0xffff_f000;
/// Bits of the smallest float not below √½.
const SQRT_HALF: i32 = 0x3f35_04f4;
const ONE: i32 = 0x3f80_0000;
const MANTISSA: i32 = 0x007f_ffff;

impl Real for f32 {
    type Test = bool;

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn lit(self, x: f32) -> f32 {
        x
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn abs(self) -> f32 {
        f32::abs(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn floor(self) -> f32 {
        f32::floor(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn rint(self) -> f32 {
        f32::round_ties_even(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn lt(self, o: f32) -> bool {
        self < o
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn eq(self, o: f32) -> bool {
        self == o
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn negative(self) -> bool {
        self.is_sign_negative()
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn pick(test: bool, yes: f32, no: f32) -> f32 {
        if test { yes } else { no }
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn flip_by(self, of: f32) -> f32 {
        f32::from_bits(self.to_bits() ^ (of.to_bits() & SIGN))
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn head(self) -> f32 {
        f32::from_bits(self.to_bits() & HEAD)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn pow2(k: f32) -> f32 {
        f32::from_bits((((k + 127.0) as i32) << 23) as u32)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn split(self) -> (f32, f32) {
        let i = (self.to_bits() as i32).wrapping_add(ONE - SQRT_HALF);
        let m = (i & MANTISSA) + SQRT_HALF;
        (f32::from_bits(m as u32), ((i >> 23) - 127) as f32)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn patch(self, test: bool, values: [f32; 3], f: fn(f32) -> [f32; 3]) -> [f32; 3] {
        if test { f(self) } else { values }
    }
}

impl<L: Lanes> Real for F32<L> {
    type Test = Mask<L>;

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn lit(self, x: f32) -> Self {
        Self::splat(self.lanes(), x)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn abs(self) -> Self {
        F32::abs(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn sqrt(self) -> Self {
        F32::sqrt(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn floor(self) -> Self {
        F32::floor(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn rint(self) -> Self {
        F32::round_ties_even(self)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn lt(self, o: Self) -> Mask<L> {
        F32::lt(self, o)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn eq(self, o: Self) -> Mask<L> {
        F32::eq(self, o)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn negative(self) -> Mask<L> {
        self.raw_bits().to_i32().lt(I32::splat(self.lanes(), 0))
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn pick(test: Mask<L>, yes: Self, no: Self) -> Self {
        test.select_f32(yes, no)
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn flip_by(self, of: Self) -> Self {
        let sign = I32::splat(self.lanes(), SIGN as i32).to_u32();
        (self.raw_bits() ^ (of.raw_bits() & sign)).to_f32_bits()
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn head(self) -> Self {
        let mask = I32::splat(self.lanes(), HEAD as i32).to_u32();
        (self.raw_bits() & mask).to_f32_bits()
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn pow2(k: Self) -> Self {
        ((k + 127.0).to_i32() << 23).to_u32().to_f32_bits()
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn split(self) -> (Self, Self) {
        let l = self.lanes();
        let i = self.raw_bits().to_i32() + I32::splat(l, ONE - SQRT_HALF);
        let m = (i & I32::splat(l, MANTISSA)) + I32::splat(l, SQRT_HALF);
        (
            m.to_u32().to_f32_bits(),
            ((i >> 23) - I32::splat(l, 127)).to_f32(),
        )
    }

    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn patch(self, test: Mask<L>, values: [Self; 3], f: fn(f32) -> [f32; 3]) -> [Self; 3] {
        if test.any() {
            patch_lanes(self, test.bits(), values, f)
        } else {
            values
        }
    }
}

/// The rare side of [`Real::patch`], one lane at a time.
fn patch_lanes<L: Lanes>(
    x: F32<L>,
    test: u16,
    values: [F32<L>; 3],
    f: fn(f32) -> [f32; 3],
) -> [F32<L>; 3] {
    let from = x.to_array();
    let mut to = values.map(F32::to_array);
    for lane in (0..LANES).filter(|lane| test >> lane & 1 != 0) {
        for (slot, v) in to.iter_mut().zip(f(from[lane])) {
            slot[lane] = v;
        }
    }
    to.map(|a| F32::from_array(x.lanes(), &a))
}
