//! Steps in penumbrae: how coarse the levels of a picture are.
//!
//! A step is a jump of the *error* between two neighbouring pixels that are
//! both in the penumbra of the truth. The truth's own slope cancels, so a smooth
//! picture has none, even where it is wrong; N samples leave steps of 1/N and
//! more. This makes the thesis's observation measurable that sampled soft
//! shadows show steps below some hundreds of samples (its chapter 1).

use super::error::{MetricError, filled, same_size};
use crate::truth::oracle::area::{LightRegion, VisibilityImage};

/// Steps of a picture within the truth's penumbrae.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Banding {
    /// Pairs of neighbours, horizontal and vertical, that were compared.
    pub pairs: usize,
    /// Mean step height; 0 without pairs.
    pub mean: f64,
    /// Step height that 99% of the pairs do not exceed.
    pub p99: f64,
    /// Largest step height.
    pub max: f64,
    /// Distinct values of the picture in the truth's penumbrae: at most N + 1
    /// for N samples.
    pub levels: usize,
}

impl Banding {
    /// Measures the steps of `picture` (row 0 on top) against `truth`. Pixels
    /// that are NaN or infinite in the picture are left out;
    /// [`super::visibility`] counts them. A pair whose truth jumps by more than
    /// `edge` is left out too: that is the edge of a surface or a hard contact,
    /// not a penumbra's slope. 1 keeps all.
    ///
    /// # Errors
    /// The images differ in size.
    pub fn measure(
        truth: &VisibilityImage,
        size: [u32; 2],
        picture: &[f32],
        edge: f64,
    ) -> Result<Self, MetricError> {
        same_size(truth.size, size)?;
        filled(size, 1, picture.len())?;
        let [width, height] = size.map(|s| s as usize);
        let penumbra = |i: usize| {
            let region = LightRegion::of(truth.values[i]);
            region == Some(LightRegion::Penumbra) && picture[i].is_finite()
        };
        let step = |a: usize, b: usize| {
            let rise = truth.values[b] - truth.values[a];
            let usable = penumbra(a) && penumbra(b) && rise.abs() <= edge;
            usable.then(|| (f64::from(picture[b]) - f64::from(picture[a]) - rise).abs())
        };
        let mut steps = Vec::new();
        let mut levels = Vec::new();
        for i in 0..width * height {
            steps.extend((i % width + 1 < width).then(|| step(i, i + 1)).flatten());
            steps.extend(
                (i / width + 1 < height)
                    .then(|| step(i, i + width))
                    .flatten(),
            );
            levels.extend(penumbra(i).then(|| (picture[i] + 0.0).to_bits()));
        }
        levels.sort_unstable();
        levels.dedup();
        let mut banding = Self {
            levels: levels.len(),
            ..Self::default()
        };
        if let Some(summary) = super::visibility::ErrorSummary::of(&steps) {
            banding.pairs = summary.pixels;
            (banding.mean, banding.p99, banding.max) = (summary.mean, summary.p99, summary.max);
        }
        Ok(banding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear penumbra from 0 to 1, 200 pixels wide, two rows.
    fn ramp() -> VisibilityImage {
        let row = (0..200).map(|x| f64::from(x) / 199.0);
        VisibilityImage {
            size: [200, 2],
            values: row.clone().chain(row).collect(),
        }
    }

    fn measure(picture: impl Fn(f64) -> f64) -> Banding {
        let truth = ramp();
        let values: Vec<f32> = truth.values.iter().map(|v| picture(*v) as f32).collect();
        Banding::measure(&truth, truth.size, &values, 1.0).unwrap()
    }

    #[test]
    fn samples_leave_steps_of_one_over_n() {
        for n in [4.0, 16.0, 32.0] {
            let found = measure(|v| (v * n).round() / n);
            let expected = 1.0 / n - 1.0 / 199.0;
            assert!((found.max - expected).abs() < 1e-6, "{n}: {found:?}");
            assert!(found.levels <= n as usize + 1 && found.levels >= n as usize - 1);
        }
    }

    #[test]
    fn smooth_errors_are_no_steps() {
        let found = measure(|v| 0.5 * v * v + 0.3);
        assert!(found.max < 0.006, "{found:?}");
        assert_eq!(found.pairs, 2 * 197 + 198);
        assert!(measure(|v| v).max < 1e-7);
    }

    #[test]
    fn edges_of_the_truth_and_holes_are_left_out() {
        let truth = VisibilityImage {
            size: [4, 1],
            values: vec![0.2, 0.3, 0.9, 0.8],
        };
        let picture = [0.2, 0.4, 0.4, f32::NAN];
        let of = |edge| Banding::measure(&truth, [4, 1], &picture, edge).unwrap();
        assert_eq!((of(1.0).pairs, of(0.2).pairs), (2, 1));
        assert!((of(0.2).max - 0.1).abs() < 1e-6 && (of(1.0).max - 0.6).abs() < 1e-6);
    }

    #[test]
    fn without_penumbra_there_are_no_steps() {
        let truth = VisibilityImage {
            size: [2, 1],
            values: vec![1.0, f64::NAN],
        };
        let found = Banding::measure(&truth, [2, 1], &[1.0, 1.0], 1.0).unwrap();
        assert_eq!(found, Banding::default());
    }
}
