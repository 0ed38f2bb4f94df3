//! Directions that rays are cast in.

use glam::DVec3;

use crate::geometry::harmonics::Basis;
use crate::world::shape::on_circle;

/// π (3 - √5), the angle that no number of steps closes.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Directions before a vertex.
pub(super) struct Hidden {
    /// How many there are.
    pub(super) asked: u64,
    /// In how many something was met.
    pub(super) met: u64,
}

/// A spherical Fibonacci lattice with the bases at its directions: equal solid angles,
/// evenly spread, the same for every vertex, so that neighbours differ by what they see
/// and not by noise.
pub(super) struct Lattice {
    directions: Vec<DVec3>,
    /// Values of each basis, direction after direction.
    values: [Vec<f64>; 2],
    /// Solid angle of a direction.
    angle: f64,
}

impl Lattice {
    pub(super) fn new(count: usize, bases: &[Basis; 2]) -> Self {
        let direction = |k: usize| {
            let z = 1.0 - (2 * k + 1) as f64 / count as f64;
            let (cos, sin) = on_circle(GOLDEN_ANGLE * k as f64);
            let across = (1.0 - z * z).sqrt();
            DVec3::new(across * cos, across * sin, z)
        };
        let directions: Vec<DVec3> = (0..count).map(direction).collect();
        let all = |basis: &Basis| directions.iter().flat_map(|d| basis.at(*d)).collect();
        Self {
            values: [all(&bases[0]), all(&bases[1])],
            angle: 4.0 * std::f64::consts::PI / count as f64,
            directions,
        }
    }

    /// Directions before `normal`.
    pub(super) fn before(&self, normal: DVec3) -> impl Iterator<Item = DVec3> {
        let all = self.directions.iter().copied();
        all.filter(move |d| normal.dot(*d) > 0.0)
    }

    /// Takes the directions before `normal` in which `hidden` holds off the cosine's
    /// coefficients and the half space's.
    pub(super) fn take_off(
        &self,
        normal: DVec3,
        hidden: impl Fn(DVec3) -> bool,
        off: [&mut [f64]; 2],
    ) -> Hidden {
        let [diffuse, glossy] = off;
        let (mut asked, mut met) = (0, 0);
        for (k, d) in self.directions.iter().enumerate() {
            let cosine = normal.dot(*d);
            if cosine <= 0.0 {
                continue;
            }
            asked += 1;
            if hidden(*d) {
                met += 1;
                self.subtract(0, k, cosine, diffuse);
                self.subtract(1, k, 1.0, glossy);
            }
        }
        Hidden { asked, met }
    }

    fn subtract(&self, basis: usize, direction: usize, weight: f64, from: &mut [f64]) {
        let row = &self.values[basis][direction * from.len()..];
        let scaled = weight * self.angle;
        from.iter_mut().zip(row).for_each(|(c, y)| *c -= scaled * y);
    }
}
