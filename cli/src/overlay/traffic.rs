//! Bytes read and written in each 8x8 block.

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
    let blocks = recorded.sum(|_| true).bytes;
    let totals: Vec<u64> = blocks.iter().map(|b| b.total()).collect();
    let top = scale_top(totals.iter().copied());
    let [width, height] = picture.size;
    for y in 0..height {
        for x in 0..width {
            let bytes = totals[(y / 8 * recorded.blocks[0] + x / 8) as usize];
            if bytes > 0 {
                canvas.mix([x, y], heat(place(bytes, top)), 0.8);
            }
        }
    }
    let sum = |client: fn(&gnomon_pipeline::measure::heat::BlockBytes) -> u64| {
        numbers::bytes(blocks.iter().map(client).sum())
    };
    let shown = format!(
        "z {}, stencil {}, color {}, hiz {}; vertices, textures and clears left out",
        sum(|b| b.z),
        sum(|b| b.stencil),
        sum(|b| b.color),
        sum(|b| b.hiz)
    );
    let left_out = name_passes_left_out(recorded, |p| p.bytes.total(), numbers::bytes);
    let legend = Legend {
        title: "Traffic: logical bytes read and written per 8x8 block".to_owned(),
        scale: scale_labels(
            top,
            totals.iter().copied().max().unwrap_or(0),
            numbers::bytes,
        ),
        notes: std::iter::once(shown).chain(left_out).collect(),
        ..Legend::default()
    };
    legend.below(canvas, heat)
}
