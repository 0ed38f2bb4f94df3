//! Lobes: functions of the angle to an axis.

use std::f64::consts::PI;

/// Coefficients of the Legendre polynomial of degree `l`, by powers.
fn legendre(l: usize) -> Vec<f64> {
    let (mut before, mut now) = (vec![0.0], vec![1.0]);
    for k in 0..l {
        let mut next = vec![0.0; k + 2];
        for (power, c) in now.iter().enumerate() {
            next[power + 1] += c * (2 * k + 1) as f64 / (k + 1) as f64;
        }
        for (power, c) in before.iter().enumerate().take(k) {
            next[power] -= c * k as f64 / (k + 1) as f64;
        }
        (before, now) = (now, next);
    }
    now
}

/// What `max(cos, 0)^exponent` about an axis multiplies each band with:
/// `2π ∫₀¹ z^exponent P_l(z) dz` (Funk and Hecke). Exponent 0 is the half space, 1 the
/// cosine of Lambert's law.
pub fn cosine_power(exponent: f64, bands: usize) -> Vec<f64> {
    let band = |l: usize| {
        let powers = legendre(l).into_iter().enumerate();
        let integral: f64 = powers.map(|(k, c)| c / (exponent + k as f64 + 1.0)).sum();
        2.0 * PI * integral
    };
    (0..bands).map(band).collect()
}

/// The same of the highlight that shaders compute, whose power is linear between whole
/// exponents ([`gnomon_shaders::surface::power`]).
pub fn phong_lobe(exponent: f32, bands: usize) -> Vec<f64> {
    let limited = f64::from(exponent.clamp(0.0, gnomon_shaders::surface::MAX_SHININESS));
    let (whole, part) = (limited.floor(), limited - limited.floor());
    let [low, high] = [whole, whole + 1.0].map(|n| cosine_power(n, bands));
    let mixed = low.iter().zip(&high);
    mixed.map(|(a, b)| a * (1.0 - part) + b * part).collect()
}
