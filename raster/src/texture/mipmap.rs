//! Smaller levels from larger ones, on the CPU.

use super::{Subresource, Texture, TextureDimension};
use crate::error::Error;
use crate::format::{Format, decode, encode};
use crate::memory::reserve;

/// One source texel's share in a destination texel, along one axis.
struct Share {
    source: usize,
    weight: f64,
}

/// The texels of `from` under texel `i` of `to = max(1, from / 2)`, and how much of
/// it each covers: two halves, or of an odd size three parts.
fn shares(i: usize, from: usize, to: usize) -> Vec<Share> {
    if from == 1 {
        return vec![Share {
            source: 0,
            weight: 1.0,
        }];
    }
    if from == 2 * to {
        return [2 * i, 2 * i + 1]
            .map(|source| Share {
                source,
                weight: 0.5,
            })
            .into();
    }
    let n = from as f64;
    let parts = [(to - i) as f64 / n, to as f64 / n, (i + 1) as f64 / n];
    parts
        .into_iter()
        .enumerate()
        .map(|(k, weight)| Share {
            source: 2 * i + k,
            weight,
        })
        .collect()
}

/// Texels of all slices of a level, slice by slice.
struct Level {
    size: [usize; 3],
    texels: Vec<[f64; 4]>,
}

impl Level {
    /// The average over the box of each texel of the next level: in f64, x
    /// innermost.
    fn halved(&self, size: [usize; 3]) -> Self {
        let mut texels = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                texels.extend((0..size[0]).map(|x| self.average([x, y, z], size)));
            }
        }
        Self { size, texels }
    }

    fn average(&self, at: [usize; 3], size: [usize; 3]) -> [f64; 4] {
        let [xs, ys, zs] = core::array::from_fn(|k| shares(at[k], self.size[k], size[k]));
        let mut sum = [0.0; 4];
        for z in &zs {
            for y in &ys {
                for x in &xs {
                    let t =
                        self.texels[(z.source * self.size[1] + y.source) * self.size[0] + x.source];
                    let w = z.weight * y.weight * x.weight;
                    for (s, v) in sum.iter_mut().zip(t) {
                        *s += w * v;
                    }
                }
            }
        }
        sum
    }
}

/// Raw channels as numbers; integers exactly.
fn numbers(format: Format, raw: [u32; 4]) -> [f64; 4] {
    match format {
        Format::R32Uint => [f64::from(raw[0]), 0.0, 0.0, 0.0],
        _ => decode(format, raw).map(f64::from),
    }
}

/// Numbers as raw channels, rounded as a shader's output is; integers half-even.
fn raw(format: Format, v: [f64; 4]) -> [u32; 4] {
    match format {
        Format::R32Uint => [v[0].round_ties_even() as u32, 0, 0, 0],
        _ => encode(format, v.map(|c| c as f32)),
    }
}

impl Texture {
    /// Computes every level after the first as the box-filtered average of the
    /// one before: each texel is the mean of what it covers (of an odd size
    /// 2m + 1 the three texels under it in proportion to their overlap). Averages
    /// are taken of the *stored* values of the level before, in f64, and stored
    /// as a shader's output would be; `R32Uint` rounds half to even.
    ///
    /// A convenience of the CPU: it is no pass, and nothing of it is counted.
    ///
    /// # Errors
    /// Where the texture is not colour.
    pub fn generate_mipmaps(&mut self) -> Result<(), Error> {
        for mip in 1..self.desc.mip_levels {
            let images = if self.desc.dimension == TextureDimension::Cube {
                6
            } else {
                1
            };
            for image in 0..images {
                let from = self.level(mip - 1, image)?;
                let to = from.halved(self.mip_size(mip).map(|s| s as usize));
                self.set_level(mip, image, &to)?;
            }
        }
        Ok(())
    }

