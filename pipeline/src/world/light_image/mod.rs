//! Images on rectangle lights: each texel a small light of its own colour, black ones
//! none at all, so that an image gives a light its colours and its shape (paper III,
//! §3.3; docs/papers.md, paper III). A sequence of them is a video.

mod read;
mod sequence;

use thiserror::Error;

pub(crate) use read::linear;
pub use read::{LightImageError, MAX_LIGHT_IMAGE_BYTES, MAX_LIGHT_IMAGES};
pub use sequence::{LightMoment, LightSequence};

/// Texels along a side that an image may have.
pub const LIGHT_IMAGE_SIDES: [usize; 2] = [2, 32];

/// Why texels make no image.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TexelError {
    /// Not a square of a size that is taken.
    #[error(
        "is {width}x{height} texels; an image of a light is a square of {} to {} texels a side",
        LIGHT_IMAGE_SIDES[0], LIGHT_IMAGE_SIDES[1]
    )]
    Size {
        /// Texels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A texel that is no light.
    #[error("has {value} in texel ({column}, {row}); light is finite and not below 0")]
    Texel {
        /// From the left.
        column: usize,
        /// From the top.
        row: usize,
        /// The value met.
        value: f64,
    },
}

/// Texels of equal size on the square -1..1, x along the light's first edge and y along
/// its second.
#[derive(Clone, Debug, PartialEq)]
pub struct LightImage {
    side: usize,
    /// Linear red, green, blue of each texel, rows from y = -1.
    cells: Vec<[f64; 3]>,
}

impl LightImage {
    /// A picture, rows from the top, which is y = 1.
    ///
    /// # Errors
    /// It is no square of 2 to 32 texels a side, or has texels that are no light.
    pub fn of_picture(
        [width, height]: [usize; 2],
        texels: &[[f32; 3]],
    ) -> Result<Self, TexelError> {
        let [least, most] = LIGHT_IMAGE_SIDES;
        let fits = width == height && (least..=most).contains(&width);
        if !fits || texels.len() != width * height {
            return Err(TexelError::Size { width, height });
        }
        let is_light = |v: f32| v.is_finite() && v >= 0.0;
        for (k, value) in texels.iter().flatten().enumerate() {
            if !is_light(*value) {
                let (row, column) = (k / 3 / width, k / 3 % width);
                let value = f64::from(*value);
                return Err(TexelError::Texel { column, row, value });
            }
        }
        let rows = texels.chunks_exact(width).rev();
        Ok(Self {
            side: width,
            cells: rows.flatten().map(|t| t.map(f64::from)).collect(),
        })
    }

    /// Red on the first half along x, green and blue on the other.
    pub fn halves() -> Self {
        let [red, cyan] = [[2.0, 0.0, 0.0], [0.0, 2.0, 2.0]];
        Self {
            side: 2,
            cells: vec![red, cyan, red, cyan],
        }
    }

    /// Sixteen square lights in one: bright cells with dark ones between them.
    pub fn windows() -> Self {
        let side = 7;
        let lit = |k: usize| (k % side).is_multiple_of(2) && (k / side).is_multiple_of(2);
        let bright = [(side * side) as f64 / 16.0; 3];
        let cell = |k| if lit(k) { bright } else { [0.0; 3] };
        Self {
            side,
            cells: (0..side * side).map(cell).collect(),
        }
    }

    /// A frame of a fire: cells flicker, red more than green, blue hardly.
    pub fn fire(frame: u32) -> Self {
        let side = 4;
        let cells = (0..side * side).map(|k| {
            let heat = flicker(k as u32, frame);
            [0.2 + heat, 0.05 + heat * heat, 0.1 * heat * heat]
        });
        Self {
            side,
            cells: cells.collect(),
        }
    }

    /// Texels along a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Linear red, green, blue of each texel, rows from y = -1.
    pub fn cells(&self) -> &[[f64; 3]] {
        &self.cells
    }

