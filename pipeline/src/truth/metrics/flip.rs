//! LDR-FLIP: how visible a difference is when two pictures alternate.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A
//! Difference Evaluator for Alternating Images", Proc. ACM Computer Graphics and
//! Interactive Techniques 3(2), 2020. Two pipelines meet at the end: colours,
//! filtered by the contrast sensitivity of the eye and compared by the HyAB
//! distance in Hunt-adjusted CIELAB (section 4.1), and features, edges and points
//! of the luminance (section 4.2). Constants are the paper's.

mod colour;

use super::error::{MetricError, same_size};
use super::filter::{Plane, balanced, kernel};
use super::picture::Picture;
use colour::{Rgb, lab_of_linear, linear_of_opponent, opponent_of_linear, srgb_decode};

/// Pixels per degree of visual angle: 0.7 m from a display 0.7 m wide with 3840
/// pixels across, the paper's default.
pub const DEFAULT_PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_25;

/// Exponent of the colour difference (q_c), and the end points p_c, p_t of its
/// remapping.
const COLOUR_EXPONENT: f64 = 0.7;
const COLOUR_KNEE: f64 = 0.4;
const COLOUR_TOP: f64 = 0.95;

/// Exponent of the feature difference (q_f), and the width of the feature
/// detector in degrees (w).
const FEATURE_EXPONENT: f64 = 0.5;
const FEATURE_WIDTH: f64 = 0.082;

/// Contrast sensitivity of an opponent channel: a sum of Gaussians with weight a
/// and extent b (table 1).
const SENSITIVITY: [&[[f64; 2]]; 3] = [
    &[[1.0, 0.0047]],
    &[[1.0, 0.0053]],
    &[[34.1, 0.04], [13.5, 0.025]],
];
/// The largest extent, which sets the reach of all of them.
const LARGEST_EXTENT: f64 = 0.04;

/// Differences per pixel and their mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Difference per pixel, 0..=1, row 0 on top.
    pub values: Vec<f64>,
    /// Mean of all pixels; 0 without pixels.
    pub mean: f64,
}

/// Compares two sRGB pictures seen at `pixels_per_degree`.
///
/// # Errors
/// The pictures differ in size, or `pixels_per_degree` is not in 1..=1000.
pub fn flip(
    reference: Picture<'_>,
    test: Picture<'_>,
    pixels_per_degree: f64,
) -> Result<Flip, MetricError> {
    let size = same_size(reference.size(), test.size())?;
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(MetricError::Parameter {
            name: "pixels_per_degree",
            value: pixels_per_degree,
            rule: "1 to 1000",
        });
    }
    if size.contains(&0) {
        let (values, mean) = (Vec::new(), 0.0);
        return Ok(Flip { size, values, mean });
    }
    let [a, b] = [reference, test].map(|p| Seen::new(p, pixels_per_degree));
    let values: Vec<f64> = (0..a.lab.len()).map(|i| a.difference(&b, i)).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    Ok(Flip { size, values, mean })
}

/// What the eye makes of a picture.
struct Seen {
    /// Filtered colours, Hunt-adjusted CIELAB.
    lab: Vec<[f64; 3]>,
    /// Magnitudes of edges and points.
    features: [Vec<f64>; 2],
}

