//! A cube map of energy in whole numbers.
//!
//! Faces are in the order +x, -x, +y, -y, +z, -z and turned as cube maps of GPUs
//! are: seen from inside, rows run from the top. Energy is counted in units of a
//! power of two, so small that all of a colour is about 2^46 of them: sums are
//! exact in any order, and a texel of mean brightness of a 128² face is rounded
//! by one part in 10^8.

use glam::DVec3;

/// Faces of a cube.
pub const FACES: usize = 6;

/// Forward, right and down of each face, as seen from inside.
const AXES: [[DVec3; 3]; FACES] = [
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::Y, DVec3::X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y],
];

/// Most units that a colour sums to: with luminance weights of 14 bits, and a
/// million times over, still below 2^63.
const MOST_UNITS: f64 = 70_368_744_177_664.0; // 2^46

/// Luminance weights of linear Rec. 709 RGB, in ten-thousandths.
const LUMINANCE: [u64; 3] = [2126, 7152, 722];

/// Forward, right and down of a face.
pub fn axes(face: usize) -> [DVec3; 3] {
    AXES[face]
}

/// Vector through `(u, v)` in -1..=1 of a face, right and down; it ends on the
/// cube of half side 1.
pub fn direction(face: usize, [u, v]: [f64; 2]) -> DVec3 {
    let [forward, right, down] = AXES[face];
    forward + right * u + down * v
}

/// Face, and place on it, of a direction that is not zero.
pub fn place_of(direction: DVec3) -> (usize, [f64; 2]) {
    let size = direction.abs();
    let axis = (1..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
    let face = 2 * axis + usize::from(direction[axis] < 0.0);
    let [_, right, down] = AXES[face];
    let at = direction / size[axis];
    (face, [right.dot(at), down.dot(at)])
}

/// Solid angle of the part of a face between -1 corner and `(x, y)`, up to a
/// constant: `atan(xy / sqrt(x² + y² + 1))`.
fn corner_angle(x: f64, y: f64) -> f64 {
    libm::atan2(x * y, (x * x + y * y + 1.0).sqrt())
}

/// Solid angle of the rectangle from `low` to `high` (-1..=1) of a face, in
/// steradians.
pub fn solid_angle(low: [f64; 2], high: [f64; 2]) -> f64 {
    corner_angle(high[0], high[1]) - corner_angle(low[0], high[1]) - corner_angle(high[0], low[1])
        + corner_angle(low[0], low[1])
}

/// Solid angle of texel number `index` of faces of `side` texels, in steradians.
pub(super) fn texel_angle(side: usize, index: usize) -> f64 {
    let edge = |k: usize| -1.0 + 2.0 * k as f64 / side as f64;
    let (x, y) = (index % side, index / side % side);
    solid_angle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)])
}

/// Luminance of an energy, in ten-thousandths of a unit.
pub fn luminance(energy: [u64; 3]) -> u64 {
    (0..3).map(|c| LUMINANCE[c] * energy[c]).sum()
}

/// Energy of an environment by direction.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeMap {
    side: usize,
    /// Face after face, row by row.
    texels: Vec<[u64; 3]>,
    /// Radiance times steradians of one unit; a power of two.
    unit: f64,
}

impl CubeMap {
    /// From linear radiance, finite and at least 0, face after face, row by row;
    /// `None` without any light.
    #[cfg(test)]
    pub(super) fn new(side: usize, radiance: Vec<[f64; 3]>) -> Option<Self> {
        let of = |i: usize| radiance[i].map(|v| v * texel_angle(side, i));
        Self::of_energy(side, &(0..radiance.len()).map(of).collect::<Vec<_>>())
    }

    /// From radiance times solid angle, finite and at least 0, face after face, row by
    /// row; `None` without any light.
    pub(super) fn of_energy(side: usize, energy: &[[f64; 3]]) -> Option<Self> {
        let total = |c: usize| energy.iter().map(|e| e[c]).sum::<f64>();
        let most = (0..3).map(total).fold(0.0, f64::max);
        let unit = unit_for(most)?;
        let texels = energy.iter().map(|e| e.map(|v| (v / unit).round() as u64));
        Some(Self {
            side,
            texels: texels.collect(),
            unit,
        })
    }

