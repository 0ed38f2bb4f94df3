//! Colours for signed errors: blue where a picture is too dark, orange where it
//! is too bright, near white where it is right. The two hues differ for people
//! who do not tell red from green, and both darken with the size of the error.
//!
//! The scale is logarithmic, three decades to either side, so that techniques of
//! very different quality can be looked at side by side: errors up to
//! [`LEAST`] are neutral.

/// Error that still shows as none: a quarter of an 8-bit step.
pub(crate) const LEAST: f64 = 0.001;
/// Decades from [`LEAST`] to an error of 1.
const DECADES: usize = 3;

/// From too dark by 1 to too bright by 1, a stop for each decade.
const STOPS: [[f32; 3]; 7] = [
    [5.0, 38.0, 97.0],
    [33.0, 102.0, 172.0],
    [146.0, 197.0, 222.0],
    [247.0, 247.0, 247.0],
    [253.0, 190.0, 110.0],
    [224.0, 104.0, 8.0],
    [120.0, 48.0, 0.0],
];

/// The colour of a place on the scale, 0 being an error of -1, 1/2 none and 1 an
/// error of 1; places outside are limited.
pub(crate) fn diverging(place: f32) -> [u8; 3] {
    let last = STOPS.len() - 1;
    let along = place.clamp(0.0, 1.0) * last as f32;
    let below = (along as usize).min(last - 1);
    let part = along - below as f32;
    let mix = |c: usize| STOPS[below][c] * (1.0 - part) + STOPS[below + 1][c] * part;
    [0, 1, 2].map(|c| mix(c).round() as u8)
}

/// Place of a signed error on the scale; piecewise linear, a third of either
/// half for each decade.
pub(crate) fn place(error: f64) -> f32 {
    let (mut size, mut decades) = (error.abs().min(1.0), 0);
    while size < 1.0 && decades < DECADES {
        size *= 10.0;
        decades += 1;
    }
    // Within 1..10 of its decade, or below the least of all.
    let part = ((size - 1.0) / 9.0).clamp(0.0, 1.0);
    let along = ((DECADES - decades) as f64 + part).min(DECADES as f64) / DECADES as f64;
    (0.5 + 0.5 * along.copysign(error)) as f32
}

/// Labels of the scale.
pub(crate) fn labels() -> Vec<(f32, String)> {
    let texts = ["-1", "-0.1", "-0.01", "0", "+0.01", "+0.1", "+1"];
    let last = (texts.len() - 1) as f32;
    let place = |k: usize| k as f32 / last;
    texts
        .iter()
        .enumerate()
        .map(|(k, text)| (place(k), (*text).to_owned()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_symmetric_and_decades_are_thirds() {
        for (error, expected) in [
            (0.0, 0.5),
            (LEAST, 0.5),
            (0.01, 0.5 + 1.0 / 6.0),
            (0.1, 0.5 + 2.0 / 6.0),
            (1.0, 1.0),
            (7.0, 1.0),
        ] {
            assert!(
                (place(error) - expected).abs() < 1e-6,
                "{error}: {}",
                place(error)
            );
            assert!((place(-error) - (1.0 - expected)).abs() < 1e-6);
        }
        let errors = (0..1000).map(|k| f64::from(k) / 999.0);
        assert!(errors.map(place).is_sorted());
    }

    #[test]
    fn no_error_is_neutral_and_larger_ones_are_darker() {
        let [r, g, b] = diverging(place(0.0));
        assert!(r == g && g == b && r > 240);
        let luma = |e: f64| {
            let c = diverging(place(e)).map(u32::from);
            2 * c[0] + 5 * c[1] + c[2]
        };
        for sign in [-1.0, 1.0] {
            let sizes = (0..=60).map(|k| luma(sign * f64::from(k) / 60.0));
            assert!(sizes.rev().is_sorted(), "{sign}");
        }
        assert!(diverging(0.1)[2] > diverging(0.1)[0] && diverging(0.9)[0] > diverging(0.9)[2]);
    }

    #[test]
    fn labels_stand_where_their_errors_are() {
        for (at, text) in labels() {
            let error: f64 = text.parse().unwrap();
            assert!((place(error) - at).abs() < 1e-6, "{text}");
        }
    }
}
