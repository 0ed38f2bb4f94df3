//! Fragments generated at each pixel.

use super::{Source, name_passes_left_out};
use crate::draw::heat_scale::{place, scale_labels, scale_top};
use crate::draw::{Canvas, Legend, Picture, heat};
use crate::output::numbers;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.35);
    let Some(recorded) = source.heat else {
        return canvas.into_picture();
    };
    let counts = recorded.sum(|_| true).overdraw;
    let top = scale_top(counts.iter().map(|c| u64::from(*c)));
    let width = picture.size[0] as usize;
    for (i, &n) in counts.iter().enumerate().filter(|(_, n)| **n > 0) {
        let at = [(i % width) as u32, (i / width) as u32];
        canvas.mix(at, heat(place(u64::from(n), top)), 0.85);
    }
    let max = u64::from(counts.iter().copied().max().unwrap_or(0));
    let sum: u64 = counts.iter().map(|c| u64::from(*c)).sum();
    let passes: Vec<&str> = recorded.passes.iter().map(|p| p.label.as_str()).collect();
    let shown = format!(
        "mean {:.2}, max {max}; passes: {}",
        sum as f64 / counts.len().max(1) as f64,
        passes.join(", ")
    );
    let left_out = name_passes_left_out(recorded, |p| p.fragments, numbers::count);
    let legend = Legend {
        title: "Overdraw: fragments generated per pixel, before any test".to_owned(),
        scale: scale_labels(top, max, |n| n.to_string()),
        notes: std::iter::once(shown).chain(left_out).collect(),
        ..Legend::default()
    };
    legend.below(canvas, heat)
}
