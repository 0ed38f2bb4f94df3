//! Sweeps of the functions of this folder over bit patterns: measured error
//! against a double-precision reference, and the same bits at every level.

use rayon::prelude::*;

use crate::simd::{LANES, SimdLevel};

/// Largest error in ulp for arguments from `from` to `to`.
pub(super) struct Claim {
    pub(super) error: f64,
    pub(super) from: f32,
    pub(super) to: f32,
}

/// What is swept: `f(a)` or `f(a, b)`.
pub(super) struct Subject {
    pub(super) name: &'static str,
    pub(super) lanes: fn(SimdLevel, &Packet) -> [f32; LANES],
    pub(super) scalar: fn(f32, f32) -> f32,
    pub(super) reference: fn(f64, f64) -> f64,
    pub(super) claim: Claim,
}

/// Two arguments for each lane.
pub(super) type Packet = [[f32; LANES]; 2];

/// Every `CI_STRIDE`-th bit pattern in the tests of every day.
pub(super) const CI_STRIDE: u64 = 1021;

/// 1, or what the environment variable `GNOMON_MATH_STRIDE` said at compile time.
pub(super) fn exhaustive_stride() -> u64 {
    option_env!("GNOMON_MATH_STRIDE")
        .and_then(|s| s.parse().ok())
        .unwrap_or(1)
}

pub(super) fn bits(x: f32) -> u32 {
    x.to_bits()
}

/// The error of `got` in units of the last place of `want`.
fn ulps(got: f32, want: f64) -> f64 {
    if got.is_nan() || want.is_nan() {
        return if got.is_nan() && want.is_nan() {
            0.0
        } else {
            f64::INFINITY
        };
    }
    if bits(got) == bits(want as f32) && !got.is_finite() {
        return 0.0;
    }
    let exponent = ((want.abs().to_bits() >> 52) as i64 - 1023).clamp(-126, 127);
    let ulp = f64::from_bits(((exponent - 23 + 1023) as u64) << 52);
    let got = if got.is_infinite() {
        f64::from(got.signum()) * 2.0 * f64::from_bits((127 + 1023) << 52)
    } else {
        f64::from(got)
    };
    (got - want).abs() / ulp
}

/// Largest error over one packet, after comparing the bits of all levels.
fn packet_error(s: &Subject, levels: &[SimdLevel], p: &Packet) -> (f64, f32) {
    let want: [f32; LANES] = core::array::from_fn(|i| (s.scalar)(p[0][i], p[1][i]));
    for level in levels {
        let got = (s.lanes)(*level, p);
        assert_eq!(
            got.map(bits),
            want.map(bits),
            "{} at {level}: {p:?}",
            s.name
        );
    }
    let mut worst = (0.0, 0.0);
    for i in (0..LANES).filter(|i| p[0][*i] >= s.claim.from && p[0][*i] <= s.claim.to) {
        let e = ulps(
            want[i],
            (s.reference)(f64::from(p[0][i]), f64::from(p[1][i])),
        );
        if e > worst.0 {
            worst = (e, p[0][i]);
        }
    }
    worst
}

fn verdict(s: &Subject, worst: (f64, f32)) {
    assert!(
        worst.0 <= s.claim.error,
        "{}: {} ulp at {:?}, claimed {}",
        s.name,
        worst.0,
        worst.1,
        s.claim.error
    );
}

fn larger(a: (f64, f32), b: (f64, f32)) -> (f64, f32) {
    if b.0 > a.0 { b } else { a }
}

/// Every `stride`-th of all floats.
pub(super) fn sweep_single(s: &Subject, stride: u64) {
    let levels = SimdLevel::available();
    let packets = (1u64 << 32).div_ceil(stride * LANES as u64);
    let worst = (0..packets)
        .into_par_iter()
        .map(|p| {
            let at = |i: usize| f32::from_bits(((p * LANES as u64 + i as u64) * stride) as u32);
            let x = core::array::from_fn(at);
            packet_error(s, &levels, &[x, x])
        })
        .reduce(|| (0.0, 0.0), larger);
    verdict(s, worst);
}

