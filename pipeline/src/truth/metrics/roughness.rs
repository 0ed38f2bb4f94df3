//! How rough a straight edge of a shadow is: a jagged one differs along itself.

use std::collections::BTreeMap;

/// Fewest values that a strip is judged by.
const FEWEST: usize = 9;

/// By how much visibility differs along a straight edge, root mean square: `values` are
/// distances from the edge, each with what is seen there, and are judged in strips of
/// `width` along it; what changes evenly across a strip is taken off. 0 without values.
pub fn roughness(values: impl IntoIterator<Item = [f64; 2]>, width: f64) -> f64 {
    let mut strips = BTreeMap::<i64, Vec<[f64; 2]>>::new();
    for [distance, value] in values {
        let strip = (distance / width).floor() as i64;
        strips.entry(strip).or_default().push([distance, value]);
    }
    let judged = strips.values().filter(|strip| strip.len() >= FEWEST);
    let (sum, count) = judged.fold((0.0, 0), |(sum, count), strip| {
        (sum + off_a_line(strip), count + strip.len())
    });
    (sum / count.max(1) as f64).sqrt()
}

/// Sum of the squares by which values differ from the line that fits them best.
fn off_a_line(points: &[[f64; 2]]) -> f64 {
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| f(p[0] - x, p[1] - y)).sum();
    let (xx, xy): (f64, f64) = (sum(&|a, _| a * a), sum(&|a, b| a * b));
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    sum(&|a, b| (b - slope * a) * (b - slope * a))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ramps are smooth, however steep; teeth are as rough as they are deep, and values in
    /// strips of too few are left out.
    #[test]
    fn teeth_are_rough_and_ramps_are_not() {
        let at = |k: u32| f64::from(k) / 100.0;
        let ramp = (0..100).map(|k| [at(k), 3.0 * at(k)]);
        assert!(roughness(ramp, 0.2) < 1e-12);
        let teeth = (0..100).map(|k| [0.0, if k % 2 == 0 { 0.25 } else { 0.75 }]);
        assert_eq!(roughness(teeth, 0.2), 0.25);
        assert_eq!(roughness((0..8).map(|k| [0.0, at(k)]), 0.2), 0.0);
        assert_eq!(roughness([], 0.2), 0.0);
    }
}
