//! What a curve of error against cost costs at a given error.

/// The cost at which `curve`, points (cost, error) by rising cost, falls to `error`
/// for the last time, by a straight line in logarithms; the least cost tried where
/// that is better, the greatest where even that is worse.
pub(super) fn cost_of_error(curve: &[[f64; 2]], error: f64) -> f64 {
    let ln = |v: f64| libm::log(v);
    let mut pairs = curve.windows(2).rev();
    let crossing = pairs.find(|w| w[0][1] >= error && w[1][1] < error);
    match (crossing, curve) {
        (Some(w), _) => {
            let t = (ln(w[0][1]) - ln(error)) / (ln(w[0][1]) - ln(w[1][1]));
            libm::exp(ln(w[0][0]) + t * (ln(w[1][0]) - ln(w[0][0])))
        }
        (None, [first, ..]) if first[1] < error => first[0],
        (None, [.., last]) => last[0],
        (None, []) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_error_is_found_between_points() {
        let falling = [[10.0, 0.1], [1000.0, 0.001]];
        assert!((cost_of_error(&falling, 0.01) - 100.0).abs() < 1e-9);
        assert_eq!(cost_of_error(&falling, 0.5), 10.0);
        assert_eq!(cost_of_error(&falling, 1e-5), 1000.0);
        let uneven = [[1.0, 0.1], [2.0, 0.01], [4.0, 0.1], [8.0, 0.01]];
        assert!(cost_of_error(&uneven, 0.05) > 4.0);
        assert!(cost_of_error(&[], 0.1).is_nan());
    }
}