    /// Texels along a side of a face.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Energy of every texel in units, face after face, row by row.
    pub fn texels(&self) -> &[[u64; 3]] {
        &self.texels
    }

    /// Units in radiance times steradians.
    pub fn energy(&self, units: [u64; 3]) -> [f64; 3] {
        units.map(|n| n as f64 * self.unit)
    }

    /// Energy of all texels, in units.
    pub fn total(&self) -> [u64; 3] {
        sum(&self.texels)
    }

    /// The edge between texels `k - 1` and `k` of a side, in -1..=1.
    pub fn edge(&self, k: usize) -> f64 {
        -1.0 + 2.0 * k as f64 / self.side as f64
    }

    /// Solid angle of texel number `index`, in steradians.
    pub fn texel_angle(&self, index: usize) -> f64 {
        texel_angle(self.side, index)
    }

    /// Mean radiance of every texel.
    pub fn radiance(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let texels = self.texels.iter().enumerate();
        texels.map(|(i, e)| self.energy(*e).map(|v| v / self.texel_angle(i)))
    }
}

/// Sum of energies.
pub(super) fn sum(energies: &[[u64; 3]]) -> [u64; 3] {
    energies.iter().fold([0; 3], |mut sum, e| {
        (0..3).for_each(|c| sum[c] += e[c]);
        sum
    })
}

/// The least power of two by which `most` comes to at most [`MOST_UNITS`].
fn unit_for(most: f64) -> Option<f64> {
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let mut unit = 1.0;
    while most / unit > MOST_UNITS {
        unit *= 2.0;
    }
    while most / (unit / 2.0) <= MOST_UNITS {
        unit /= 2.0;
    }
    Some(unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn places_and_directions_are_inverse() {
        for face in 0..FACES {
            for at in [[0.0, 0.0], [0.7, -0.3], [-0.99, 0.2], [0.1, 0.98]] {
                let (found, back) = place_of(direction(face, at) * 3.0);
                assert_eq!(found, face);
                assert!((back[0] - at[0]).abs() < 1e-15 && (back[1] - at[1]).abs() < 1e-15);
            }
            let [forward, right, down] = axes(face);
            // Seen from inside with rows downwards: right, down, forward turn as x, y, z.
            assert_eq!(right.cross(down), -forward, "face {face}");
        }
    }

    #[test]
    fn texels_fill_the_sphere() {
        for side in [1, 2, 7, 32] {
            let cube = CubeMap::new(side, vec![[1.0; 3]; 6 * side * side]).unwrap();
            let all: f64 = (0..cube.texels().len()).map(|i| cube.texel_angle(i)).sum();
            assert!((all - 4.0 * PI).abs() < 1e-12, "{side}: {all}");
            let energy = cube.energy(cube.total())[1];
            assert!((energy - 4.0 * PI).abs() < 1e-9, "{side}: {energy}");
            assert!(cube.radiance().all(|rgb| (rgb[2] - 1.0).abs() < 1e-7));
        }
    }

    #[test]
    fn units_hold_any_brightness() {
        for bright in [1e-30, 1e-3, 1.0, 1e9, 1e30] {
            let cube = CubeMap::new(2, vec![[bright, 0.0, bright / 7.0]; 24]).unwrap();
            let [red, green, _] = cube.energy(cube.total());
            assert!((red / (4.0 * PI * bright) - 1.0).abs() < 1e-9 && green == 0.0);
            let units = cube.total()[0] as f64;
            assert!(units > MOST_UNITS / 2.1 && units <= MOST_UNITS + 24.0);
        }
        assert_eq!(CubeMap::new(1, vec![[0.0; 3]; 6]), None);
    }
}
