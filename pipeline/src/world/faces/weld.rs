//! Equal coordinates are one point, however often a file writes them.
//!
//! Exporters write a vertex once for each of its texture coordinates or normals,
//! which tears a closed solid apart where those have a seam. Positions decide
//! alone here what is connected.

use glam::DVec3;

/// For each point the index of the first one that equals it.
pub(crate) fn first_equals(points: &[DVec3]) -> Vec<u32> {
    // Adding 0 turns -0 into 0, so that equal numbers have equal bits.
    let bits = |i: u32| {
        (points[i as usize] + DVec3::ZERO)
            .to_array()
            .map(f64::to_bits)
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (bits(i), i));
    let mut first = vec![0; points.len()];
    for run in order.chunk_by(|&a, &b| bits(a) == bits(b)) {
        for &i in run {
            first[i as usize] = run[0];
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_points_stands_for_all() {
        let points = [
            [0.0, 1.0, 2.0],
            [1.0; 3],
            [-0.0, 1.0, 2.0],
            [1.0; 3],
            [2.0; 3],
        ];
        assert_eq!(first_equals(&points.map(DVec3::from)), [0, 1, 0, 1, 4]);
        // One step of f64 apart is another point.
        let near = [[1.0; 3], [1.0, 1.0, 1.0 + f64::EPSILON]];
        assert_eq!(first_equals(&near.map(DVec3::from)), [0, 1]);
    }
}
