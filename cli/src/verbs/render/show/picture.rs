//! Values as pictures with a legend.

use crate::draw::{Canvas, Legend, Picture, heat};
use crate::output::textures::Values;

/// Places along a scale that have a label.
const LABELS: usize = 5;

/// Smallest and largest finite value of a channel, and how many are not finite.
struct Extent {
    low: f64,
    high: f64,
    odd: usize,
}

impl Extent {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut extent = Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            odd: 0,
        };
        for value in values {
            match value.is_finite() {
                true => {
                    extent.low = extent.low.min(value);
                    extent.high = extent.high.max(value);
                }
                false => extent.odd += 1,
            }
        }
        extent
    }

    fn text(&self) -> String {
        let range = match self.low <= self.high {
            true => format!("{} to {}", self.low, self.high),
            false => "no finite value".to_owned(),
        };
        match self.odd {
            0 => range,
            n => format!("{range}, {n} not finite"),
        }
    }
}

/// What a pixel that is not finite looks like.
const ODD: [u8; 3] = [255, 0, 255];

/// One or two channels: the first on a scale from its least to its most.
pub(super) fn scalars(values: &Values, title: &str) -> Picture {
    let first = Extent::of(values.channel(0));
    let span = first.high - first.low;
    let mut canvas = Canvas::new(values.size, [0; 3]);
    let width = values.size[0];
    for (i, value) in values.channel(0).enumerate() {
        let at = [i as u32 % width, i as u32 / width];
        let place = if span > 0.0 {
            (value - first.low) / span
        } else {
            0.0
        };
        let color = if value.is_finite() {
            heat(place as f32)
        } else {
            ODD
        };
        canvas.mix(at, color, 1.0);
    }
    let legend = Legend {
        title: title.to_owned(),
        scale: scale(&first),
        notes: notes(values),
        ..Legend::default()
    };
    legend.below(canvas, heat)
}

fn scale(of: &Extent) -> Vec<(f32, String)> {
    let span = of.high - of.low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let last = (LABELS - 1) as f64;
    let label = |i: usize| {
        let place = i as f64 / last;
        (
            place as f32,
            format!("{}", rounded(of.low + span * place, span)),
        )
    };
    (0..LABELS).map(label).collect()
}

/// As many digits as tell a thousandth of the span.
fn rounded(value: f64, span: f64) -> f64 {
    let mut unit = 1.0;
    while unit > span / 1000.0 && unit > 1e-12 {
        unit /= 10.0;
    }
    let steps = (value / unit).round();
    // Dividing by the reciprocal keeps decimal fractions short.
    if unit < 1.0 {
        steps / (1.0 / unit).round()
    } else {
        steps * unit
    }
}

/// Three channels and more: as `render` shows them.
pub(super) fn colors(picture: Picture, values: &Values, title: &str) -> Picture {
    let legend = Legend {
        title: format!("{title}, clamped to 0..1, as sRGB"),
        notes: notes(values),
        ..Legend::default()
    };
    legend.below(Canvas::showing(&picture), heat)
}

/// The exact range of each channel.
fn notes(values: &Values) -> Vec<String> {
    let names: &[&str] = match values.channels {
        1 => &["values"],
        _ => &["red", "green", "blue", "alpha"],
    };
    let channels = names.iter().take(values.channels).enumerate();
    let ranges =
        channels.map(|(i, name)| format!("{name} {}", Extent::of(values.channel(i)).text()));
    vec![ranges.collect::<Vec<_>>().join("; ")]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(channels: usize, numbers: &[f64]) -> Values {
        Values {
            size: [numbers.len() as u32 / channels as u32, 1],
            channels,
            numbers: numbers.to_vec(),
        }
    }

    #[test]
    fn the_range_is_told_exactly_and_odd_values_too() {
        let values = values(1, &[0.25, 2.0, f64::NAN, -1.5]);
        assert_eq!(notes(&values), ["values -1.5 to 2, 1 not finite"]);
        let picture = scalars(&values, "x");
        let at = |x: usize| picture.pixels[x + (picture.size[0] as usize - 4) / 2];
        assert_eq!(at(2), [255, 0, 255, 255]);
        assert_eq!(at(3)[..3], heat(0.0));
        assert_eq!(at(1)[..3], heat(1.0));
    }

    #[test]
    fn labels_are_short() {
        let scale = scale(&Extent::of([0.1, 0.7].into_iter()));
        let texts: Vec<&str> = scale.iter().map(|(_, t)| t.as_str()).collect();
        assert_eq!(texts, ["0.1", "0.25", "0.4", "0.55", "0.7"]);
        assert!(super::scale(&Extent::of([3.0].into_iter())).is_empty());
    }
}