    /// All slices of a 3D level, or the one image `layer`.
    fn level(&self, mip: u32, layer: u32) -> Result<Level, Error> {
        let size = self.mip_size(mip);
        let mut texels = Vec::new();
        let n = size.iter().map(|s| *s as usize).product();
        let label = &self.desc.label;
        reserve(&mut texels, n, || {
            format!("level {mip} of `{label}` in doubles")
        })?;
        for z in 0..size[2] {
            let raw = self.read_raw(Subresource {
                mip,
                layer: layer + z,
            })?;
            texels.extend(raw.into_iter().map(|t| numbers(self.desc.format, t)));
        }
        Ok(Level {
            size: size.map(|s| s as usize),
            texels,
        })
    }

    fn set_level(&mut self, mip: u32, layer: u32, level: &Level) -> Result<(), Error> {
        let format = self.desc.format;
        let slices = level.texels.chunks(level.size[0] * level.size[1]);
        for (z, slice) in slices.enumerate() {
            let raw: Vec<_> = slice.iter().map(|t| raw(format, *t)).collect();
            self.write_raw(
                Subresource {
                    mip,
                    layer: layer + z as u32,
                },
                &raw,
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::TextureDescriptor;
    use super::*;

    fn texture(
        dimension: TextureDimension,
        format: Format,
        size: [u32; 3],
        mip_levels: u32,
    ) -> Texture {
        Texture::new(&TextureDescriptor {
            label: "t".into(),
            dimension,
            format,
            size,
            mip_levels,
        })
        .unwrap()
    }

    #[test]
    fn shares_cover_the_texel_and_sum_to_one() {
        for from in 1..40 {
            let to = (from / 2).max(1);
            let mut covered = vec![0.0; from];
            for i in 0..to {
                let s = shares(i, from, to);
                assert!((s.iter().map(|s| s.weight).sum::<f64>() - 1.0).abs() < 1e-12);
                s.iter().for_each(|s| covered[s.source] += s.weight);
            }
            let share = to as f64 / from as f64;
            assert!(covered.iter().all(|c| (c - share).abs() < 1e-12), "{from}");
        }
    }

    #[test]
    fn a_constant_stays_and_a_mean_is_kept() {
        let mut t = texture(TextureDimension::D2, Format::Rgba8Unorm, [7, 5, 1], 3);
        t.write_color(Subresource::default(), &[[0.2, 0.4, 0.6, 1.0]; 35])
            .unwrap();
        t.generate_mipmaps().unwrap();
        for mip in 1..3 {
            let s = Subresource { mip, layer: 0 };
            assert!(
                t.read_raw(s)
                    .unwrap()
                    .iter()
                    .all(|t| *t == [51, 102, 153, 255])
            );
        }
        let mut t = texture(TextureDimension::D3, Format::R32Float, [4, 4, 4], 3);
        for layer in 0..4 {
            let slice: Vec<_> = (0..16)
                .map(|i| [(16 * layer + i) as f32, 0.0, 0.0, 0.0])
                .collect();
            t.write_color(Subresource { mip: 0, layer }, &slice)
                .unwrap();
        }
        t.generate_mipmaps().unwrap();
        assert_eq!(
            t.read_color(Subresource { mip: 2, layer: 0 }).unwrap()[0].0[0],
            31.5
        );
        assert_eq!(
            t.read_color(Subresource { mip: 1, layer: 0 }).unwrap()[0].0[0],
            10.5
        );
    }

    #[test]
    fn integers_and_cube_faces_are_kept_apart_and_depth_is_refused() {
        let mut t = texture(TextureDimension::Cube, Format::R32Uint, [2, 2, 1], 2);
        for layer in 0..6 {
            let v = 0xffff_fff0 + layer;
            t.write_raw(Subresource { mip: 0, layer }, &[[v, 0, 0, 0]; 4])
                .unwrap();
        }
        t.generate_mipmaps().unwrap();
        for layer in 0..6 {
            assert_eq!(
                t.read_raw(Subresource { mip: 1, layer }).unwrap(),
                [[0xffff_fff0 + layer, 0, 0, 0]]
            );
        }
        let mut t = texture(TextureDimension::D2, Format::Depth24Stencil8, [2, 2, 1], 2);
        assert!(matches!(
            t.generate_mipmaps(),
            Err(Error::WrongAspect { .. })
        ));
    }
}
