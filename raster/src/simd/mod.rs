//! The lane facade: one algorithm for every instruction set.
//!
//! All vector code of Gnomon is written against four types of
//! [`LANES`] = 16 logical lanes, [`F32`], [`I32`], [`U32`] and [`Mask`], generic
//! over [`Lanes`]. What is *absent* from them is the point: no fused
//! multiply-add, no approximate reciprocal, no `min`/`max` with the NaN rules of
//! one instruction set, no conversion whose out-of-range result depends on the
//! CPU, no horizontal float sum. Whatever can be written with them gives the
//! same bits at every [`SimdLevel`].
//!
//! The lanes of a packet are the pixels of an 8×2 strip of an 8×8 block:
//! lane `i` is column `i % 8`, row `i / 8`, so that a packet holds four whole
//! 2×2 quads and derivatives are lane permutations.

mod double;
mod float;
#[cfg(target_arch = "x86_64")]
mod half;
mod int;
mod level;
mod mask;
mod seam;
mod short;

pub(crate) use double::{F64, round_to_i32};
pub use float::F32;
pub use int::{I32, U32};
pub use level::{LaneProgram, SimdLevel, UnknownSimdLevel};
pub(crate) use level::{Token, with_lanes};
pub use mask::Mask;
pub(crate) use seam::outlined;
pub use seam::{each3, each4};
pub(crate) use short::{Mask16, U16};

use fearless_simd::{Simd, f32x16, u16x16};

/// Logical lanes of a packet, whatever the width of the machine's registers.
pub const LANES: usize = 16;

/// An instruction set to compute on, as a zero-sized proof that the CPU has it.
///
/// The [`fearless_simd::Simd`] tokens of the supported levels are ones. The indirection leaves room for
/// *precision modes*: a wrapper whose [`Lanes::round`] rounds every arithmetic
/// result to fp24 or fp16, as the target GPUs did, is one more instantiation.
pub trait Lanes: Copy + Send + Sync + 'static {
    /// The instruction set that does the arithmetic.
    type Isa: Simd;

    /// The proof token of the instruction set.
    fn isa(self) -> Self::Isa;

    /// Runs `f` in a function of its own, compiled for the level.
    #[doc(hidden)]
    #[inline(always)]
    fn apart<T>(self, f: impl FnOnce() -> T) -> T {
        self.isa().vectorize(f)
    }

    /// One operation on lanes. The scalar level has it as a function: a hundred
    /// instructions at each place where it is used would be most of the code, and of
    /// the time it takes to compile.
    #[doc(hidden)]
    #[inline(always)]
    fn op<T>(self, f: impl FnOnce() -> T) -> T {
        f()
    }

    /// Told of each look-up in a texture.
    #[doc(hidden)]
    #[inline(always)]
    fn looked_up(self) {}

    /// What every float operation's result passes through; the identity for
    /// full precision.
    #[inline(always)]
    fn round(self, v: f32x16<Self::Isa>) -> f32x16<Self::Isa> {
        v
    }

    /// Halves of floats by an instruction, ties to even; `None` where there is none. A
    /// NaN stays some NaN.
    #[doc(hidden)]
    #[inline(always)]
    fn half_from_float(self, _v: f32x16<Self::Isa>) -> Option<u16x16<Self::Isa>> {
        None
    }

    /// The reverse, exact.
    #[doc(hidden)]
    #[inline(always)]
    fn float_from_half(self, _h: u16x16<Self::Isa>) -> Option<f32x16<Self::Isa>> {
        None
    }
}

/// A level that the compiler would otherwise inline into functions of 100,000 lines:
/// the scalar one has no instruction set to keep its calls apart.
impl Lanes for fearless_simd::Fallback {
    type Isa = Self;

    #[inline(always)]
    fn isa(self) -> Self {
        self
    }

    #[inline(always)]
    fn apart<T>(self, f: impl FnOnce() -> T) -> T {
        #[inline(never)]
        fn call<T>(f: impl FnOnce() -> T) -> T {
            f()
        }
        call(f)
    }

    #[inline(always)]
    fn op<T>(self, f: impl FnOnce() -> T) -> T {
        self.apart(f)
    }
}

macro_rules! isa {
    ($($arch:literal: $($level:ident $({ $($method:tt)* })?)*;)*) => {$($(
        #[cfg(target_arch = $arch)]
        impl Lanes for fearless_simd::$level {
            type Isa = Self;

            #[inline(always)]
            fn isa(self) -> Self {
                self
            }

            $($($method)*)?
        }
    )*)*};
}
isa! {
    "x86_64":
        Sse2
        Avx2 {
            #[inline(always)]
            fn half_from_float(self, v: f32x16<Self>) -> Option<u16x16<Self>> {
                Some(half::half_from_float_avx2(self, v))
            }

            #[inline(always)]
            fn float_from_half(self, h: u16x16<Self>) -> Option<f32x16<Self>> {
                Some(half::float_from_half_avx2(self, h))
            }
        }
        Avx512 {
            #[inline(always)]
            fn half_from_float(self, v: f32x16<Self>) -> Option<u16x16<Self>> {
                Some(half::half_from_float_avx512(self, v))
            }

            #[inline(always)]
            fn float_from_half(self, h: u16x16<Self>) -> Option<f32x16<Self>> {
                Some(half::float_from_half_avx512(self, h))
            }
        };
    "aarch64": Neon;
}
