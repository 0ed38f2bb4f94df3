//! Where the luminance is that a light took: its first and second moments.

use glam::DVec3;

use super::cube::{axes, direction};

/// Where the luminance of some texels of a face is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Place on the face, -1..1 right and down, of the mean direction.
    pub centroid: [f64; 2],
    /// Half sides of the rectangle about it over which even light would be spread as
    /// much; a square's are equal.
    pub half: [f64; 2],
}

/// Sums over texels, weighted by luminance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    side: usize,
    weight: f64,
    towards: DVec3,
    place: [f64; 2],
    squares: [f64; 2],
}

impl Found {
    /// Of none of a face of `side` texels a side.
    pub(super) fn new(side: usize) -> Self {
        Self {
            side,
            weight: 0.0,
            towards: DVec3::ZERO,
            place: [0.0; 2],
            squares: [0.0; 2],
        }
    }

    /// Adds a texel.
    pub(super) fn add(&mut self, face: usize, texel: [usize; 2], luminance: u64) {
        let weight = luminance as f64;
        let at = texel.map(|k| (2.0 * k as f64 + 1.0) / self.side as f64 - 1.0);
        self.weight += weight;
        self.towards += direction(face, at).normalize() * weight;
        for k in 0..2 {
            self.place[k] += at[k] * weight;
            self.squares[k] += at[k] * at[k] * weight;
        }
    }

    /// `square`: as wide as high. `None` without any luminance.
    pub(super) fn moments(&self, face: usize, square: bool) -> Option<Moments> {
        if self.weight <= 0.0 {
            return None;
        }
        let [forward, right, down] = axes(face);
        let ahead = self.towards.dot(forward);
        // Even light over 2h has the variance h²/3; texels are spread themselves.
        let texel = 1.0 / (self.side * self.side) as f64;
        let squared = [0, 1].map(|k| {
            let mean = self.place[k] / self.weight;
            3.0 * (self.squares[k] / self.weight - mean * mean).max(0.0) + texel
        });
        let squared = match square {
            false => squared,
            true => [0.5 * (squared[0] + squared[1]); 2],
        };
        Some(Moments {
            centroid: [right, down].map(|axis| self.towards.dot(axis) / ahead),
            half: squared.map(f64::sqrt),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even light over texels is as wide as they are, about their middle.
    #[test]
    fn even_light_is_as_wide_as_its_texels() {
        let mut found = Found::new(16);
        assert_eq!(found.moments(2, false), None);
        for (y, x) in (6..10).flat_map(|y| (4..12).map(move |x| (y, x))) {
            found.add(2, [x, y], 7);
        }
        let Moments { centroid, half } = found.moments(2, false).unwrap();
        assert!(centroid.iter().all(|c| c.abs() < 1e-12), "{centroid:?}");
        assert!(
            (half[0] - 0.5).abs() < 1e-12 && (half[1] - 0.25).abs() < 1e-12,
            "{half:?}"
        );
        let square = found.moments(2, true).unwrap();
        let mean = (0.5 * (0.25 + 0.0625f64)).sqrt();
        assert!((square.half[0] - mean).abs() < 1e-12 && square.half[0] == square.half[1]);
    }

    /// One bright texel among dark ones is where the light is.
    #[test]
    fn a_bright_texel_draws_the_centroid_to_it() {
        let mut found = Found::new(8);
        for (y, x) in (0..8).flat_map(|y| (0..8).map(move |x| (y, x))) {
            found.add(4, [x, y], if [x, y] == [6, 1] { 1_000_000 } else { 1 });
        }
        let Moments { centroid, half } = found.moments(4, true).unwrap();
        assert!((centroid[0] - 0.625).abs() < 1e-3 && (centroid[1] + 0.625).abs() < 1e-3);
        assert!(half[0] < 0.14, "{half:?}");
    }
}
