//! The binary logarithm (texture rules, §7).

/// log₂ x to the bit.
pub(super) fn log2(x: f32) -> f32 {
    if x == 0.0 {
        return f32::NEG_INFINITY;
    }
    if x.is_nan() || x < 0.0 {
        return f32::from_bits(0x7fc0_0000);
    }
    if x == f32::INFINITY {
        return x;
    }
    let (m, k) = parts(x);
    let f = m - 1.0;
    let s = f / (f + 2.0);
    let z = s * s;
    let r = (((z * 0.242_788_57 + 0.284_987_93) * z + 0.400_009_72) * z + 0.666_666_6) * z;
    let h = (f * f) * 0.5;
    let rest = s * (h + r);
    let high = f32::from_bits((f - h).to_bits() & 0xffff_f000);
    let low = ((f - high) - h) + rest;
    let (c0, c1) = (1.442_871_1, -0.000_176_052_85);
    (((low + high) * c1 + low * c0) + high * c0) + k
}

/// m and k with x = m·2ᵏ, m from the float 0x3f3504f4 up to below twice that.
fn parts(x: f32) -> (f32, f32) {
    let mut m = f64::from(x);
    let mut k = 0.0;
    let low = f64::from(f32::from_bits(0x3f35_04f4));
    while m < low {
        m *= 2.0;
        k -= 1.0;
    }
    while m >= 2.0 * low {
        m *= 0.5;
        k += 1.0;
    }
    (m as f32, k)
}

#[cfg(test)]
mod tests {
    use super::super::super::convert::pow2;
    use super::*;

    #[test]
    fn powers_of_two_are_exact_and_others_near() {
        for k in -149..128 {
            assert_eq!(log2(pow2(k) as f32), k as f32);
        }
        for (x, exact) in [
            (3.0, 1.584_962_5),
            (0.7, -0.514_573_2),
            (5.0, 2.321_928),
            (0.3, -1.736_965_6),
        ] {
            assert!((log2(x) - exact).abs() < 4e-7, "{x}: {}", log2(x));
        }
        for x in [-1.0, f32::NAN] {
            assert_eq!(log2(x).to_bits(), 0x7fc0_0000);
        }
        assert_eq!(
            [0.0, f32::INFINITY].map(log2),
            [f32::NEG_INFINITY, f32::INFINITY]
        );
    }
}
