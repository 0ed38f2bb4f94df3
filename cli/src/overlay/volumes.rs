//! Sides of the shadow volumes, outlined.

use super::{Source, sides};
use crate::draw::{Canvas, Legend, Picture, Projection, Stroke, Swatch, heat};

const FRONT: [u8; 3] = [255, 170, 60];
const BACK: [u8; 3] = [90, 170, 255];

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.6);
    let projection = Projection::new(&source.scene.camera, picture.size);
    let sides = sides::of(source.scene, source.params);
    // Many sides overlap; each then says less.
    let opacity = (60.0 / sides.len().max(1) as f32).clamp(0.12, 0.8);
    for side in sides
        .iter()
        .filter(|s| !s.front)
        .chain(sides.iter().filter(|s| s.front))
    {
        let polygon = projection.polygon(side.corners());
        let colour = if side.front { FRONT } else { BACK };
        canvas.fill(&polygon, colour, opacity * 0.15);
        canvas.line(
            &polygon,
            true,
            Stroke {
                colour,
                opacity,
                width: 1.0,
            },
        );
    }
    let front = sides.iter().filter(|s| s.front).count();
    let legend = Legend {
        title: "Sides of the shadow volumes, from each silhouette edge to infinity".to_owned(),
        swatches: vec![
            Swatch::new(
                FRONT,
                format!("front faces: {front}, the view enters the shadow"),
            ),
            Swatch::new(
                BACK,
                format!("back faces: {}, it leaves", sides.len() - front),
            ),
        ],
        ..Legend::default()
    };
    legend.below(canvas, heat)
}
