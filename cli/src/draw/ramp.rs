//! Colours for amounts.

/// Stops of the ramp, dark to bright (an approximation of `inferno`, readable
/// in greyscale and by people who do not tell red from green).
const STOPS: [[f32; 3]; 7] = [
    [20.0, 11.0, 53.0],
    [74.0, 12.0, 107.0],
    [136.0, 34.0, 106.0],
    [192.0, 58.0, 76.0],
    [237.0, 105.0, 37.0],
    [251.0, 182.0, 26.0],
    [252.0, 255.0, 164.0],
];

/// The colour of `amount` in 0..=1; values outside are limited, NaN is 0.
pub(crate) fn heat(amount: f32) -> [u8; 3] {
    let last = STOPS.len() - 1;
    let amount = if amount > 0.0 { amount.min(1.0) } else { 0.0 };
    let place = amount * last as f32;
    let below = (place as usize).min(last - 1);
    let part = place - below as f32;
    let mix = |c: usize| STOPS[below][c] * (1.0 - part) + STOPS[below + 1][c] * part;
    [0, 1, 2].map(|c| mix(c).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_grows_brighter() {
        let luma = |c: [u8; 3]| 2 * u32::from(c[0]) + 5 * u32::from(c[1]) + u32::from(c[2]);
        let ramp: Vec<u32> = (0..=64).map(|i| luma(heat(i as f32 / 64.0))).collect();
        assert!(ramp.is_sorted(), "{ramp:?}");
        assert_eq!(heat(-1.0), heat(0.0));
        assert_eq!(heat(f32::NAN), heat(0.0));
    }
}
