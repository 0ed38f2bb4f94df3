//! Run-time choice of the instruction set.

use core::fmt;
use core::str::FromStr;

use fearless_simd::{Fallback, Level};

use super::Lanes;

/// The levels that code is compiled for, each once: what can be chosen is what
/// [`with_lanes`] matches, on every target.
macro_rules! levels {
    ($($arch:literal: $($variant:ident $name:literal $ask:ident;)*)*) => {
        /// Proof that the CPU has a level.
        #[derive(Clone, Copy)]
        pub(crate) enum Token {
            Scalar(Fallback),
            $($(
                #[cfg(target_arch = $arch)]
                $variant(fearless_simd::$variant),
            )*)*
        }

        impl Token {
            fn name(self) -> &'static str {
                match self {
                    Self::Scalar(_) => "scalar",
                    $($(
                        #[cfg(target_arch = $arch)]
                        Self::$variant(_) => $name,
                    )*)*
                }
            }

            /// Those that a CPU with `level` has, narrowest first.
            #[allow(unused_variables, reason = "some targets have the scalar level only")]
            fn all_of(level: Level) -> Vec<Self> {
                #[allow(unused_mut, reason = "likewise")]
                let mut all = vec![Self::Scalar(Fallback::new())];
                $($(
                    #[cfg(target_arch = $arch)]
                    all.extend(level.$ask().map(Self::$variant));
                )*)*
                all
            }
        }
    };
}
// SSE4.2 alone gains too little over SSE2 to be compiled as a level of its own.
levels! {
    "x86_64":
        Sse2 "sse2" as_sse2;
        Avx2 "avx2" as_avx2;
        Avx512 "avx512" as_avx512;
    "aarch64":
        Neon "neon" as_neon;
}

/// An instruction-set level that this machine can run.
///
/// A value other than [`SimdLevel::scalar`] exists only where the CPU has been
/// asked: [`SimdLevel::detect`] and the [`FromStr`] implementation are the only
/// ways to one.
#[derive(Clone, Copy)]
pub struct SimdLevel {
    token: Token,
}

/// Code over lanes outside of shaders, which [`SimdLevel::run`] compiles for every level.
pub trait LaneProgram {
    /// What it gives.
    type Output;

    /// The program; `#[inline(always)]`, as is all that it calls.
    fn run<L: Lanes>(self, l: L) -> Self::Output;
}

/// A level's name that is unknown, or that this CPU cannot run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("SIMD level `{given}` cannot be used here; this CPU has: auto, {}", .available.join(", "))]
pub struct UnknownSimdLevel {
    /// What was asked for.
    pub given: String,
    /// Names that would be valid on this machine.
    pub available: Vec<&'static str>,
}

impl SimdLevel {
    /// The widest level that the CPU has, of those that there is code for: the scalar
    /// one on architectures without any.
    #[must_use]
    pub fn detect() -> Self {
        #[allow(clippy::disallowed_methods, reason = "the one place that asks the CPU")]
        let all = Token::all_of(Level::new());
        Self {
            token: all[all.len() - 1],
        }
    }

    /// One lane at a time, on any machine.
    #[must_use]
    pub fn scalar() -> Self {
        Self {
            token: Token::Scalar(Fallback::new()),
        }
    }

    /// Every level that this machine has, narrowest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        if cfg!(gnomon_widest) {
            return vec![Self::detect()];
        }
        #[allow(clippy::disallowed_methods, reason = "the same CPU is asked")]
        let all = Token::all_of(Level::new());
        all.into_iter().map(|token| Self { token }).collect()
    }

    /// The level's stable name: `scalar`, `sse2`, `avx2`, `avx512`, `neon`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.token.name()
    }

    /// The Rust type of the token that shaders are compiled for, for debuggers.
    #[must_use]
    pub fn type_name(self) -> &'static str {
        with_lanes!(self, l => core::any::type_name_of_val(&l))
    }

    /// Runs `program` as it is compiled for this level.
    #[inline]
    pub fn run<P: LaneProgram>(self, program: P) -> P::Output {
        with_lanes!(self, l => program.run(l))
    }

    pub(crate) fn token(self) -> Token {
        self.token
    }
}

/// Runs `$op` with `$lanes` bound to the token of `$level`, in code compiled for
/// that instruction set.
///
/// The token is matched here and not by `fearless_simd::dispatch!`, which
/// forwards a lower level to a higher baseline: a forced level must be what runs.
/// `--cfg gnomon_widest` leaves the other levels out, for quick builds while one
/// profiles; the machine must have AVX-512 or NEON then.
macro_rules! with_lanes {
    ($level:expr, $lanes:ident => $op:expr) => {{
        #[allow(unused_imports, reason = "the scalar level does without")]
        use fearless_simd::Simd as _;
        match $level.token() {
            #[cfg(not(gnomon_widest))]
            $crate::simd::Token::Scalar($lanes) => $op,
            #[cfg(all(target_arch = "x86_64", not(gnomon_widest)))]
            $crate::simd::Token::Sse2($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(all(target_arch = "x86_64", not(gnomon_widest)))]
            $crate::simd::Token::Avx2($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(target_arch = "x86_64")]
            $crate::simd::Token::Avx512($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(target_arch = "aarch64")]
            $crate::simd::Token::Neon($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(gnomon_widest)]
            _ => panic!("built with --cfg gnomon_widest, which needs AVX-512 or NEON"),
        }
    }};
}
pub(crate) use with_lanes;

impl Default for SimdLevel {
    fn default() -> Self {
        Self::detect()
    }
}

impl PartialEq for SimdLevel {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for SimdLevel {}

impl fmt::Debug for SimdLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for SimdLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for SimdLevel {
    type Err = UnknownSimdLevel;

    fn from_str(s: &str) -> Result<Self, UnknownSimdLevel> {
        if s == "auto" {
            return Ok(Self::detect());
        }
        let available = Self::available();
        available
            .iter()
            .copied()
            .find(|l| l.name() == s)
            .ok_or_else(|| UnknownSimdLevel {
                given: s.to_owned(),
                available: available.iter().map(|l| l.name()).collect(),
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip_and_nonsense_is_refused() {
        for l in SimdLevel::available() {
            assert_eq!(l.name().parse::<SimdLevel>().unwrap(), l);
        }
        let e = "mmx".parse::<SimdLevel>().unwrap_err();
        assert!(
            e.to_string().contains("mmx") && e.to_string().contains("scalar"),
            "{e}"
        );
    }

    #[test]
    fn what_is_detected_is_the_widest_that_is_available() {
        assert_eq!(
            SimdLevel::available().last().copied(),
            Some(SimdLevel::detect())
        );
        assert_eq!("auto".parse(), Ok(SimdLevel::detect()));
    }

    /// As on an architecture that no vector code is compiled for: whatever the CPU
    /// has, the list starts with what always runs.
    #[test]
    fn a_cpu_without_a_known_level_falls_back_to_the_scalar_one() {
        let all = Token::all_of(Level::fallback());
        let names: Vec<_> = all.into_iter().map(Token::name).collect();
        assert_eq!(names, ["scalar"]);
    }

    #[test]
    fn with_lanes_runs_the_level_asked_for() {
        for l in SimdLevel::available() {
            let ran = with_lanes!(l, s => format!("{:?}", s.level())).to_lowercase();
            let name = if l == SimdLevel::scalar() {
                "fallback"
            } else {
                l.name()
            };
            assert!(ran.starts_with(name), "{ran} ran for {l}");
        }
    }
}
