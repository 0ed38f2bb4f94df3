//! Ranges, ticks and their labels.

use gnomon_claims::chart::Scale;

/// An axis with a range that holds all values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Range {
    scale: Scale,
    /// Ends, transformed: logarithms on logarithmic axes.
    ends: [f64; 2],
    /// Values with a tick.
    pub(super) ticks: Vec<f64>,
}

impl Range {
    /// The axis for `values`; those that it cannot show are left out.
    pub(super) fn new(scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let places = values.filter_map(|v| transformed(scale, v));
        let found = places.fold(None, |ends: Option<[f64; 2]>, v| {
            let [low, high] = ends.unwrap_or([v, v]);
            Some([low.min(v), high.max(v)])
        });
        let [low, high] = found.unwrap_or([0.0, 1.0]);
        match scale {
            Scale::Linear => linear(low.min(0.0), high.max(0.0)),
            Scale::Log10 => decades(low, high),
            Scale::Log2 => doublings(low, high),
        }
    }

    /// Where `value` is, 0 to 1; `None` where it cannot be shown.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let [low, high] = self.ends;
        transformed(self.scale, value).map(|v| (v - low) / (high - low))
    }
}

fn transformed(scale: Scale, value: f64) -> Option<f64> {
    let out = match scale {
        Scale::Linear => value,
        Scale::Log10 => libm::log10(value),
        Scale::Log2 => libm::log2(value),
    };
    out.is_finite().then_some(out)
}

fn power_of(base: f64, exponent: i32) -> f64 {
    libm::pow(base, f64::from(exponent))
}

/// From 0 up, or down, in steps of 1, 2 or 5 times a power of ten.
fn linear(low: f64, high: f64) -> Range {
    let span = if high > low { high - low } else { 1.0 };
    let power = power_of(10.0, libm::log10(span / 6.0).floor() as i32);
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * power)
        .into_iter()
        .find(|s| span / s <= 6.5)
        .unwrap_or(span);
    let [first, last] = [(low / step).floor(), (low.max(low + span) / step).ceil()];
    let count = (last - first) as usize;
    Range {
        scale: Scale::Linear,
        ends: [first * step, last * step],
        ticks: (0..=count).map(|k| (first + k as f64) * step).collect(),
    }
}

/// Ticks that have room for their labels.
const MOST_TICKS: usize = 10;

/// A little more than the values take; ticks at decades, at 2 and 5 times where there
/// are few, at every few of them where there are many.
fn decades(low: f64, high: f64) -> Range {
    let pad = (0.05 * (high - low)).max(0.05);
    let ends = [low - pad, high + pad];
    let inside = |t: &f64| (ends[0]..=ends[1]).contains(&libm::log10(*t));
    let powers = ends[0].floor() as i32..=ends[1].ceil() as i32;
    let with = |factors: &[f64]| -> Vec<f64> {
        let of = |p: i32| factors.iter().map(move |f| f * power_of(10.0, p));
        powers.clone().flat_map(of).filter(inside).collect()
    };
    let whole = with(&[1.0]);
    let ticks = match whole.len() {
        0..=1 => with(&[1.0, 2.0, 3.0, 4.0, 6.0, 8.0]),
        2..=3 => with(&[1.0, 2.0, 5.0]),
        4..=MOST_TICKS => whole,
        count => {
            let step = count.div_ceil(MOST_TICKS) as i32;
            let shown = powers.clone().filter(|p| p.rem_euclid(step) == 0);
            let values = shown.map(|p| power_of(10.0, p));
            values.filter(inside).collect()
        }
    };
    Range {
        scale: Scale::Log10,
        ends,
        ticks,
    }
}

fn doublings(low: f64, high: f64) -> Range {
    let powers = low.floor() as i32..=high.ceil() as i32;
    let ends = [low - 0.2, high + 0.2];
    let shown = powers.filter(|p| (ends[0]..=ends[1]).contains(&f64::from(*p)));
    Range {
        scale: Scale::Log2,
        ends,
        ticks: shown.map(|p| power_of(2.0, p)).collect(),
    }
}

/// A tick's value in few characters.
pub(super) fn tick_label(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&size) {
        let power = (libm::log10(size) + 1e-9).floor() as i32;
        let digit = trimmed(value / power_of(10.0, power), 2);
        return format!("{digit}e{power}");
    }
    let digits = (3 - (libm::log10(size) + 1e-9).floor() as i32).clamp(0, 5) as usize;
    trimmed(value, digits)
}

fn trimmed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_axes_start_at_zero() {
        let range = Range::new(Scale::Linear, [3.0, 47.0].into_iter());
        assert_eq!(range.ticks, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]);
        assert_eq!(
            (range.place(0.0), range.place(25.0)),
            (Some(0.0), Some(0.5))
        );
        assert_eq!(
            Range::new(Scale::Linear, std::iter::empty()).place(f64::NAN),
            None
        );
        let below = Range::new(Scale::Linear, [-3.0, 1.0].into_iter());
        assert!(below.ticks[0] <= -3.0 && below.ticks.contains(&0.0));
        let nothing = Range::new(Scale::Linear, [0.0].into_iter());
        assert!(nothing.ticks.len() >= 2 && nothing.place(0.0) == Some(0.0));
    }

    #[test]
    fn logarithmic_axes_leave_out_what_is_not_positive() {
        let range = Range::new(Scale::Log10, [0.0, -1.0, 1.0, 1e4].into_iter());
        assert_eq!(range.ticks, [1.0, 10.0, 100.0, 1000.0, 10000.0]);
        assert_eq!((range.place(0.0), range.place(-1.0)), (None, None));
        let (a, b) = (range.place(10.0).unwrap(), range.place(1000.0).unwrap());
        assert!((a + b - 1.0).abs() < 1e-12 && a > 0.0);
        let close = Range::new(Scale::Log10, [0.011, 0.042].into_iter());
        assert!(close.ticks.len() >= 3, "{:?}", close.ticks);
        let far = Range::new(Scale::Log10, [1e-15, 1e16].into_iter());
        assert_eq!(far.ticks.len(), 9, "{:?}", far.ticks); // every fourth decade of 34
        assert!(far.ticks.contains(&1.0) && far.ticks.contains(&1e-12));
        let one = Range::new(Scale::Log10, [5.0].into_iter());
        assert!((one.place(5.0).unwrap() - 0.5).abs() < 1e-12);
        let twos = Range::new(Scale::Log2, [2.0, 16.0].into_iter());
        assert_eq!(twos.ticks, [2.0, 4.0, 8.0, 16.0]);
    }

    #[test]
    fn labels_are_short() {
        let labels = [0.0, 0.5, 250.0, 1000.0, 1e6, 2e-5, 0.001, -0.25, 99_999.0].map(tick_label);
        let expected = [
            "0", "0.5", "250", "1000", "1e6", "2e-5", "0.001", "-0.25", "99999",
        ];
        assert_eq!(labels, expected);
    }
}
