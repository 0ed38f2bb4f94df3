//! Filtering inside a level and between two (texture rules, §2).

use gnomon_raster::AddressMode;

use super::super::image::channels;
use super::axis::{Outside, Selected, select};
use super::texel::{canonical, decode};
use super::{Bound, Detail, Looked, TexelRead, cube};

/// `a + t·(b − a)`, channel by channel.
fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|c| a[c] + t * (b[c] - a[c]))
}

/// The only value, or the mixture of two; texels read add up.
fn along(values: Vec<Looked>, weight: f32) -> Looked {
    let read = values.iter().flat_map(|v| v.1.clone()).collect();
    match &values[..] {
        [(a, _), (b, _)] => (mix(*a, *b, weight), read),
        _ => (values[0].0, read),
    }
}

impl Bound {
    /// A filtered look-up.
    pub(in crate::twin) fn sample(&self, coordinate: [f32; 3], detail: Detail) -> Looked {
        let levels = self.levels(coordinate, detail);
        let (face, at) = if self.is_cube() {
            let face = cube::face_of(coordinate);
            (face, cube::coordinate(face, coordinate))
        } else {
            (0, coordinate)
        };
        let first = self.level(levels.first, levels.linear, face, at);
        if levels.fraction == 0.0 {
            return (canonical(first.0), first.1);
        }
        let second = self.level(levels.first + 1, levels.linear, face, at);
        let (value, read) = along(vec![first, second], levels.fraction);
        (canonical(value), read)
    }

    fn level(&self, level: usize, linear: bool, face: usize, at: [f32; 3]) -> Looked {
        let size = self.texture.level_size(level);
        let [x, y, z] = [0, 1, 2].map(|k| self.axis(k, linear, at[k], size[k]));
        let texel = |i: Option<i64>, j: Option<i64>, k: Option<i64>| match (i, j, k) {
            (Some(i), Some(j), Some(k)) => self.texel(level, face, [i, j, k]),
            _ => (self.border(), Vec::new()),
        };
        let row = |j, k| along(x.texels.iter().map(|&i| texel(i, j, k)).collect(), x.weight);
        let slice = |k| along(y.texels.iter().map(|&j| row(j, k)).collect(), y.weight);
        along(z.texels.iter().map(|&k| slice(k)).collect(), z.weight)
    }

    fn axis(&self, k: usize, linear: bool, u: f32, n: u32) -> Selected {
        if k >= self.axes() {
            return Selected {
                texels: vec![Some(0)],
                weight: 0.0,
            };
        }
        if !self.is_cube() {
            let mode = self.sampler.address[k];
            return select(mode, Outside::Mode(mode), linear, u, n);
        }
        let edge = AddressMode::ClampToEdge;
        let outside = if linear {
            Outside::Kept
        } else {
            Outside::Mode(edge)
        };
        select(edge, outside, linear, u, n)
    }

    fn texel(&self, level: usize, face: usize, [i, j, k]: [i64; 3]) -> Looked {
        let (layer, at) = if self.is_cube() {
            let n = i64::from(self.texture.level_size(level)[0]);
            cube::fold(face, [i, j], n)
        } else {
            (k as usize, [i, j])
        };
        let read = TexelRead { level, layer, at };
        (decode(self.texture.format, self.stored(read)), vec![read])
    }

    fn border(&self) -> [f32; 4] {
        let mut value = [0.0, 0.0, 0.0, 1.0];
        let n = channels(self.texture.format);
        value[..n].copy_from_slice(&self.sampler.border[..n]);
        value
    }
}