impl Seen {
    fn new(picture: Picture<'_>, pixels_per_degree: f64) -> Self {
        let decode: Vec<f64> = (0..=255)
            .map(|v| srgb_decode(f64::from(v) / 255.0))
            .collect();
        let linear = |p: [u8; 3]| p.map(|v| decode[usize::from(v)]);
        let opponent: Vec<Rgb> = picture
            .pixels()
            .map(|p| opponent_of_linear(linear(p)))
            .collect();
        let channel = |k: usize, f: &dyn Fn(f64) -> f64| {
            let values = opponent.iter().map(|c| f(c[k])).collect();
            Plane::new(picture.size(), values)
        };
        // Luminance is 116 Y/Yn - 16.
        let grey = channel(0, &|y| (y + 16.0) / 116.0);
        let filtered =
            [0, 1, 2].map(|k| sensed(&channel(k, &|v| v), SENSITIVITY[k], pixels_per_degree));
        let lab = |i: usize| {
            let rgb = linear_of_opponent([0, 1, 2].map(|k: usize| filtered[k][i]));
            hunt_adjusted(lab_of_linear(rgb.map(|v| v.clamp(0.0, 1.0))))
        };
        Self {
            lab: (0..opponent.len()).map(lab).collect(),
            features: features(&grey, pixels_per_degree),
        }
    }

    /// The final difference of pixel `i` (equation 15).
    fn difference(&self, other: &Self, i: usize) -> f64 {
        let colour = colour_difference(self.lab[i], other.lab[i]);
        let change = |k: usize| (self.features[k][i] - other.features[k][i]).abs();
        let feature = change(0).max(change(1)) * std::f64::consts::FRAC_1_SQRT_2;
        libm::pow(colour, 1.0 - libm::pow(feature, FEATURE_EXPONENT))
    }
}

/// A channel filtered by its contrast sensitivity, as a sum of separable
/// Gaussians whose weights together sum to 1.
fn sensed(plane: &Plane, terms: &[[f64; 2]], pixels_per_degree: f64) -> Vec<f64> {
    use std::f64::consts::PI;
    let reach = 3.0 * (LARGEST_EXTENT / (2.0 * PI * PI)).sqrt() * pixels_per_degree;
    let gaussian = |b: f64| {
        kernel(reach.ceil() as usize, |x| {
            let degrees = x / pixels_per_degree;
            libm::exp(-PI * PI * degrees * degrees / b)
        })
    };
    let mut total = 0.0;
    let mut sum = vec![0.0; plane.values.len()];
    for [a, b] in terms {
        let (kernel, weight) = (gaussian(*b), a * (PI / b).sqrt());
        let side: f64 = kernel.iter().sum();
        total += weight * side * side;
        let part = plane.filtered(&kernel, &kernel);
        sum.iter_mut()
            .zip(part.values)
            .for_each(|(s, p)| *s += weight * p);
    }
    sum.iter_mut().for_each(|s| *s /= total);
    sum
}

/// Magnitudes of the gradient and of the second derivatives along the axes.
fn features(grey: &Plane, pixels_per_degree: f64) -> [Vec<f64>; 2] {
    let sigma = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let reach = (3.0 * sigma).ceil() as usize;
    let gaussian = |x: f64| libm::exp(-x * x / (2.0 * sigma * sigma));
    let smooth = balanced(kernel(reach, gaussian));
    let edge = balanced(kernel(reach, |x| -x * gaussian(x)));
    let point = balanced(kernel(reach, |x| {
        (x * x / (sigma * sigma) - 1.0) * gaussian(x)
    }));
    [edge, point].map(|derivative| {
        let across = grey.filtered(&derivative, &smooth).values;
        let down = grey.filtered(&smooth, &derivative).values;
        let length = |(x, y): (f64, f64)| (x * x + y * y).sqrt();
        across.into_iter().zip(down).map(length).collect()
    })
}

