//! Separable convolution of one channel.

use rayon::prelude::*;

/// One channel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) size: [usize; 2],
    pub(super) values: Vec<f64>,
}

impl Plane {
    pub(super) fn new([width, height]: [u32; 2], values: Vec<f64>) -> Self {
        Self {
            size: [width as usize, height as usize],
            values,
        }
    }

    /// Convolves rows with `across` and columns with `down`, both of odd
    /// length; beyond the border the outermost pixels are repeated.
    pub(super) fn filtered(&self, across: &[f64], down: &[f64]) -> Self {
        self.rows_filtered(across)
            .transposed()
            .rows_filtered(down)
            .transposed()
    }

    /// `filtered` without the pixels whose window leaves the image.
    pub(super) fn filtered_inside(&self, kernel: &[f64]) -> Self {
        let whole = self.filtered(kernel, kernel);
        let margin = kernel.len() / 2;
        let [width, height] = self.size.map(|s| s - 2 * margin);
        let row = |y: usize| {
            let start = (y + margin) * self.size[0] + margin;
            &whole.values[start..start + width]
        };
        Self {
            size: [width, height],
            values: (0..height).flat_map(row).copied().collect(),
        }
    }

    fn rows_filtered(&self, kernel: &[f64]) -> Self {
        let [width, reach] = [self.size[0], kernel.len() / 2];
        let filter_row = |row: &[f64]| {
            let mut padded = vec![row[0]; reach];
            padded.extend_from_slice(row);
            padded.extend(vec![row[width - 1]; reach]);
            let windows = padded.windows(kernel.len());
            // Flipped, as a convolution is.
            let sum = |w: &[f64]| w.iter().zip(kernel.iter().rev()).map(|(v, k)| v * k).sum();
            windows.map(sum).collect::<Vec<f64>>()
        };
        let rows: Vec<Vec<f64>> = self
            .values
            .par_chunks(width.max(1))
            .map(filter_row)
            .collect();
        Self {
            size: self.size,
            values: rows.concat(),
        }
    }

    fn transposed(&self) -> Self {
        let [width, height] = self.size;
        let column = |x: usize| (0..height).map(move |y| self.values[y * width + x]);
        Self {
            size: [height, width],
            values: (0..width).flat_map(column).collect(),
        }
    }
}

/// Samples `f` at whole numbers from `-reach` to `reach`.
pub(super) fn kernel(reach: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * reach)
        .map(|k| f(k as f64 - reach as f64))
        .collect()
}

/// Scales positive weights to sum to 1 and negative ones to -1.
pub(super) fn balanced(mut kernel: Vec<f64>) -> Vec<f64> {
    let above: f64 = kernel.iter().filter(|k| **k > 0.0).sum();
    let below: f64 = kernel.iter().filter(|k| **k < 0.0).sum();
    for weight in &mut kernel {
        if *weight != 0.0 {
            *weight /= if *weight > 0.0 { above } else { -below };
        }
    }
    kernel
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the definition, with an uneven kernel and a non-square image.
    #[test]
    fn filtering_is_convolution_with_repeated_borders() {
        let size = [7u32, 5];
        let values: Vec<f64> = (0..35).map(|k| f64::from(k * k % 11)).collect();
        let plane = Plane::new(size, values.clone());
        let (across, down) = ([0.5, -1.0, 2.0], [1.0, 3.0, -2.0, 0.25, 7.0]);
        let at = |x: i32, y: i32| values[(y.clamp(0, 4) * 7 + x.clamp(0, 6)) as usize];
        let found = plane.filtered(&across, &down);
        for (x, y) in (0..7).flat_map(|x| (0..5).map(move |y| (x, y))) {
            let mut expected = 0.0;
            for (i, a) in across.iter().enumerate() {
                for (k, d) in down.iter().enumerate() {
                    expected += a * d * at(x + 1 - i as i32, y + 2 - k as i32);
                }
            }
            let value = found.values[(y * 7 + x) as usize];
            assert!((value - expected).abs() < 1e-10, "({x},{y})");
        }
        let inside = plane.filtered_inside(&across);
        assert_eq!((inside.size, inside.values.len()), ([5, 3], 15));
        assert_eq!(inside.values[0], plane.filtered(&across, &across).values[8]);
    }

    #[test]
    fn weights_are_balanced() {
        assert_eq!(
            balanced(vec![1.0, 3.0, 0.0, -4.0, -12.0]),
            [0.25, 0.75, 0.0, -0.25, -0.75]
        );
        assert_eq!(kernel(1, |x| x + 1.0), [0.0, 1.0, 2.0]);
    }
}
