//! Smaller levels of a picture: each the box-filtered mean of the one before, as the
//! texture rules have it, of light and not of its sRGB numbers.

use std::fmt;
use std::sync::Arc;

use gnomon_raster::format::{f16_from_f32, f32_from_f16};

/// Bytes of a texel: four halves.
const TEXEL: usize = 8;

/// One image of a picture.
#[derive(Clone)]
pub struct Level {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Halves of red, green, blue and alpha, little-endian, rows from the top.
    pub packed: Arc<[u8]>,
}

impl fmt::Debug for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(f, "Level({width}x{height})")
    }
}

impl Level {
    pub(super) fn new(size: [u32; 2], halves: &[u16]) -> Self {
        Self {
            size,
            packed: halves.iter().flat_map(|h| h.to_le_bytes()).collect(),
        }
    }

    /// Red, green and blue of the texel in a column and row that there are.
    pub(crate) fn texel(&self, [x, y]: [u32; 2]) -> [f64; 3] {
        let at = (y as usize * self.size[0] as usize + x as usize) * TEXEL;
        let channel = |c: usize| {
            let bits = [self.packed[at + 2 * c], self.packed[at + 2 * c + 1]];
            f64::from(f32_from_f16(u16::from_le_bytes(bits)))
        };
        [0, 1, 2].map(channel)
    }

    fn halved(&self) -> Self {
        let size = self.size.map(|s| (s / 2).max(1));
        let columns: Vec<_> = (0..size[0])
            .map(|x| Shares::of(x, self.size[0], size[0]))
            .collect();
        let one = f16_from_f32(1.0);
        let mut halves = Vec::with_capacity(size[0] as usize * size[1] as usize * 4);
        for y in 0..size[1] {
            let rows = Shares::of(y, self.size[1], size[1]);
            for columns in &columns {
                let mean = self.mean(columns, &rows);
                halves.extend(mean.map(|v| f16_from_f32(v as f32)));
                halves.push(one);
            }
        }
        Self::new(size, &halves)
    }

    fn mean(&self, columns: &Shares, rows: &Shares) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (y, height) in rows.each() {
            for (x, width) in columns.each() {
                let texel = self.texel([x, y]);
                (0..3).for_each(|c| sum[c] += height * width * texel[c]);
            }
        }
        sum
    }
}

/// The texels under one of half as many, and how much of it each covers.
struct Shares {
    first: u32,
    weights: [f64; 3],
    count: u32,
}

impl Shares {
    /// Under texel `i` of `to = max(1, from / 2)`: two halves, or of an odd size three parts.
    fn of(i: u32, from: u32, to: u32) -> Self {
        let n = f64::from(from);
        let (weights, count) = match from {
            1 => ([1.0, 0.0, 0.0], 1),
            even if even == 2 * to => ([0.5, 0.5, 0.0], 2),
            _ => ([to - i, to, i + 1].map(|part| f64::from(part) / n), 3),
        };
        Self {
            first: 2 * i,
            weights,
            count,
        }
    }

    fn each(&self) -> impl Iterator<Item = (u32, f64)> {
        (0..self.count).map(|k| (self.first + k, self.weights[k as usize]))
    }
}

/// All levels down to one texel.
pub(super) fn chain(first: Level) -> Vec<Level> {
    let mut levels = vec![first];
    while let Some(last) = levels.last().filter(|l| l.size != [1, 1]) {
        let next = last.halved();
        levels.push(next);
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_raster::{Format, Gpu, GpuConfig, Subresource, TextureDescriptor, TextureDimension};

    fn level(size: [u32; 2]) -> Level {
        let count = size[0] * size[1];
        let value = |k: u32| f16_from_f32((k * 7 % 31) as f32 / 31.0);
        let texel = |k: u32| [value(k), value(k + 3), value(k + 5), f16_from_f32(1.0)];
        let halves: Vec<u16> = (0..count).flat_map(texel).collect();
        Level::new(size, &halves)
    }

    /// As the GPU's own convenience makes them, of even and odd sizes.
    #[test]
    fn levels_are_those_of_the_texture_rules() {
        for size in [[1, 1], [4, 4], [5, 3], [7, 1], [6, 9]] {
            let own = chain(level(size));
            let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
            let id = gpu
                .create_texture(&TextureDescriptor {
                    label: "t".into(),
                    dimension: TextureDimension::D2,
                    format: Format::Rgba16Float,
                    size: [size[0], size[1], 1],
                    mip_levels: own.len() as u32,
                })
                .unwrap();
            let texture = gpu.texture_mut(id).unwrap();
            let at = |mip| Subresource { mip, layer: 0 };
            texture.write_packed(at(0), &own[0].packed).unwrap();
            texture.generate_mipmaps().unwrap();
            for (mip, level) in own.iter().enumerate() {
                let expected = texture.read_packed(at(mip as u32)).unwrap();
                assert_eq!(&level.packed[..], expected, "{size:?} {mip}");
            }
        }
    }
}
