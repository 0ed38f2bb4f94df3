//! A laid-out plot as pixels.

use super::layout::{Anchor, Item, Layout, TEXT_SCALE, text_width};
use crate::draw::{Canvas, Picture, Stroke};

/// Lengths of dash and gap in pixels, as in the SVG.
pub(super) const DASH: [f32; 2] = [8.0, 6.0];

/// Width of the outlines of markers in pixels, as in the SVG.
pub(super) const MARKER_STROKE: f32 = 2.0;

pub(super) fn draw(layout: &Layout) -> Picture {
    let mut canvas = Canvas::new(layout.size, layout.paper);
    for item in &layout.items {
        put(&mut canvas, item, layout.ink);
    }
    canvas.into_picture()
}

fn put(canvas: &mut Canvas, item: &Item, ink: [u8; 3]) {
    match item {
        Item::Line {
            points,
            colour,
            width,
            dashed,
        } => {
            let stroke = Stroke {
                colour: *colour,
                opacity: 1.0,
                width: *width,
            };
            match dashed {
                false => canvas.line(points, false, stroke),
                true => dashes(points)
                    .iter()
                    .for_each(|d| canvas.line(d, false, stroke)),
            }
        }
        Item::Dot { at, radius, colour } => canvas.fill(&circle(*at, *radius), *colour, 1.0),
        Item::Marker {
            outline,
            fill,
            colour,
            ..
        } => {
            canvas.fill(outline, *fill, 1.0);
            let stroke = Stroke {
                colour: *colour,
                opacity: 1.0,
                width: MARKER_STROKE,
            };
            canvas.line(outline, true, stroke);
        }
        Item::Bar { at, size, colour } => canvas.fill_rect(*at, *size, *colour),
        Item::Text { at, anchor, text } => {
            let shift = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5 * text_width(text),
                Anchor::End => text_width(text),
            };
            let at = [at[0] - shift, at[1]].map(|c| c.round() as i32);
            canvas.text(at, text, ink, TEXT_SCALE);
        }
    }
}

/// A circle as a polygon of 16 corners.
fn circle(centre: [f32; 2], radius: f32) -> Vec<[f32; 2]> {
    ring(centre, &[radius; 16], 0.0)
}

/// A polygon whose corners are round `centre` at even angles, the first `turn` of a full
/// turn from the right, downwards, each as far as `radii` say.
pub(super) fn ring([x, y]: [f32; 2], radii: &[f32], turn: f64) -> Vec<[f32; 2]> {
    let corner = |(k, radius): (usize, &f32)| {
        let angle = std::f64::consts::TAU * (turn + k as f64 / radii.len() as f64);
        let (sin, cos) = (
            gnomon_raster::math::scalar::sin,
            gnomon_raster::math::scalar::cos,
        );
        [
            x + radius * cos(angle as f32),
            y + radius * sin(angle as f32),
        ]
    };
    radii.iter().enumerate().map(corner).collect()
}

/// The pieces of a dashed line; the pattern goes on round corners.
fn dashes(points: &[[f32; 2]]) -> Vec<[[f32; 2]; 2]> {
    let mut pieces = Vec::new();
    let (mut drawing, mut left) = (true, DASH[0]);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let length = ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])).sqrt();
        let along = |d: f32| [0, 1].map(|k| a[k] + (b[k] - a[k]) * d / length);
        let mut done = 0.0;
        while length - done > 1e-3 {
            let next = (done + left).min(length);
            if drawing {
                pieces.push([along(done), along(next)]);
            }
            left -= next - done;
            done = next;
            if left <= 1e-3 {
                drawing = !drawing;
                left = DASH[usize::from(!drawing)];
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_leave_gaps() {
        let line = dashes(&[[0.0, 0.0], [28.0, 0.0]]);
        assert_eq!(line, [[[0.0, 0.0], [8.0, 0.0]], [[14.0, 0.0], [22.0, 0.0]]]);
        let corner = dashes(&[[0.0, 0.0], [4.0, 0.0], [4.0, 20.0]]);
        assert_eq!(corner[1], [[4.0, 0.0], [4.0, 4.0]]);
        assert!(dashes(&[[1.0, 1.0]]).is_empty());
    }
}
