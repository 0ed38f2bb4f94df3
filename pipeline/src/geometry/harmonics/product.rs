//! Light as a matrix: what its product with another function has for coefficients.

use super::{Rotation, dot, terms};

/// `L_ij = ∫ L y_i y_j dω` (Tamura et al. 2006, equation 10), symmetric; rows one after
/// the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    size: usize,
    values: Vec<f64>,
}

impl Product {
    /// Of no light, with `bands` bands.
    pub fn dark(bands: usize) -> Self {
        let size = terms(bands);
        Self {
            size,
            values: vec![0.0; size * size],
        }
    }

    /// Adds `energy` (radiance times solid angle) from a direction at which the basis
    /// is `y`.
    pub fn add(&mut self, energy: f64, y: &[f64]) {
        for (row, a) in self.values.chunks_exact_mut(self.size).zip(y) {
            let scaled = energy * a;
            row.iter_mut().zip(y).for_each(|(v, b)| *v += scaled * b);
        }
    }

    /// Row of a coefficient.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.size..(i + 1) * self.size]
    }

    /// Coefficients of the light times the function with coefficients `c`.
    pub fn times(&self, c: &[f64]) -> Vec<f64> {
        let rows = self.values.chunks_exact(self.size);
        rows.map(|row| dot(row, c)).collect()
    }

    /// Of the light turned: `D L Dᵀ`.
    pub fn turned(&self, by: &Rotation) -> Self {
        let columns = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            let column = |k: usize| rows.iter().map(|row| row[k]).collect();
            (0..self.size).map(column).collect()
        };
        let rows = |of: Vec<Vec<f64>>| of.iter().map(|row| by.apply(row)).collect();
        let own = self.values.chunks_exact(self.size);
        let once: Vec<Vec<f64>> = rows(own.map(<[f64]>::to_vec).collect());
        let twice: Vec<Vec<f64>> = rows(columns(once));
        Self {
            size: self.size,
            values: columns(twice).concat(),
        }
    }
}
