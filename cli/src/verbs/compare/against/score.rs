//! How far somebody else's image is from the truth, where, and on which side.

use gnomon_pipeline::measure::comparison::{Aligned, LeftOut, PixelCounts};
use gnomon_pipeline::truth::metrics::psnr::psnr;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::truth::metrics::{MetricError, Picture, rgb_of};
use gnomon_pipeline::truth::oracle::area::LightRegion;

/// Least error that is told as one: a step of 8 bits, of which rounding may take a little.
pub(super) const STEP: f64 = (1.0 - 1e-4) / 255.0;

/// Pixels that are named.
const NAMED: usize = 8;

/// One pixel's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Worst {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) theirs: f64,
    pub(super) truth: f64,
}

/// What was found.
pub(super) struct Found {
    /// Truth, and the file beside it, 0..=1; NaN where nothing is compared. Of a picture
    /// the channel that differs most.
    pub(super) values: Vec<[f64; 2]>,
    pub(super) all: Option<ErrorSummary>,
    /// Umbra, penumbra, lit; of visibility only.
    pub(super) regions: [Option<ErrorSummary>; 3],
    /// Pixels that are darker, and brighter, than the truth by a step of 8 bits.
    pub(super) dark: usize,
    pub(super) bright: usize,
    pub(super) worst: Vec<Worst>,
    pub(super) pixels: PixelCounts,
    /// Of pictures.
    pub(super) psnr: Option<f64>,
}

impl Found {
    pub(super) fn of_visibility(under: &Aligned, theirs: &[f32]) -> Result<Self, MetricError> {
        let size = under.truth.size;
        let seen = |(t, v): (&f64, &f32)| if t.is_nan() { f32::NAN } else { *v };
        let seen: Vec<f32> = under.truth.values.iter().zip(theirs).map(seen).collect();
        let error = VisibilityError::measure(&under.truth, size, &seen)?;
        let pair = |(t, v): (&f64, &f32)| match v.is_finite() {
            true => [*t, f64::from(*v)],
            false => [*t, f64::NAN],
        };
        let values = under.truth.values.iter().zip(&seen).map(pair).collect();
        let mut found = Self::new(under, values);
        found.all = error.all;
        found.regions = LightRegion::ALL.map(|r| error.of_region(r));
        Ok(found)
    }

    pub(super) fn of_picture(
        under: &Aligned,
        truth: &[[u8; 4]],
        theirs: &[[u8; 3]],
    ) -> Result<Self, MetricError> {
        let size = under.truth.size;
        let compared = under.truth.values.iter().zip(truth.iter().zip(theirs));
        let pair = |(known, (t, v)): (&f64, (&[u8; 4], &[u8; 3]))| {
            if known.is_nan() {
                return [f64::NAN; 2];
            }
            let channel = (0..3).fold(0, |most, c| {
                let off = |c: usize| t[c].abs_diff(v[c]);
                if off(c) > off(most) { c } else { most }
            });
            [t[channel], v[channel]].map(|v| f64::from(v) / 255.0)
        };
        let mut found = Self::new(under, compared.map(pair).collect());
        let (a, b) = (rgb_of(truth), theirs.as_flattened());
        found.psnr = Some(psnr(Picture::new(size, &a)?, Picture::new(size, b)?)?);
        Ok(found)
    }

    fn new(under: &Aligned, values: Vec<[f64; 2]>) -> Self {
        let errors: Vec<f64> = values.iter().map(|[t, v]| v - t).collect();
        let known: Vec<f64> = errors.iter().copied().filter(|e| !e.is_nan()).collect();
        let beyond = |sign: f64| known.iter().filter(|e| **e * sign >= STEP).count();
        let without = under.truth.values.iter().filter(|v| !v.is_nan()).count() - known.len();
        Self {
            all: ErrorSummary::of(&known),
            regions: [None; 3],
            dark: beyond(-1.0),
            bright: beyond(1.0),
            worst: worst(under.truth.size[0], &values),
            pixels: PixelCounts {
                compared: known.len(),
                left_out: LeftOut {
                    no_value: under.left_out.no_value + without,
                    ..under.left_out
                },
            },
            psnr: None,
            values,
        }
    }
}

/// The pixels with the largest errors, the first of equal ones first.
fn worst(width: u32, values: &[[f64; 2]]) -> Vec<Worst> {
    let off = |k: &usize| (values[*k][1] - values[*k][0]).abs();
    let mut order: Vec<usize> = (0..values.len()).filter(|k| off(k) >= STEP).collect();
    order.sort_by(|a, b| off(b).total_cmp(&off(a)).then(a.cmp(b)));
    let named = order.into_iter().take(NAMED);
    named
        .map(|k| Worst {
            x: k as u32 % width,
            y: k as u32 / width,
            theirs: values[k][1],
            truth: values[k][0],
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As shares of 255 in f64, and as files of f32 have them.
    #[test]
    fn each_step_of_eight_bits_is_an_error() {
        for step in 1..=255_u8 {
            let [low, high] = [step - 1, step].map(|v| f64::from(v) / 255.0);
            let [coarse, fine] = [step - 1, step].map(|v| f64::from(f32::from(v) / 255.0));
            for pair in [[low, high], [high, low], [low, fine], [high, coarse]] {
                assert_eq!(worst(1, &[pair]).len(), 1, "{pair:?}");
            }
            assert!(worst(1, &[[low, low + 0.9 / 255.0]]).is_empty());
        }
    }

    #[test]
    fn the_worst_pixels_come_first_and_have_their_places() {
        let values = [
            [0.5, 0.5],
            [1.0, 0.25],
            [0.0, 1.0],
            [f64::NAN; 2],
            [0.0, 0.75],
            [0.5, 0.501],
        ];
        let found = worst(3, &values);
        let places: Vec<_> = found.iter().map(|w| (w.x, w.y, w.theirs)).collect();
        assert_eq!(places, [(2, 0, 1.0), (1, 0, 0.25), (1, 1, 0.75)]);
    }
}
