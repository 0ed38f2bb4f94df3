//! Fractal landscapes by midpoint displacement (Fournier, Fussell and
//! Carpenter 1982, in the diamond-square form).

use glam::DVec3;

use super::Shape;

/// A landscape of `2 cells^2` triangles over the square `|x|, |z| <= half`,
/// facing up, not closed: the corner of a `(2^levels + 1)^2` diamond-square
/// grid, cropped to `cells + 1` points a side.
///
/// # Panics
/// When `cells > 2^levels`.
pub fn diamond_square(levels: u32, cells: u32, half: f64, amplitude: f64, seed: u32) -> Shape {
    let heights = Heights::grow(levels, amplitude, seed);
    assert!(cells < heights.side, "{cells} cells do not fit 2^{levels}");
    let at = |k: u32| -half + (2.0 * half) * f64::from(k) / f64::from(cells);
    let side = cells + 1;
    let positions = (0..side * side).map(|i| {
        let (row, column) = (i / side, i % side);
        DVec3::new(at(column), heights.at(row, column), at(row))
    });
    let triangles = (0..cells * cells).flat_map(|i| {
        let i0 = i / cells * side + i % cells;
        let (i1, i2, i3) = (i0 + 1, i0 + side, i0 + side + 1);
        [[i0, i2, i1], [i1, i2, i3]]
    });
    Shape {
        positions: positions.collect(),
        triangles: triangles.collect(),
    }
}

/// A square grid of heights.
struct Heights {
    side: u32,
    values: Vec<f64>,
}

impl Heights {
    fn grow(levels: u32, amplitude: f64, seed: u32) -> Self {
        let side = (1 << levels) + 1;
        let mut grid = Self {
            side,
            values: vec![0.0; (side * side) as usize],
        };
        let (mut step, mut amplitude) = (side - 1, amplitude);
        while step > 1 {
            let half = step / 2;
            grid.displace(half, step, amplitude, seed, |row, column| row && column);
            grid.displace(half, step, amplitude, seed, |row, column| row != column);
            (step, amplitude) = (half, amplitude * 0.5);
        }
        grid
    }

    /// Sets the points whose (row, column) are odd multiples of `half` as
    /// `wanted` says: all of the diamond step, or all of the square step.
    fn displace(
        &mut self,
        half: u32,
        step: u32,
        amplitude: f64,
        seed: u32,
        wanted: fn(bool, bool) -> bool,
    ) {
        for row in (0..self.side).step_by(half as usize) {
            for column in (0..self.side).step_by(half as usize) {
                let odd = (row % step != 0, column % step != 0);
                if wanted(odd.0, odd.1) {
                    let reach = if odd.0 && odd.1 { DIAGONAL } else { STRAIGHT };
                    let height = self.mean(row, column, half, reach);
                    let noise = amplitude * hash(row, column, seed);
                    self.values[(row * self.side + column) as usize] = height + noise;
                }
            }
        }
    }

    /// Mean of the neighbours that exist.
    fn mean(&self, row: u32, column: u32, half: u32, directions: [(i64, i64); 4]) -> f64 {
        let inside = |k: i64| (0..i64::from(self.side)).contains(&k);
        let (mut sum, mut count) = (0.0, 0.0);
        for (down, right) in directions {
            let r = i64::from(row) + down * i64::from(half);
            let c = i64::from(column) + right * i64::from(half);
            if inside(r) && inside(c) {
                sum += self.at(r as u32, c as u32);
                count += 1.0;
            }
        }
        sum / count
    }

    fn at(&self, row: u32, column: u32) -> f64 {
        self.values[(row * self.side + column) as usize]
    }
}

const DIAGONAL: [(i64, i64); 4] = [(-1, -1), (-1, 1), (1, -1), (1, 1)];
const STRAIGHT: [(i64, i64); 4] = [(-1, 0), (0, -1), (0, 1), (1, 0)];

/// A grid point to [-1, 1).
fn hash(row: u32, column: u32, seed: u32) -> f64 {
    let mut h = row.wrapping_mul(0x9E37_79B1) ^ column.wrapping_mul(0x85EB_CA77) ^ seed;
    h ^= h >> 15;
    h = h.wrapping_mul(0x2C1B_3C6D);
    h ^= h >> 12;
    h = h.wrapping_mul(0x297A_2D39);
    h ^= h >> 15;
    f64::from(h >> 8) / 8_388_608.0 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn landscape_has_the_size_asked_for_and_faces_up() {
        let land = diamond_square(4, 14, 3.0, 1.0, 7);
        assert_eq!(
            (land.positions.len(), land.triangles.len()),
            (15 * 15, 2 * 14 * 14)
        );
        for [a, b, c] in &land.triangles {
            let [a, b, c] = [a, b, c].map(|i| land.positions[*i as usize]);
            assert!((b - a).cross(c - a).y > 0.0);
        }
        let heights = land.positions.iter().map(|p| p.y);
        assert!(heights.clone().fold(f64::MIN, f64::max) > heights.fold(f64::MAX, f64::min));
    }
}
