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
    use super::*;

    #[test]
    fn powers_of_two_are_exact_and_others_near() {
        for k in -149..128 {
            let x = f64::from(k).exp2();
            assert_eq!(log2(x as f32), k as f32);
        }
        for x in [3.0f32, 0.7, 0.7072, 1.4142, 1e-40, 1e30] {
            let exact = f64::from(x).log2();
            assert!(
                (f64::from(log2(x)) - exact).abs() < 1e-7 * exact.abs() + 1e-9,
                "{x}"
            );
        }
    }
}
