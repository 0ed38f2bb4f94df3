//! Errors of float visibility, split by the truth's light regions.

use super::error::{MetricError, filled, same_size};
use crate::truth::oracle::area::{LightRegion, VisibilityImage};

/// Errors `picture - truth` of a set of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSummary {
    /// Pixels in the set, at least 1.
    pub pixels: usize,
    /// Root mean square.
    pub rmse: f64,
    /// Largest magnitude.
    pub max: f64,
    /// 99th percentile of the magnitudes: the least that 99% do not exceed.
    pub p99: f64,
    /// Signed mean: above 0 where the picture is too bright.
    pub mean: f64,
}

impl ErrorSummary {
    /// Sums up `errors`; `None` if there are none.
    pub fn of(errors: &[f64]) -> Option<Self> {
        let count = errors.len() as f64;
        let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let max = *sizes.last()?;
        let rank = (sizes.len() * 99).div_ceil(100); // from 1
        Some(Self {
            pixels: sizes.len(),
            rmse: (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt(),
            max,
            p99: sizes[rank - 1],
            mean: errors.iter().sum::<f64>() / count,
        })
    }
}

/// Pixels that could not be compared, or should not have needed to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaskCounts {
    /// NaN in both: no surface, nothing to compare.
    pub background: usize,
    /// A surface in the truth, NaN in the picture: a hole.
    pub missing: usize,
    /// NaN in the truth, a number in the picture.
    pub surplus: usize,
    /// Compared pixels whose picture is infinite, or outside 0..=1 by more than
    /// 1e-6. Infinite ones are left out of every summary.
    pub out_of_range: usize,
}

/// How far a picture's visibility is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilityError {
    /// All pixels that could be compared; `None` if there are none.
    pub all: Option<ErrorSummary>,
    /// The same by region of the truth, as [`LightRegion::ALL`]; see
    /// [`VisibilityError::of_region`].
    regions: [Option<ErrorSummary>; 3],
    /// What was left out, counted.
    pub mask: MaskCounts,
}

impl VisibilityError {
    /// Compares `picture` (row 0 on top, NaN where no surface is seen) with
    /// `truth` pixel by pixel.
    ///
    /// # Errors
    /// The images differ in size.
    pub fn measure(
        truth: &VisibilityImage,
        size: [u32; 2],
        picture: &[f32],
    ) -> Result<Self, MetricError> {
        same_size(truth.size, size)?;
        filled(size, 1, picture.len())?;
        let mut mask = MaskCounts::default();
        let mut errors: [Vec<f64>; 3] = Default::default();
        let mut all = Vec::new();
        for (truth, value) in truth.values.iter().zip(picture) {
            let value = f64::from(*value);
            if let Some((region, error)) = mask.admit(*truth, value) {
                errors[region as usize].push(error);
                all.push(error);
            }
        }
        Ok(Self {
            all: ErrorSummary::of(&all),
            regions: [0, 1, 2].map(|k: usize| ErrorSummary::of(&errors[k])),
            mask,
        })
    }

    /// Errors where the truth is in `region`; `None` if there are no pixels.
    pub fn of_region(&self, region: LightRegion) -> Option<ErrorSummary> {
        self.regions[region as usize]
    }
}

impl MaskCounts {
    /// Counts a pixel; its region and error if it can be compared.
    fn admit(&mut self, truth: f64, value: f64) -> Option<(LightRegion, f64)> {
        let Some(region) = LightRegion::of(truth) else {
            let counter = if value.is_nan() {
                &mut self.background
            } else {
                &mut self.surplus
            };
            *counter += 1;
            return None;
        };
        if value.is_nan() {
            self.missing += 1;
            return None;
        }
        if !(-1e-6..=1.0 + 1e-6).contains(&value) {
            self.out_of_range += 1;
        }
        value.is_finite().then_some((region, value - truth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(values: Vec<f64>) -> VisibilityImage {
        VisibilityImage {
            size: [values.len() as u32, 1],
            values,
        }
    }

    #[test]
    fn errors_are_split_by_region_of_the_truth() {
        let nan = f64::NAN;
        let image = truth(vec![
            0.0,
            0.0,
            0.5,
            0.25,
            1.0,
            1.0 - 1e-12,
            nan,
            nan,
            0.7,
            1.0,
        ]);
        let hole = f32::NAN;
        let picture = [
            0.5,
            0.0,
            0.25,
            0.75,
            1.0,
            1.0,
            hole,
            0.3,
            hole,
            f32::INFINITY,
        ];
        let error = VisibilityError::measure(&image, [10, 1], &picture).unwrap();
        let of = |r| error.of_region(r).unwrap();
        let umbra = of(LightRegion::Umbra);
        assert_eq!((umbra.pixels, umbra.max, umbra.mean), (2, 0.5, 0.25));
        assert_eq!(umbra.rmse, 0.125f64.sqrt());
        let penumbra = of(LightRegion::Penumbra);
        assert_eq!(
            (penumbra.pixels, penumbra.max, penumbra.mean),
            (2, 0.5, 0.125)
        );
        assert!(of(LightRegion::Lit).max < 1e-9);
        assert_eq!(error.all.unwrap().pixels, 6);
        let expected = MaskCounts {
            background: 1,
            missing: 1,
            surplus: 1,
            out_of_range: 1,
        };
        assert_eq!(error.mask, expected);
    }

    #[test]
    fn percentiles_are_by_nearest_rank() {
        let ramp: Vec<f64> = (1..=200).map(|k| -f64::from(k)).collect();
        let summary = ErrorSummary::of(&ramp).unwrap();
        assert_eq!(
            (summary.p99, summary.max, summary.mean),
            (198.0, 200.0, -100.5)
        );
        assert_eq!(ErrorSummary::of(&[0.25]).unwrap().p99, 0.25);
        assert_eq!(ErrorSummary::of(&[]), None);
    }

    #[test]
    fn empty_regions_say_so_and_sizes_must_agree() {
        let image = truth(vec![1.0; 4]);
        let error = VisibilityError::measure(&image, [4, 1], &[1.0; 4]).unwrap();
        assert_eq!(error.of_region(LightRegion::Umbra), None);
        assert_eq!(error.all.unwrap().rmse, 0.0);
        assert!(VisibilityError::measure(&image, [2, 2], &[1.0; 4]).is_err());
        assert!(VisibilityError::measure(&image, [4, 1], &[1.0; 3]).is_err());
    }
}
