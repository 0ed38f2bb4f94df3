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
