//! Level of detail (texture rules, §3).

use gnomon_raster::FilterMode;

use super::axis::limit;
use super::log2::log2;
use super::{Bound, cube};

/// What the level of detail comes from.
#[derive(Clone, Copy)]
pub(in crate::twin) enum Detail {
    /// The change of the coordinate to the next pixel in x and in y.
    Changes([[f32; 3]; 2]),
    /// The level itself.
    Level(f32),
}

/// Levels that are read, and how.
pub(super) struct Levels {
    pub(super) linear: bool,
    pub(super) first: usize,
    /// Weight of the level after it; it is not read where this is 0.
    pub(super) fraction: f32,
}

impl Bound {
    pub(super) fn levels(&self, coordinate: [f32; 3], detail: Detail) -> Levels {
        let s = &self.sampler;
        let last = (self.texture.images.len() - 1) as f32;
        if last == 0.0 && s.mag == s.min {
            return Levels {
                linear: s.mag == FilterMode::Linear,
                first: 0,
                fraction: 0.0,
            };
        }
        let lambda = match detail {
            Detail::Level(lod) => lod + 0.0,
            Detail::Changes(c) => self.lambda(coordinate, c) + s.lod_bias,
        };
        let lambda = limit(lambda, s.lod[0], s.lod[1]);
        let filter = if lambda <= 0.0 { s.mag } else { s.min };
        let level = match s.mip {
            FilterMode::Nearest => limit((lambda + 0.5).floor(), 0.0, last),
            FilterMode::Linear => limit(lambda, 0.0, last),
        };
        Levels {
            linear: filter == FilterMode::Linear,
            first: level.floor() as usize,
            fraction: level - level.floor(),
        }
    }

    fn lambda(&self, coordinate: [f32; 3], changes: [[f32; 3]; 2]) -> f32 {
        let [x, y] = changes.map(|d| {
            if self.is_cube() {
                self.square(cube::change(cube::face_of(coordinate), coordinate, d))
            } else {
                self.square(d)
            }
        });
        log2(if x > y { x } else { y }) * 0.5
    }

    /// ρ².
    fn square(&self, d: [f32; 3]) -> f32 {
        let mut sum = 0.0;
        for k in 0..self.axes() {
            let texels = d[k] * self.texture.size[k] as f32;
            let square = texels * texels;
            sum = if k == 0 { square } else { sum + square };
        }
        sum
    }
}