/// A seeded source of argument pairs.
pub(super) struct Pairs(u64);

impl Pairs {
    fn next(&mut self) -> u32 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as u32
    }

    /// A base, and an exponent that leads into (or just out of) the range.
    pub(super) fn powers(&mut self) -> [f32; 2] {
        let x = match self.next() % 4 {
            0 => f32::from_bits(self.next()),
            1 => f32::from_bits(self.next() & 0x7fff_ffff),
            2 => self.next() as f32 / 4_294_967_296.0,
            _ => f32::from_bits(0x3f80_0000 - 4096 + self.next() % 8192),
        };
        let y = match self.next() % 4 {
            0 => f32::from_bits(self.next()),
            1 => (self.next() % 64) as f32,
            _ => {
                let target = self.next() as f64 / 4_294_967_296.0 * 280.0 - 151.0;
                (target / libm::log2(f64::from(x.abs()))) as f32
            }
        };
        [x, y]
    }

    /// Points of the plane, of like and of unlike magnitudes.
    pub(super) fn angles(&mut self) -> [f32; 2] {
        let unit = |v: u32| v as f32 / 2_147_483_648.0 - 1.0;
        match self.next() % 2 {
            0 => [f32::from_bits(self.next()), f32::from_bits(self.next())],
            _ => [unit(self.next()), unit(self.next())],
        }
    }
}

/// `packets` packets of seeded pairs.
pub(super) fn sweep_double(s: &Subject, pair: fn(&mut Pairs) -> [f32; 2], packets: u64) {
    let levels = SimdLevel::available();
    let worst = (0..packets)
        .into_par_iter()
        .map(|seed| {
            let mut source = Pairs(seed.wrapping_mul(0x1234_5678_9abc_def1));
            let mut p = [[0.0; LANES]; 2];
            for i in 0..LANES {
                [p[0][i], p[1][i]] = pair(&mut source);
            }
            packet_error(s, &levels, &p)
        })
        .reduce(|| (0.0, 0.0), larger);
    verdict(s, worst);
}

/// A module of tests for each function of one argument.
macro_rules! sweep {
    ($($name:ident: $claim:expr, $reference:path;)*) => { $(
        mod $name {
            use super::*;
            use crate::math::check::{CI_STRIDE, Subject, exhaustive_stride, sweep_single};
            use crate::simd::{F32, with_lanes};

            fn subject() -> Subject {
                Subject {
                    name: stringify!($name),
                    lanes: |level, p| with_lanes!(level, l => math::$name(F32::from_array(l, &p[0])).to_array()),
                    scalar: |x, _| scalar::$name(x),
                    reference: |x, _| $reference(x),
                    claim: $claim,
                }
            }

            #[test]
            fn error_and_bits_strided() {
                sweep_single(&subject(), CI_STRIDE);
            }

            #[test]
            #[ignore = "all 2^32 floats: minutes in a release build"]
            fn error_and_bits_exhaustive() {
                sweep_single(&subject(), exhaustive_stride());
            }
        }
    )* };
}
pub(crate) use sweep;

/// A module of tests for each function of two arguments.
macro_rules! sweep_pairs {
    ($($name:ident: $claim:expr, $reference:path, $pairs:path;)*) => { $(
        mod $name {
            use super::*;
            use crate::math::check::{Subject, sweep_double};
            use crate::simd::{F32, with_lanes};

            fn subject() -> Subject {
                Subject {
                    name: stringify!($name),
                    lanes: |level, p| with_lanes!(level, l =>
                        math::$name(F32::from_array(l, &p[0]), F32::from_array(l, &p[1])).to_array()),
                    scalar: scalar::$name,
                    reference: $reference,
                    claim: $claim,
                }
            }

            #[test]
            fn error_and_bits_seeded() {
                sweep_double(&subject(), $pairs, 100_000);
            }

            #[test]
            #[ignore = "a thousand million pairs: minutes in a release build"]
            fn error_and_bits_many() {
                sweep_double(&subject(), $pairs, 1 << 26);
            }
        }
    )* };
}
pub(crate) use sweep_pairs;
