//! Rotation of coefficients, band by band (Ivanic and Ruedenberg, "Rotation Matrices for
//! Real Spherical Harmonics", J. Phys. Chem. 1996, with the additions of 1998).
//!
//! The matrix of band l follows from those of bands l - 1 and 1; that of band 1 is the
//! rotation itself with axes in the order y, z, x.

use glam::DMat3;

use super::{MOST_BANDS, terms};

/// A rotation of functions of direction: with `y(R d) = D y(d)`, a function with
/// coefficients c, turned by R, has coefficients D c.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotation {
    /// Rows and columns of each band from -l to l.
    bands: Vec<Band>,
}

/// One band's matrix.
#[derive(Clone, Debug, PartialEq)]
struct Band {
    l: isize,
    values: Vec<f64>,
}

impl Band {
    fn new(l: isize, value: impl Fn(isize, isize) -> f64) -> Self {
        let pairs = (-l..=l).flat_map(|m| (-l..=l).map(move |n| (m, n)));
        Self {
            l,
            values: pairs.map(|(m, n)| value(m, n)).collect(),
        }
    }

    fn at(&self, m: isize, n: isize) -> f64 {
        self.values[((m + self.l) * (2 * self.l + 1) + n + self.l) as usize]
    }
}

impl Rotation {
    /// Of `bands` bands by a matrix that turns without scaling.
    ///
    /// # Panics
    /// More than [`MOST_BANDS`] bands.
    pub fn new(turn: &DMat3, bands: usize) -> Self {
        assert!(bands <= MOST_BANDS, "{bands} bands");
        const AXES: [usize; 3] = [1, 2, 0]; // y, z, x
        let axis = |m: isize| AXES[(m + 1) as usize];
        let mut all = vec![Band::new(0, |_, _| 1.0)];
        all.push(Band::new(1, |m, n| turn.col(axis(n))[axis(m)]));
        for l in 2..bands as isize {
            let (first, before) = (&all[1], &all[l as usize - 1]);
            all.push(Band::new(l, |m, n| {
                let step = Step {
                    first,
                    before,
                    l,
                    n,
                };
                step.value(m)
            }));
        }
        all.truncate(bands);
        Self { bands: all }
    }

    /// Coefficients of the turned function; bands beyond the rotation's are left out.
    pub fn apply(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(coefficients.len());
        for band in &self.bands {
            let first = terms(band.l as usize);
            let own = coefficients.iter().skip(first);
            let width = (2 * band.l + 1) as usize;
            let own: Vec<f64> = own.take(width).copied().collect();
            let rows = band.values.chunks_exact(width);
            out.extend(rows.map(|row| super::dot(row, &own)).take(own.len()));
        }
        out
    }
}

/// One column n of the matrix of band l.
struct Step<'a> {
    first: &'a Band,
    before: &'a Band,
    l: isize,
    n: isize,
}

impl Step<'_> {
    fn value(&self, m: isize) -> f64 {
        let (l, n) = (self.l, self.n);
        let below = if n.abs() == l {
            2 * l * (2 * l - 1)
        } else {
            (l + n) * (l - n)
        };
        let share = |above: isize| (above as f64 / below as f64).sqrt();
        let (zero, size) = (m == 0, m.abs());
        let u = share((l + m) * (l - m));
        let twice = if zero { 2 } else { 1 };
        let v = 0.5 * share(twice * (l + size - 1) * (l + size)) * if zero { -1.0 } else { 1.0 };
        let w = if zero {
            0.0
        } else {
            -0.5 * share((l - size - 1) * (l - size))
        };
        // Where a factor is 0 its sum would look beyond the band before.
        let times =
            |factor: f64, sum: &dyn Fn() -> f64| if factor == 0.0 { 0.0 } else { factor * sum() };
        times(u, &|| self.p(0, m)) + times(v, &|| self.v(m)) + times(w, &|| self.w(m))
    }

    fn p(&self, i: isize, a: isize) -> f64 {
        let (l, n) = (self.l, self.n);
        let pair = |one: isize, other: isize| (self.first.at(i, one), self.before.at(a, other));
        let (near, far) = if n.abs() == l {
            let sign = n.signum();
            (pair(1, sign * (l - 1)), pair(-1, -sign * (l - 1)))
        } else {
            return self.first.at(i, 0) * self.before.at(a, n);
        };
        near.0 * near.1 - n.signum() as f64 * far.0 * far.1
    }

    fn v(&self, m: isize) -> f64 {
        let double = std::f64::consts::SQRT_2;
        match m {
            0 => self.p(1, 1) + self.p(-1, -1),
            1 => self.p(1, 0) * double,
            -1 => self.p(-1, 0) * double,
            m if m > 0 => self.p(1, m - 1) - self.p(-1, 1 - m),
            m => self.p(1, m + 1) + self.p(-1, -m - 1),
        }
    }

    fn w(&self, m: isize) -> f64 {
        if m > 0 {
            self.p(1, m + 1) + self.p(-1, -m - 1)
        } else {
            self.p(1, m - 1) - self.p(-1, 1 - m)
        }
    }
}
