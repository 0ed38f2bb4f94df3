//! Structural similarity.
//!
//! Wang, Bovik, Sheikh, Simoncelli: "Image Quality Assessment: From Error
//! Visibility to Structural Similarity", IEEE Transactions on Image Processing
//! 13(4), 2004: an 11x11 Gaussian window with sigma 1.5 at every position inside
//! the image, K1 = 0.01, K2 = 0.03, L = 255 (section III.B and III.C).

use super::error::{MetricError, same_size};
use super::filter::{Plane, balanced, kernel};
use super::picture::Picture;

/// Pixels that the window reaches from its centre.
const REACH: usize = 5;
const SIGMA: f64 = 1.5;
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// Moments of two images' values in one window.
#[derive(Clone, Copy, Debug)]
struct Moments {
    means: [f64; 2],
    /// Means of the squares.
    squares: [f64; 2],
    /// Mean of the product.
    product: f64,
}

impl Moments {
    /// The index of one window: equation (13) of the paper.
    fn similarity(&self) -> f64 {
        let [x, y] = self.means;
        let variances = self.squares[0] - x * x + (self.squares[1] - y * y);
        let covariance = self.product - x * y;
        (2.0 * x * y + C1) * (2.0 * covariance + C2) / ((x * x + y * y + C1) * (variances + C2))
    }
}

/// Mean structural similarity of the luma (BT.601, not rounded) of two sRGB
/// pictures: 1 for equal ones, less otherwise, possibly below 0.
///
/// # Errors
/// The pictures differ in size, or are smaller than the 11x11 window.
pub fn ssim(reference: Picture<'_>, test: Picture<'_>) -> Result<f64, MetricError> {
    let size = same_size(reference.size(), test.size())?;
    let least = 2 * REACH as u32 + 1;
    if size[0] < least || size[1] < least {
        return Err(MetricError::TooSmall { size, least });
    }
    let [x, y] = [luma(reference), luma(test)];
    let window = balanced(kernel(REACH, |d| libm::exp(-d * d / (2.0 * SIGMA * SIGMA))));
    let product = |a: &[f64], b: &[f64]| {
        let values = a.iter().zip(b).map(|(a, b)| a * b).collect();
        Plane::new(size, values).filtered_inside(&window).values
    };
    let mean = |values: &[f64]| {
        Plane::new(size, values.to_vec())
            .filtered_inside(&window)
            .values
    };
    let means = [mean(&x), mean(&y)];
    let (squares, products) = ([product(&x, &x), product(&y, &y)], product(&x, &y));
    let similarity = |i: usize| {
        let moments = Moments {
            means: [0, 1].map(|k: usize| means[k][i]),
            squares: [0, 1].map(|k: usize| squares[k][i]),
            product: products[i],
        };
        moments.similarity()
    };
    let count = products.len();
    Ok((0..count).map(similarity).sum::<f64>() / count as f64)
}

/// Luma of each pixel, 0..=255.
fn luma(picture: Picture<'_>) -> Vec<f64> {
    let of = |p: [u8; 3]| {
        let [r, g, b] = p.map(f64::from);
        0.299 * r + 0.587 * g + 0.114 * b
    };
    picture.pixels().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::metrics::samples::{SIZE, pictures};

    fn of(a: &[u8], b: &[u8]) -> f64 {
        let [a, b] = [a, b].map(|rgb| Picture::new(SIZE, rgb).unwrap());
        ssim(a, b).unwrap()
    }

    /// Values of scikit-image 0.26 with `gaussian_weights=True, sigma=1.5,
    /// use_sample_covariance=False, data_range=255` on the same luma.
    #[test]
    fn agrees_with_scikit_image() {
        let [reference, noisy, replaced] = pictures();
        assert_eq!(of(&reference, &reference), 1.0);
        assert!((of(&reference, &noisy) - 0.992_222_949_554_365_3).abs() < 1e-12);
        assert!((of(&reference, &replaced) + 0.030_518_967_297_586_08).abs() < 1e-12);
    }

    /// The index itself against image-compare's, which is over separate 8x8
    /// windows and takes sums for variances: 64 times ours.
    #[test]
    fn the_index_agrees_with_image_compare() {
        let [reference, noisy, replaced] = pictures();
        let grey = |rgb: &[u8]| rgb.iter().step_by(3).copied().collect::<Vec<u8>>();
        let size = [SIZE[0], 24]; // whole windows
        for other in [noisy, replaced.iter().rev().copied().collect()] {
            let [a, b] = [&reference, &other].map(|p| grey(p)[..960].to_vec());
            let image =
                |g: &[u8]| image::GrayImage::from_raw(size[0], size[1], g.to_vec()).unwrap();
            let algorithm = image_compare::Algorithm::MSSIMSimple;
            let theirs =
                image_compare::gray_similarity_structure(&algorithm, &image(&a), &image(&b));
            let mut sum = 0.0;
            for (bx, by) in (0..3).flat_map(|by| (0..5).map(move |bx| (bx, by))) {
                let index = |k: usize| (by * 8 + k / 8) * 40 + bx * 8 + k % 8;
                let mean =
                    |f: &dyn Fn(usize) -> f64| (0..64).map(|k| f(index(k))).sum::<f64>() / 64.0;
                let [x, y] = [&a, &b].map(|g| mean(&|i| f64::from(g[i])));
                let co = |p: &[u8], q: &[u8], m: f64| {
                    let covariance = mean(&|i| f64::from(p[i]) * f64::from(q[i])) - m;
                    64.0 * covariance + m
                };
                let moments = Moments {
                    means: [x, y],
                    squares: [co(&a, &a, x * x), co(&b, &b, y * y)],
                    product: co(&a, &b, x * y),
                };
                sum += moments.similarity();
            }
            let (ours, theirs) = (sum / 15.0, theirs.unwrap().score);
            assert!((ours - theirs).abs() < 1e-9, "{ours} {theirs}");
        }
    }

    #[test]
    fn small_pictures_are_refused() {
        let rgb = [0; 10 * 12 * 3];
        let small = Picture::new([10, 12], &rgb).unwrap();
        let error = ssim(small, small).unwrap_err().to_string();
        assert!(
            error.contains("10x12") && error.contains("11x11"),
            "{error}"
        );
    }
}
