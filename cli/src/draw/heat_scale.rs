//! Scales of heat maps: where they end, where a value lies, what is written beside them.

/// Where a heat scale ends: at the value that all but one in 200 of the values
/// above zero stay below, so that a few extremes do not darken the rest.
pub(crate) fn scale_top(values: impl Iterator<Item = u64>) -> u64 {
    let mut values: Vec<u64> = values.filter(|v| *v > 0).collect();
    values.sort_unstable();
    let last = values.len().saturating_sub(1);
    values.get(last - values.len() / 200).copied().unwrap_or(1)
}

/// Place of a value on a heat scale. The square root leaves room for the small
/// values, which are the many.
pub(crate) fn place(value: u64, top: u64) -> f32 {
    (value as f32 / top.max(1) as f32).sqrt()
}

/// Labels about evenly along the scale from 0 to `top`; the last one says when
/// there is more.
pub(crate) fn scale_labels(top: u64, max: u64, show: fn(u64) -> String) -> Vec<(f32, String)> {
    let mut values: Vec<u64> = [0, 1, 4, 9, 16].map(|n| (top * n + 8) / 16).to_vec();
    values.dedup();
    let mut labels: Vec<(f32, String)> =
        values.iter().map(|v| (place(*v, top), show(*v))).collect();
    if max > top
        && let Some((_, last)) = labels.last_mut()
    {
        last.insert_str(0, ">=");
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_whole_numbers_at_their_places() {
        let texts = |top, max| -> Vec<String> {
            scale_labels(top, max, |n| n.to_string())
                .into_iter()
                .map(|(_, text)| text)
                .collect()
        };
        assert_eq!(texts(16, 16), ["0", "1", "4", "9", "16"]);
        assert_eq!(texts(3, 9), ["0", "1", "2", ">=3"]);
        assert_eq!(texts(1, 1), ["0", "1"]);
        let places: Vec<f32> = scale_labels(64, 64, |n| n.to_string())
            .into_iter()
            .map(|(p, _)| p)
            .collect();
        assert_eq!(places, [0.0, 0.25, 0.5, 0.75, 1.0]);
    }

    #[test]
    fn a_few_extremes_do_not_set_the_scale() {
        assert_eq!(
            scale_top((0..1000).map(|i| if i == 7 { 9999 } else { 3 })),
            3
        );
        assert_eq!(scale_top([0, 0].into_iter()), 1);
        assert_eq!(scale_top([5].into_iter()), 5);
    }
}
