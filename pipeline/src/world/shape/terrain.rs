//! Heightfields of lattice value noise.

use glam::DVec3;

use super::Shape;

/// Parameters of [`terrain`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terrain {
    /// Cells along each side.
    pub cells: u32,
    /// Half the side length.
    pub half: f64,
    /// Lattice cells per unit length of the first octave.
    pub frequency: f64,
    /// Octaves; each doubles the frequency and halves the amplitude.
    pub octaves: u32,
    /// Amplitude of the first octave.
    pub amplitude: f64,
}

/// A square heightfield facing up: `2 cells^2` triangles, not closed. Rows run
/// along z, columns along x.
pub fn terrain(parameters: Terrain) -> Shape {
    let Terrain { cells, half, .. } = parameters;
    let side = cells + 1;
    let at = |k: u32| -half + (2.0 * half) * f64::from(k) / f64::from(cells);
    let positions = (0..side).flat_map(|row| {
        (0..side).map(move |column| {
            let (x, z) = (at(column), at(row));
            DVec3::new(x, parameters.height(x, z), z)
        })
    });
    let triangles = (0..cells).flat_map(|row| {
        (0..cells).flat_map(move |column| {
            let i0 = row * side + column;
            let (i1, i2, i3) = (i0 + 1, i0 + side, i0 + side + 1);
            [[i0, i2, i1], [i1, i2, i3]]
        })
    });
    Shape {
        positions: positions.collect(),
        triangles: triangles.collect(),
    }
}

impl Terrain {
    /// Height at a point; `|x|, |z| <= half`.
    pub fn height(&self, x: f64, z: f64) -> f64 {
        let (mut y, mut amplitude, mut frequency) = (0.0, self.amplitude, self.frequency);
        for octave in 0..self.octaves {
            let (px, pz) = ((x + self.half) * frequency, (z + self.half) * frequency);
            y += amplitude * lattice_noise(px, pz, octave);
            amplitude *= 0.5;
            frequency *= 2.0;
        }
        y
    }
}

fn smoothstep(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Smoothly interpolated lattice values; coordinates must not be negative.
fn lattice_noise(px: f64, pz: f64, octave: u32) -> f64 {
    let (ix, iz) = (px.floor(), pz.floor());
    let (sx, sz) = (smoothstep(px - ix), smoothstep(pz - iz));
    let value = |dx: u32, dz: u32| lattice_value(ix as u32 + dx, iz as u32 + dz, octave);
    let a = value(0, 0) + (value(1, 0) - value(0, 0)) * sx;
    let b = value(0, 1) + (value(1, 1) - value(0, 1)) * sx;
    a + (b - a) * sz
}

/// Hash of a lattice point to [-1, 1), the peers' constants.
fn lattice_value(ix: u32, iz: u32, octave: u32) -> f64 {
    let mut h = ix.wrapping_mul(0x8DA6_B343)
        ^ iz.wrapping_mul(0xD816_3841)
        ^ octave.wrapping_mul(0xCB1A_B31F);
    h ^= h >> 16;
    h = h.wrapping_mul(0x7feb_352d);
    h ^= h >> 15;
    h = h.wrapping_mul(0x846c_a68b);
    h ^= h >> 16;
    f64::from(h >> 8) / 8_388_608.0 - 1.0
}
