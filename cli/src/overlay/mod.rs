//! Pictures that explain a render, one file each.

mod env_lights;
mod kind;
mod overdraw;
mod sides;
mod silhouette;
mod stencil;
mod traffic;
mod volumes;
mod wedges;

use gnomon_pipeline::measure::heat::{Heat, PassWork};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{Params, SceneWedges};
use gnomon_pipeline::world::scene::Scene;

use crate::draw::Picture;
pub(crate) use kind::OverlayKind;

/// What overlays are drawn from.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) params: &'a Params,
    pub(crate) done: &'a Rendered,
    /// Recorded only where [`needs_heat`] says so.
    pub(crate) heat: Option<&'a Heat>,
    /// Built only where they are drawn.
    pub(crate) wedges: Option<&'a SceneWedges>,
}

impl Source<'_> {
    /// The rendered picture, made opaque.
    pub(crate) fn picture(&self) -> Picture {
        picture(self.done)
    }
}

/// A rendered frame as an opaque picture.
pub(crate) fn picture(done: &Rendered) -> Picture {
    let pixels = done.srgb.iter().map(|&[r, g, b, _]| [r, g, b, 255]);
    Picture {
        size: done.size,
        pixels: pixels.collect(),
    }
}

/// Whether an overlay needs accesses to be recorded.
pub(crate) fn needs_heat(kind: OverlayKind) -> bool {
    matches!(kind, OverlayKind::Overdraw | OverlayKind::Traffic)
}

/// Draws an overlay.
pub(crate) fn draw(kind: OverlayKind, source: &Source<'_>) -> Picture {
    match kind {
        OverlayKind::Overdraw => overdraw::draw(source),
        OverlayKind::Stencil => stencil::draw(source),
        OverlayKind::Traffic => traffic::draw(source),
        OverlayKind::Silhouette => silhouette::draw(source),
        OverlayKind::Volumes => volumes::draw(source),
        OverlayKind::Wedges => wedges::draw(source),
        OverlayKind::EnvLights => env_lights::draw(source),
    }
}

/// Passes that have no place in the picture, with their work in total; `None` where
/// all have one.
fn name_passes_left_out(
    heat: &Heat,
    work: fn(&PassWork) -> u64,
    show: fn(u64) -> String,
) -> Option<String> {
    let mut labels: Vec<&str> = Vec::new();
    for pass in &heat.elsewhere {
        if !labels.contains(&pass.label.as_str()) {
            labels.push(&pass.label);
        }
    }
    let (named, more) = labels.split_at(labels.len().min(MOST_LABELS));
    let more = match more.len() {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    let sum = heat.elsewhere.iter().map(work).sum();
    (!named.is_empty()).then(|| {
        format!(
            "left out, being no pixels of the picture: {}{more} ({})",
            named.join(", "),
            show(sum)
        )
    })
}

/// Labels that a legend names.
const MOST_LABELS: usize = 6;

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
    fn what_is_left_out_is_named_and_summed() {
        let pass = |number: usize, label: String| PassWork {
            number,
            label,
            fragments: 1,
            bytes: Default::default(),
        };
        let mut heat = Heat {
            size: [1, 1],
            blocks: [1, 1],
            passes: Vec::new(),
            elsewhere: Vec::new(),
        };
        let told = |heat: &Heat| name_passes_left_out(heat, |p| p.fragments, |n| n.to_string());
        assert_eq!(told(&heat), None);
        let labels = (0..16).map(|k| format!("view {}", k % 8));
        heat.elsewhere = labels.enumerate().map(|(k, l)| pass(k, l)).collect();
        let text = told(&heat).unwrap();
        assert!(text.contains("view 5 and 2 more (16)"), "{text}");
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
