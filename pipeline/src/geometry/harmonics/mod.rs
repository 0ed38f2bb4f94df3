//! Real spherical harmonics in f64, for light and transport of low frequency (Tamura
//! et al. 2006, §4.1 and §5.1, after Sloan et al. 2002).
//!
//! A function of direction is `f(ω) = Σ c_lm y_lm(ω)`, l below the number of bands, m in
//! -l..=l; coefficient (l, m) is number `l (l + 1) + m`. All y are polynomials of the
//! direction's coordinates, without the Condon-Shortley sign: `y_1,-1`, `y_1,0` and
//! `y_1,1` grow with y, z and x.

mod product;
mod rotation;
#[cfg(test)]
mod tests;
mod zonal;

use std::f64::consts::PI;

use glam::DVec3;

pub use product::Product;
pub use rotation::Rotation;
pub use zonal::{cosine_power, phong_lobe};

/// Most bands that are computed.
pub const MOST_BANDS: usize = 8;

/// Number of coefficients of `bands` bands.
pub const fn terms(bands: usize) -> usize {
    bands * bands
}

/// Number of coefficient (l, m).
pub const fn index(l: usize, m: isize) -> usize {
    (l * (l + 1)).wrapping_add_signed(m)
}

/// Factors of the basis, computed once.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    bands: usize,
    /// Of the terms (l, m), m from 0: number `l (l + 1) / 2 + m`.
    norms: Vec<f64>,
}

impl Basis {
    /// Of that many bands.
    ///
    /// # Panics
    /// There are none, or more than [`MOST_BANDS`].
    pub fn new(bands: usize) -> Self {
        assert!((1..=MOST_BANDS).contains(&bands), "{bands} bands");
        let pairs = (0..bands).flat_map(|l| (0..=l).map(move |m| norm(l, m)));
        Self {
            bands,
            norms: pairs.collect(),
        }
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// All y at a unit vector, [`terms`] of them.
    pub fn at(&self, direction: DVec3) -> Vec<f64> {
        let mut out = vec![0.0; terms(self.bands)];
        self.write(direction, &mut out);
        out
    }

    /// The same into `out`, which is that long.
    pub fn write(&self, d: DVec3, out: &mut [f64]) {
        let (mut cos, mut sin) = (1.0, 0.0); // of m turns, times sin^m of the angle to z
        let mut diagonal = 1.0;
        for m in 0..self.bands {
            self.column(m, d.z, diagonal, |l, legendre| {
                let value = self.norms[l * (l + 1) / 2 + m] * legendre;
                out[index(l, m as isize)] = value * cos;
                if m > 0 {
                    out[index(l, -(m as isize))] = value * sin;
                }
            });
            diagonal *= (2 * m + 1) as f64;
            (cos, sin) = (cos * d.x - sin * d.y, cos * d.y + sin * d.x);
        }
    }

    /// Calls `visit` with l and the associated Legendre polynomial (l, m) without its
    /// power of the sine, for l from m; `diagonal` is that of (m, m).
    fn column(&self, m: usize, z: f64, diagonal: f64, mut visit: impl FnMut(usize, f64)) {
        let (mut before, mut now) = (0.0, diagonal);
        for l in m..self.bands {
            visit(l, now);
            let next =
                (z * (2 * l + 1) as f64 * now - (l + m) as f64 * before) / (l + 1 - m) as f64;
            (before, now) = (now, next);
        }
    }
}

fn norm(l: usize, m: usize) -> f64 {
    let ratio: f64 = (l - m + 1..=l + m).map(|k| 1.0 / k as f64).product();
    let both = if m == 0 { 1.0 } else { 2.0 };
    (both * (2 * l + 1) as f64 / (4.0 * PI) * ratio).sqrt()
}

/// A function of the angle to `axis` alone, `lobe[l]` being what it multiplies
/// harmonics of band l with ([`cosine_power`]): its coefficients.
pub fn about_axis(basis: &Basis, axis: DVec3, lobe: &[f64]) -> Vec<f64> {
    let mut out = basis.at(axis);
    scale_bands(&mut out, lobe);
    out
}

/// Multiplies each band by its factor: a convolution with a lobe.
pub fn scale_bands(coefficients: &mut [f64], lobe: &[f64]) {
    for (l, factor) in lobe.iter().enumerate() {
        let band = terms(l).min(coefficients.len())..terms(l + 1).min(coefficients.len());
        coefficients[band].iter_mut().for_each(|c| *c *= factor);
    }
}

/// `Σ a b`, in order.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
