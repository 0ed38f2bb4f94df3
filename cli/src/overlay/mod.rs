//! Pictures that explain a render, one file each.

mod artefacts;
mod carries;
mod env_lights;
mod kind;
mod overdraw;
mod overlap;
mod recorded;
mod saturation;
mod sides;
mod silhouette;
mod stencil;
mod sums;
mod traffic;
mod volumes;
mod wedges;

use gnomon_pipeline::measure::carries::Carries;
use gnomon_pipeline::measure::heat::{Heat, PassWork};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::{Params, SceneWedges};
use gnomon_pipeline::world::scene::Scene;

use crate::draw::Picture;
pub(crate) use kind::OverlayKind;
pub(crate) use recorded::{Explained, Recorded};
pub(crate) use sums::each_pixel;

/// What overlays are drawn from.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) params: &'a Params,
    pub(crate) done: &'a Rendered,
    /// Recorded only where [`needs_heat`] says so.
    pub(crate) heat: Option<&'a Heat>,
    /// Recorded only where they are drawn.
    pub(crate) carries: Option<&'a Carries>,
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
fn needs_heat(kind: OverlayKind) -> bool {
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
        OverlayKind::Overlap => overlap::draw(source),
        OverlayKind::Saturation => saturation::draw(source),
        OverlayKind::Artefacts => artefacts::draw(source),
        OverlayKind::Carries => carries::draw(source),
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
