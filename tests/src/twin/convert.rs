//! Conversions between floats and stored values, from their definitions.

/// Nearest integer, ties to even.
pub(super) fn rne(v: f64) -> f64 {
    let below = v.floor();
    let rest = v - below;
    let odd = below % 2.0 != 0.0;
    if rest > 0.5 || (rest == 0.5 && odd) {
        below + 1.0
    } else {
        below
    }
}

/// 2ᵉ for e in −1022..=1023.
pub(super) fn pow2(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

/// floor(log₂ v) of a normal positive double.
pub(super) fn floor_log2(v: f64) -> i32 {
    ((v.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

/// The value limited to 0..=1; NaN becomes 0.
pub(super) fn unit(v: f32) -> f32 {
    match v {
        v if v.is_nan() || v <= 0.0 => 0.0,
        v if v >= 1.0 => 1.0,
        v => v,
    }
}

/// Float to 8-bit unorm.
#[must_use]
pub fn unorm8(v: f32) -> u32 {
    rne(f64::from(unit(v) * 255.0f32)) as u32
}

/// `round(t / 255)`.
#[must_use]
pub fn div255_round(t: u32) -> u32 {
    (2 * t + 255) / 510
}

/// Float in 0..=1 to D24.
pub(super) fn d24(v: f32) -> u32 {
    rne(f64::from(unit(v) * 16_777_215.0f32)) as u32
}

/// Rounded and limited signed 16-bit integer, and whether it was out of range.
pub(super) fn sint16(v: f32) -> (i32, bool) {
    if v.is_nan() {
        return (0, true);
    }
    let r = rne(f64::from(v));
    (
        r.clamp(-32768.0, 32767.0) as i32,
        !(-32768.0..=32767.0).contains(&r),
    )
}

/// Float to half bits, ties to even; NaN becomes 0x7e00.
#[must_use]
pub fn f16_bits(v: f32) -> u32 {
    if v.is_nan() {
        return 0x7e00;
    }
    let sign = if v.is_sign_negative() { 0x8000 } else { 0 };
    let a = f64::from(v.abs());
    if a >= 65520.0 {
        return sign | 0x7c00;
    }
    if a < pow2(-14) {
        return sign | rne(a / pow2(-24)) as u32;
    }
    let e = floor_log2(a);
    let steps = rne(a / pow2(e - 10)) as u32;
    sign | ((((e + 15) as u32) << 10) + (steps - 1024))
}

/// Half bits to float, exact.
pub(super) fn f16_value(bits: u32) -> f32 {
    let (e, m) = ((bits >> 10 & 31) as i32, f64::from(bits & 1023));
    let a = match e {
        0 => m * pow2(-24),
        31 if m == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + m) * pow2(e - 25),
    };
    (if bits & 0x8000 != 0 { -a } else { a }) as f32
}

/// Bits of a float, every NaN being 0x7fc0_0000.
pub(super) fn f32_bits(v: f32) -> u32 {
    if v.is_nan() { 0x7fc0_0000 } else { v.to_bits() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_takes_ties_to_even() {
        for (v, r) in [
            (0.5, 0.0),
            (1.5, 2.0),
            (2.5, 2.0),
            (-0.5, 0.0),
            (-1.5, -2.0),
            (-2.5, -2.0),
            (2.51, 3.0),
        ] {
            assert_eq!(rne(v), r, "{v}");
        }
    }

    #[test]
    fn every_half_survives_the_way_through_float() {
        for b in 0..=0xffffu32 {
            let v = f16_value(b);
            assert_eq!(f16_bits(v), if v.is_nan() { 0x7e00 } else { b }, "{b:#06x}");
        }
    }

    #[test]
    fn halves_round_to_even_between_neighbours() {
        assert_eq!(f16_bits(1.0 + 1.0 / 2048.0), 0x3c00);
        assert_eq!(f16_bits(1.0 + 3.0 / 2048.0), 0x3c02);
        assert_eq!(f16_bits(65519.996), 0x7bff);
        assert_eq!(f16_bits(65520.0), 0x7c00);
        assert_eq!(f16_bits(-1e-8), 0x8000);
    }
}