    /// Mean of each colour: what the light's own colour is multiplied with.
    pub fn means(&self) -> [f64; 3] {
        let sum = |c: usize| self.cells.iter().map(|t| t[c]).sum::<f64>();
        [0, 1, 2].map(|c| sum(c) / self.cells.len() as f64)
    }

    /// Share of each colour that each texel gives; of a colour without light, and so
    /// without effect, all texels alike.
    pub fn shares(&self) -> Vec<[f64; 3]> {
        let (means, count) = (self.means(), self.cells.len() as f64);
        let share = |cell: &[f64; 3]| {
            [0, 1, 2].map(|c| match means[c] {
                0.0 => 1.0 / count,
                mean => cell[c] / mean / count,
            })
        };
        self.cells.iter().map(share).collect()
    }

    /// This image and another of the same side, `part` of it.
    #[must_use]
    pub fn blended(&self, other: &Self, part: f64) -> Self {
        let mix =
            |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|c| a[c] * (1.0 - part) + b[c] * part);
        Self {
            side: self.side,
            cells: self.cells.iter().zip(&other.cells).map(mix).collect(),
        }
    }
}

/// Noise of 0..1 in space and time, smooth in time.
fn flicker(cell: u32, frame: u32) -> f64 {
    let noise = |key: u32| {
        let mixed = (cell.wrapping_mul(0x9e37_79b9) ^ key.wrapping_mul(0x85eb_ca6b))
            .wrapping_mul(0xc2b2_ae35);
        f64::from(mixed >> 8) / f64::from(1u32 << 24)
    };
    let (whole, part) = (frame / 4, f64::from(frame % 4) / 4.0);
    noise(whole) * (1.0 - part) + noise(whole + 1) * part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_squares_of_light_with_the_top_row_at_the_far_end() {
        let texels: Vec<[f32; 3]> = (0..4).map(|k| [k as f32, 1.0, 0.0]).collect();
        let image = LightImage::of_picture([2, 2], &texels).unwrap();
        let reds: Vec<f64> = image.cells().iter().map(|c| c[0]).collect();
        assert_eq!((reds, image.side()), (vec![2.0, 3.0, 0.0, 1.0], 2));
        assert_eq!(image.means(), [1.5, 1.0, 0.0]);
        // Of each colour all of it, be there none.
        for c in 0..3 {
            let all: f64 = image.shares().iter().map(|s| s[c]).sum();
            assert!((all - 1.0).abs() < 1e-15);
        }
        for size in [[1, 1], [2, 3], [33, 33], [0, 0]] {
            let texels = vec![[1.0; 3]; size[0] * size[1]];
            let refused = LightImage::of_picture(size, &texels).unwrap_err();
            assert!(refused.to_string().contains("square of 2 to 32"));
        }
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            let mut texels = texels.clone();
            texels[3][1] = bad;
            let refused = LightImage::of_picture([2, 2], &texels).unwrap_err();
            assert!(refused.to_string().contains("texel (1, 1)"), "{refused}");
        }
    }

    #[test]
    fn built_in_images_shine_as_a_plain_light_does_but_for_the_fire() {
        assert_eq!(LightImage::halves().means(), [1.0; 3]);
        assert_eq!(LightImage::windows().means(), [1.0; 3]);
        let lit = |c: &&[f64; 3]| c[0] > 0.0;
        assert_eq!(LightImage::windows().cells().iter().filter(lit).count(), 16);
        let [r, g, b] = LightImage::fire(0).means();
        assert!(r > g && g > b && b > 0.0);
        assert_ne!(LightImage::fire(0), LightImage::fire(1));
    }

    #[test]
    fn blending_goes_from_one_image_to_the_other() {
        let (a, b) = (LightImage::fire(0), LightImage::fire(9));
        assert_eq!(
            (a.blended(&b, 0.0), a.blended(&b, 1.0)),
            (a.clone(), b.clone())
        );
        let half = a.blended(&b, 0.5);
        let expected = 0.5 * (a.cells()[3][1] + b.cells()[3][1]);
        assert!((half.cells()[3][1] - expected).abs() < 1e-15);
    }
}
