//! How many edges cut a light, seen from each pixel: penumbrae that overlap.

use super::Source;
use super::sums::{Sums, each_pixel};
use crate::draw::heat_scale::{place, scale_labels, scale_top};
use crate::draw::{Canvas, Legend, Picture, heat};

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let sums = Sums::new(source.scene);
    let counts = each_pixel(source.scene, picture.size, |p| {
        let seen = sums.seen_from(p).map(|light| light.edges.len() as u64);
        seen.sum::<u64>()
    });
    let counts: Vec<u64> = counts.into_iter().map(Option::unwrap_or_default).collect();
    let mut canvas = Canvas::dimmed(&picture, 0.35);
    let top = scale_top(counts.iter().copied());
    let width = picture.size[0] as usize;
    for (i, &n) in counts.iter().enumerate().filter(|(_, n)| **n > 0) {
        let at = [(i % width) as u32, (i / width) as u32];
        canvas.mix(at, heat(place(n, top)), 0.85);
    }
    let max = counts.iter().copied().max().unwrap_or(0);
    let cut = counts.iter().filter(|n| **n > 0);
    let (pixels, sum) = cut.fold((0u64, 0u64), |(k, s), n| (k + 1, s + n));
    let mean = sum as f64 / pixels.max(1) as f64;
    let mut notes = vec![format!(
        "{pixels} pixels in penumbrae, of {mean:.2} edges in the mean, {max} at most"
    )];
    notes.extend(sums.notes());
    let legend = Legend {
        title: "Overlap: silhouette edges that cut a light, seen from each pixel".to_owned(),
        scale: scale_labels(top, max, |n| n.to_string()),
        notes,
        ..Legend::default()
    };
    legend.below(canvas, heat)
}
