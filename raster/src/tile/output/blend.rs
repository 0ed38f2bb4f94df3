//! Blending of one channel (`state::blend` has the formulas), of bytes and of floats.

use core::ops::{Add, Mul, Sub};

use crate::simd::{F32, I32, Lanes};
use crate::state::{BlendComponent, BlendFactor, BlendOperation};

/// What is blended: floats, or bytes as integers.
pub(super) trait Operand<L: Lanes>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    fn zero(l: L) -> Self;
    /// The factor that leaves the other one as it is: 1.0, or 255.
    fn one(l: L) -> Self;
    fn lesser(self, o: Self) -> Self;
    fn greater(self, o: Self) -> Self;
}

impl<L: Lanes> Operand<L> for F32<L> {
    #[inline(always)]
    fn zero(l: L) -> Self {
        Self::splat(l, 0.0)
    }
    #[inline(always)]
    fn one(l: L) -> Self {
        Self::splat(l, 1.0)
    }
    #[inline(always)]
    fn lesser(self, o: Self) -> Self {
        self.min(o)
    }
    #[inline(always)]
    fn greater(self, o: Self) -> Self {
        self.max(o)
    }
}

impl<L: Lanes> Operand<L> for I32<L> {
    #[inline(always)]
    fn zero(l: L) -> Self {
        Self::splat(l, 0)
    }
    #[inline(always)]
    fn one(l: L) -> Self {
        Self::splat(l, 255)
    }
    #[inline(always)]
    fn lesser(self, o: Self) -> Self {
        self.min(o)
    }
    #[inline(always)]
    fn greater(self, o: Self) -> Self {
        self.max(o)
    }
}

/// One channel of a packet: source, destination, and what factors are made of.
pub(super) struct Operands<T> {
    /// 0 is red, 3 alpha.
    pub(super) channel: usize,
    pub(super) src: T,
    pub(super) dst: T,
    pub(super) src_alpha: T,
    /// The blend constant's channel.
    pub(super) constant: T,
}

/// The operands as the operation takes them: times their factors, if they have any.
/// `dst_alpha` gives the destination's alpha, which few factors need.
#[inline(always)]
pub(super) fn weigh<L: Lanes, T: Operand<L>>(
    l: L,
    b: &BlendComponent,
    o: &Operands<T>,
    dst_alpha: impl Fn() -> T,
) -> [T; 2] {
    if b.is_extreme() {
        return [o.src, o.dst];
    }
    [
        o.src * factor(l, b.src_factor, o, &dst_alpha),
        o.dst * factor(l, b.dst_factor, o, &dst_alpha),
    ]
}

/// What the operation makes of source and destination.
#[inline(always)]
pub(super) fn combine<L: Lanes, T: Operand<L>>(operation: BlendOperation, [s, d]: [T; 2]) -> T {
    match operation {
        BlendOperation::Add => s + d,
        BlendOperation::Subtract => s - d,
        BlendOperation::ReverseSubtract => d - s,
        BlendOperation::Min => s.lesser(d),
        BlendOperation::Max => s.greater(d),
    }
}

#[inline(always)]
fn factor<L: Lanes, T: Operand<L>>(
    l: L,
    f: BlendFactor,
    o: &Operands<T>,
    dst_alpha: &impl Fn() -> T,
) -> T {
    let one = T::one(l);
    match f {
        BlendFactor::Zero => T::zero(l),
        BlendFactor::One => one,
        BlendFactor::Src => o.src,
        BlendFactor::OneMinusSrc => one - o.src,
        BlendFactor::SrcAlpha => o.src_alpha,
        BlendFactor::OneMinusSrcAlpha => one - o.src_alpha,
        BlendFactor::Dst => o.dst,
        BlendFactor::OneMinusDst => one - o.dst,
        BlendFactor::DstAlpha => dst_alpha(),
        BlendFactor::OneMinusDstAlpha => one - dst_alpha(),
        BlendFactor::SrcAlphaSaturated if o.channel == 3 => one,
        BlendFactor::SrcAlphaSaturated => o.src_alpha.lesser(one - dst_alpha()),
        BlendFactor::Constant => o.constant,
        BlendFactor::OneMinusConstant => one - o.constant,
    }
}
