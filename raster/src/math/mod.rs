//! Deterministic mathematics for shaders.
//!
//! Everything here is built from correctly rounded + − × ÷ √, comparisons and
//! exact bit operations, in one fixed order, without fused multiply-add and
//! without the platform's libm: the same bits at every [`crate::SimdLevel`], on
//! every target, in debug and release. Each function is generic over [`Real`],
//! which sixteen lanes ([`crate::F32`]) and one `f32` implement: two
//! instantiations of one expression tree. [`scalar`] names the latter.
//!
//! ERROR_TABLE
//!
//! A NaN that comes out of a function of this table is always the canonical one,
//! 0x7fc0_0000. Denormal arguments and results are treated like any others.

#[cfg(test)]
pub(crate) mod check;

mod arc;
mod exponential;
mod logarithm;
mod power;
mod real;
mod root;
pub mod scalar;
mod trig;
mod vector;

pub use arc::{acos, asin, atan, atan2};
pub use exponential::{exp, exp2};
pub use logarithm::{ln, log2};
pub use power::pow;
pub use real::Real;
pub use root::rsqrt;
pub use trig::{cos, sin, sin_cos, tan};
pub use vector::{cross, dot2, dot3, dot4, length, mix, normalize, reflect, saturate, smoothstep};
