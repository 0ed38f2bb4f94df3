//! All measures of one technique's picture.

use super::Aligned;
use super::pixels::{LeftOut, PixelCounts};
use crate::measure::render::Rendered;
use crate::truth::metrics::banding::Banding;
use crate::truth::metrics::flip::{DEFAULT_PIXELS_PER_DEGREE, flip};
use crate::truth::metrics::psnr::psnr;
use crate::truth::metrics::ssim::ssim;
use crate::truth::metrics::visibility::VisibilityError;
use crate::truth::metrics::{MetricError, Picture, rgb_of};

/// Jump of the truth between neighbouring pixels above which [`Banding`] takes
/// it for an edge and not for a penumbra's slope.
pub const BANDING_EDGE: f64 = 0.25;

/// How far a technique's picture is from the truth (docs/papers.md, metrics and references).
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Errors of visibility, by region of the truth.
    pub visibility: VisibilityError,
    /// Steps within penumbrae.
    pub banding: Banding,
    /// Of the shaded sRGB pictures, decibels; infinite for equal ones.
    pub psnr: f64,
    /// Of their luma; `None` for pictures smaller than its window.
    pub ssim: Option<f64>,
    /// Mean LDR-FLIP at [`DEFAULT_PIXELS_PER_DEGREE`].
    pub flip: f64,
    /// How many pixels errors of visibility are of, and why others were left out.
    pub pixels: PixelCounts,
}

impl Score {
    /// Compares `done` with the truth `under` its depth buffer, and its picture
    /// with `shaded`, the sRGB picture that the truth gives under the same
    /// shading.
    ///
    /// # Errors
    /// The images differ in size.
    pub fn measure(
        under: &Aligned,
        done: &Rendered,
        shaded: &[[u8; 4]],
    ) -> Result<Self, MetricError> {
        let (size, truth) = (done.size, &under.truth);
        // Left out on both sides where the truth has nothing to say.
        let pairs = done.visibility.iter().zip(&truth.values);
        let seen: Vec<f32> = pairs
            .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
            .collect();
        let [reference, test] = [rgb_of(shaded), rgb_of(&done.srgb)];
        let (reference, test) = (Picture::new(size, &reference)?, Picture::new(size, &test)?);
        let visibility = VisibilityError::measure(truth, size, &seen)?;
        Ok(Self {
            pixels: count_pixels(under, &visibility),
            visibility,
            banding: Banding::measure(truth, size, &seen, BANDING_EDGE)?,
            psnr: psnr(reference, test)?,
            ssim: match ssim(reference, test) {
                Ok(value) => Some(value),
                Err(MetricError::TooSmall { .. }) => None,
                Err(other) => return Err(other),
            },
            flip: flip(reference, test, DEFAULT_PIXELS_PER_DEGREE)?.mean,
        })
    }
}

/// What the truth has a number for and the picture does not is without value.
fn count_pixels(under: &Aligned, visibility: &VisibilityError) -> PixelCounts {
    let compared = visibility.all.map_or(0, |e| e.pixels);
    let known = under.truth.values.iter().filter(|v| !v.is_nan()).count();
    PixelCounts {
        compared,
        left_out: LeftOut {
            no_value: under.left_out.no_value + known - compared,
            ..under.left_out
        },
    }
}
