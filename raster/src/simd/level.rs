//! Run-time choice of the instruction set.

use core::fmt;
use core::str::FromStr;

use fearless_simd::Level;

/// An instruction-set level that this machine can run.
///
/// A value other than [`SimdLevel::scalar`] exists only where the CPU has been
/// asked: [`SimdLevel::detect`] and the [`FromStr`] implementation are the only
/// ways to one.
#[derive(Clone, Copy)]
pub struct SimdLevel {
    level: Level,
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
    /// The widest level that the CPU has.
    #[must_use]
    pub fn detect() -> Self {
        #[allow(clippy::disallowed_methods, reason = "the one place that asks the CPU")]
        let level = Level::new();
        // SSE4.2 alone gains too little over SSE2 to be compiled as a level of its own.
        #[cfg(target_arch = "x86_64")]
        if let (Level::Sse4_2(_), Some(sse2)) = (level, level.as_sse2()) {
            return Self {
                level: Level::Sse2(sse2),
            };
        }
        Self { level }
    }

    /// One lane at a time, on any machine.
    #[must_use]
    pub fn scalar() -> Self {
        Self {
            level: Level::fallback(),
        }
    }

    /// Every level that this machine has, narrowest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        if cfg!(gnomon_widest) {
            return vec![Self::detect()];
        }
        let best = Self::detect().level;
        let mut levels = vec![Self::scalar()];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(best.as_sse2().map(|t| Self {
                level: Level::Sse2(t),
            }));
            levels.extend(best.as_avx2().map(|t| Self {
                level: Level::Avx2(t),
            }));
            levels.extend(best.as_avx512().map(|t| Self {
                level: Level::Avx512(t),
            }));
        }
        #[cfg(target_arch = "aarch64")]
        levels.extend(best.as_neon().map(|t| Self {
            level: Level::Neon(t),
        }));
        let _ = best;
        levels
    }

    /// The level's stable name: `scalar`, `sse2`, `avx2`, `avx512`, `neon`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.level {
            Level::Fallback(_) => "scalar",
            #[cfg(target_arch = "x86_64")]
            Level::Sse2(_) => "sse2",
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(_) => "avx512",
            #[cfg(target_arch = "aarch64")]
            Level::Neon(_) => "neon",
            _ => "other",
        }
    }

    pub(crate) fn level(self) -> Level {
        self.level
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
        use fearless_simd::Simd as _;
        match $level.level() {
            #[cfg(not(gnomon_widest))]
            fearless_simd::Level::Fallback($lanes) => $op,
            #[cfg(all(target_arch = "x86_64", not(gnomon_widest)))]
            fearless_simd::Level::Sse2($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(all(target_arch = "x86_64", not(gnomon_widest)))]
            fearless_simd::Level::Avx2($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(target_arch = "x86_64")]
            fearless_simd::Level::Avx512($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            #[cfg(target_arch = "aarch64")]
            fearless_simd::Level::Neon($lanes) => $lanes.vectorize(
                #[inline(always)]
                || $op,
            ),
            _ => unreachable!("SimdLevel is built from the levels above only"),
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
    fn with_lanes_runs_the_level_asked_for() {
        for l in SimdLevel::available() {
            let got = with_lanes!(l, s => format!("{:?}", s.level()));
            assert!(!got.is_empty());
            let ran = with_lanes!(l, s => SimdLevel { level: s.level() }.name());
            assert_eq!(ran, l.name());
        }
    }
}
