//! Look-ups in f64, for the truth: the texture rules without their rounding.

use gnomon_raster::state::{AddressMode, FilterMode};

use super::SurfaceTexture;
use super::mips::Level;

impl SurfaceTexture {
    /// The base colour at `at`, whose changes to the next pixel in x and y are `gradients`.
    pub(crate) fn sample(&self, at: [f64; 2], gradients: [[f64; 2]; 2]) -> [f64; 3] {
        let sampler = &self.sampler;
        let size = self.picture.size().map(f64::from);
        let squared = |d: [f64; 2]| {
            let [u, v] = [0, 1].map(|k| d[k] * size[k]);
            u * u + v * v
        };
        let largest = squared(gradients[0]).max(squared(gradients[1]));
        let lod = 0.5 * libm::log2(largest.max(f64::MIN_POSITIVE)) + f64::from(sampler.lod_bias);
        let lod = lod.clamp(f64::from(sampler.lod[0]), f64::from(sampler.lod[1]));
        let filter = if lod <= 0.0 { sampler.mag } else { sampler.min };
        let levels = self.picture.levels();
        let last = (levels.len() - 1) as f64;
        let of = |level: f64| self.of_level(&levels[level as usize], at, filter);
        if sampler.mip == FilterMode::Nearest {
            return of((lod + 0.5).floor().clamp(0.0, last));
        }
        let lod = lod.clamp(0.0, last);
        let (below, above) = (lod.floor(), lod.ceil());
        let (a, b) = (of(below), of(above));
        [0, 1, 2].map(|c| a[c] + (lod - below) * (b[c] - a[c]))
    }

    fn of_level(&self, level: &Level, at: [f64; 2], filter: FilterMode) -> [f64; 3] {
        let place = |axis: usize| {
            let n = f64::from(level.size[axis]);
            wrapped(self.sampler.address[axis], at[axis]) * n
        };
        let index = |axis: usize, i: f64| {
            let n = f64::from(level.size[axis]);
            match self.sampler.address[axis] {
                AddressMode::Repeat => i.rem_euclid(n) as u32,
                _ => i.clamp(0.0, n - 1.0) as u32,
            }
        };
        let (x, y) = (place(0), place(1));
        if filter == FilterMode::Nearest {
            return level.texel([index(0, x.floor()), index(1, y.floor())]);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let texel = |dx: f64, dy: f64| level.texel([index(0, left + dx), index(1, top + dy)]);
        let corners = [
            texel(0.0, 0.0),
            texel(1.0, 0.0),
            texel(0.0, 1.0),
            texel(1.0, 1.0),
        ];
        let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
        [0, 1, 2].map(|c| {
            let [a, b, d, e] = corners.map(|t| t[c]);
            mix(mix(a, b, x - left), mix(d, e, x - left), y - top)
        })
    }
}

/// A coordinate in one period. Borders are of no format of models.
fn wrapped(mode: AddressMode, u: f64) -> f64 {
    let u = if u.is_finite() { u } else { 0.0 };
    match mode {
        AddressMode::Repeat => u - u.floor(),
        AddressMode::MirrorRepeat => (u - 2.0 * (u * 0.5).round_ties_even()).abs(),
        AddressMode::ClampToEdge | AddressMode::ClampToBorder => u.clamp(-1.0, 2.0),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::world::texture::Picture;

    /// Four texels in a row: black, white, black, black; averaged 1/2 and 0, then 1/4.
    fn texture(address: AddressMode) -> SurfaceTexture {
        let image = image::GrayImage::from_raw(4, 1, vec![0, 255, 0, 0]).unwrap();
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        let mut texture =
            SurfaceTexture::repeated(Arc::new(Picture::decode(&bytes.into_inner()).unwrap()));
        texture.sampler.address = [address; 3];
        texture
    }

    fn grey(texture: &SurfaceTexture, u: f64, step: f64) -> f64 {
        let [r, g, b] = texture.sample([u, 0.5], [[step, 0.0], [0.0, 0.0]]);
        assert!(r == g && g == b);
        r
    }

    #[test]
    fn texels_have_their_own_colour_in_their_middles() {
        let texture = texture(AddressMode::Repeat);
        for (u, expected) in [(0.125, 0.0), (0.25, 0.5), (0.375, 1.0), (0.4375, 0.75)] {
            assert_eq!(grey(&texture, u, 0.01), expected, "{u}");
        }
    }

    /// By the texture rules: the level's texels are as wide as a pixel's step.
    #[test]
    fn levels_are_as_coarse_as_pixels() {
        let texture = texture(AddressMode::Repeat);
        for (texels, expected) in [(1.0, 1.0), (2.0, 0.375), (4.0, 0.25), (64.0, 0.25)] {
            let seen = grey(&texture, 0.375, texels / 4.0);
            assert!((seen - expected).abs() < 1e-12, "{texels}: {seen}");
        }
        // Half way between two levels.
        let half = grey(&texture, 0.375, std::f64::consts::SQRT_2 / 4.0);
        assert!((half - 0.5 * (1.0 + 0.375)).abs() < 1e-12, "{half}");
    }

    #[test]
    fn coordinates_outside_are_where_their_address_says() {
        for (address, expected) in [
            (AddressMode::Repeat, [1.0, 0.0, 0.0]),
            (AddressMode::MirrorRepeat, [0.0, 1.0, 1.0]),
            (AddressMode::ClampToEdge, [0.0, 0.0, 0.0]),
        ] {
            let mut texture = texture(address);
            texture.sampler.mag = FilterMode::Nearest;
            let seen = [1.375, 1.625, -0.375].map(|u| grey(&texture, u, 0.01));
            assert_eq!(seen, expected, "{address:?}");
        }
    }
}
