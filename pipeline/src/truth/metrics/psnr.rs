//! Peak signal-to-noise ratio.

use super::error::{MetricError, same_size};
use super::picture::Picture;

/// Peak signal-to-noise ratio in dB over all channels of two sRGB pictures,
/// `10 log10(255^2 / MSE)`; infinite for equal (and for empty) ones.
///
/// # Errors
/// The pictures differ in size.
pub fn psnr(reference: Picture<'_>, test: Picture<'_>) -> Result<f64, MetricError> {
    same_size(reference.size(), test.size())?;
    let pairs = reference.rgb().iter().zip(test.rgb());
    // Integers: exact, and 2^64 holds any number of pixels that fits memory.
    let squares: u64 = pairs
        .map(|(a, b)| u64::from(a.abs_diff(*b)) * u64::from(a.abs_diff(*b)))
        .sum();
    if squares == 0 {
        return Ok(f64::INFINITY);
    }
    let mean = squares as f64 / reference.rgb().len() as f64;
    Ok(10.0 * libm::log10(255.0 * 255.0 / mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_ratios() {
        let (a, b, c) = ([10; 12], [0; 12], [9; 12]);
        let of = |x: &[u8; 12], y: &[u8; 12]| {
            let picture = |rgb| Picture::new([2, 2], rgb).unwrap();
            psnr(picture(x), picture(y)).unwrap()
        };
        assert_eq!(of(&a, &a), f64::INFINITY);
        assert!((of(&a, &b) - 28.130_803_608_679_1).abs() < 1e-12);
        assert!((of(&a, &c) - 48.130_803_608_679_1).abs() < 1e-12);
    }

    #[test]
    fn sizes_must_agree() {
        let rgb = [0; 12];
        let [a, b] = [[2, 2], [4, 1]].map(|size| Picture::new(size, &rgb).unwrap());
        let error = psnr(a, b).unwrap_err().to_string();
        assert!(error.contains("2x2 and 4x1"), "{error}");
        let error = Picture::new([3, 2], &rgb).unwrap_err().to_string();
        assert!(
            error.contains("12 values") && error.contains("18"),
            "{error}"
        );
    }
}