/// Chroma scaled by lightness, as the eye does (Hunt effect).
fn hunt_adjusted([l, a, b]: [f64; 3]) -> [f64; 3] {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// Lightness difference plus chroma distance (HyAB).
fn hyab(p: [f64; 3], q: [f64; 3]) -> f64 {
    let [l, a, b] = [0, 1, 2].map(|k: usize| p[k] - q[k]);
    l.abs() + (a * a + b * b).sqrt()
}

/// The colour difference, raised to its exponent and remapped to 0..=1 so that
/// most of the range serves small differences (section 4.1.3).
fn colour_difference(p: [f64; 3], q: [f64; 3]) -> f64 {
    let corner = |rgb: Rgb| hunt_adjusted(lab_of_linear(rgb));
    let most = hyab(corner([0.0, 1.0, 0.0]), corner([0.0, 0.0, 1.0]));
    let most = libm::pow(most, COLOUR_EXPONENT);
    let difference = libm::pow(hyab(p, q), COLOUR_EXPONENT);
    let knee = COLOUR_KNEE * most;
    if difference < knee {
        COLOUR_TOP / knee * difference
    } else {
        COLOUR_TOP + (difference - knee) / (most - knee) * (1.0 - COLOUR_TOP)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::metrics::samples::{SIZE, pictures};

    fn of(a: &[u8], b: &[u8], pixels_per_degree: f64) -> Flip {
        let [a, b] = [a, b].map(|rgb| Picture::new(SIZE, rgb).unwrap());
        flip(a, b, pixels_per_degree).unwrap()
    }

    /// Pixels per degree, mean, and every 37th pixel of one pair of pictures.
    fn theirs(row: usize) -> (f64, f64, Vec<f64>) {
        let rows = include_str!("flip/authors.txt").lines();
        let line = rows.filter(|l| !l.starts_with('#')).nth(row).unwrap();
        let mut numbers = line.split(' ').map(|v| v.parse().unwrap());
        let mut next = || numbers.next().unwrap();
        (next(), next(), numbers.collect())
    }

    /// Against the authors' own program, which computes in f32.
    #[test]
    fn agrees_with_the_authors_program() {
        let [reference, noisy, replaced] = pictures();
        let dark: Vec<u8> = reference.iter().map(|v| v / 9).collect();
        for (i, other) in [&noisy, &replaced, &dark].into_iter().enumerate() {
            for (k, distance) in [DEFAULT_PIXELS_PER_DEGREE, 20.0].into_iter().enumerate() {
                let ours = of(&reference, other, distance);
                let (pixels_per_degree, mean, values) = theirs(2 * i + k);
                assert!((pixels_per_degree - distance).abs() < 1e-9);
                assert!((ours.mean - mean).abs() < 1e-5, "{} {mean}", ours.mean);
                assert_eq!(values.len(), ours.values.len().div_ceil(37));
                for (v, w) in ours.values.iter().step_by(37).zip(values) {
                    assert!((v - w).abs() < 2e-5, "{v} {w}");
                }
            }
        }
    }

    /// Far away the same noise is seen less; and equal pictures do not differ.
    #[test]
    fn distance_and_equality() {
        let [reference, noisy, _] = pictures();
        let mean = |ppd| of(&reference, &noisy, ppd).mean;
        assert!(mean(120.0) < mean(60.0) && mean(60.0) < mean(15.0));
        assert!(
            of(&reference, &reference, 67.0)
                .values
                .iter()
                .all(|v| *v == 0.0)
        );
    }

    #[test]
    fn the_scale_has_the_papers_ends() {
        let [black, white] = [vec![0; 3600], vec![255; 3600]];
        let most = of(&black, &white, 67.0).mean;
        assert!((0.9..=1.0).contains(&most), "{most}");
        let dpi = 0.7 * (3840.0 / 0.7) * std::f64::consts::PI / 180.0;
        assert!((DEFAULT_PIXELS_PER_DEGREE - dpi).abs() < 1e-12);
    }

    #[test]
    fn bad_parameters_are_named() {
        let rgb = [0; 3];
        let dot = Picture::new([1, 1], &rgb).unwrap();
        let error = flip(dot, dot, f64::NAN).unwrap_err().to_string();
        assert!(error.contains("pixels_per_degree is NaN"), "{error}");
        assert_eq!(flip(dot, dot, 67.0).unwrap().mean, 0.0);
        let empty = Picture::new([0, 4], &[]).unwrap();
        assert_eq!(flip(empty, empty, 67.0).unwrap().mean, 0.0);
    }
}
