//! Silhouette edges of the casters as the lights see them.

use super::Source;
use super::sides::{self, Side};
use crate::draw::{Canvas, Legend, Picture, Pixel, Projection, Stroke, Swatch, heat};

const FRONT: [u8; 3] = [255, 190, 70];
const BACK: [u8; 3] = [90, 190, 255];
/// An edge this much further away than what is drawn is hidden, relatively.
const BEHIND: f64 = 0.012;
/// Pixels between two looks at the depth buffer.
const STEP: f32 = 1.5;
/// Shortest edge that gets an arrow head, pixels.
const ARROW_FROM: f32 = 16.0;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.6);
    let projection = Projection::new(&source.scene.camera, picture.size);
    let sides = sides::of(source.scene, source.params);
    let seen: Vec<(Side, [Pixel; 2])> = sides
        .iter()
        .filter_map(|s| projection.segment(s.edge).map(|e| (*s, e)))
        .collect();
    for (side, ends) in &seen {
        let faint = Stroke {
            colour: colour(side),
            opacity: 0.28,
            width: 1.0,
        };
        canvas.line(&ends.map(|e| e.at), false, faint);
    }
    let depth = DepthBuffer {
        size: picture.size,
        depth: &source.done.depth,
    };
    for (side, ends) in &seen {
        draw_visible(&mut canvas, &depth, side, ends);
    }
    make_legend(&sides).below(canvas, heat)
}

fn colour(side: &Side) -> [u8; 3] {
    if side.front { FRONT } else { BACK }
}

fn make_legend(sides: &[Side]) -> Legend {
    let front = sides.iter().filter(|s| s.front).count();
    Legend {
        title: format!("Silhouette seen from the light: {} edges", sides.len()),
        swatches: vec![
            Swatch::new(FRONT, format!("side faces the eye: {front}")),
            Swatch::new(BACK, format!("side faces away: {}", sides.len() - front)),
        ],
        notes: vec![
            "faint: hidden by a surface; arrows: seen from the light, the caster is on their left"
                .to_owned(),
        ],
        ..Legend::default()
    }
}

/// Depths of a rendered frame.
struct DepthBuffer<'a> {
    size: [u32; 2],
    depth: &'a [f32],
}

impl DepthBuffer<'_> {
    /// Whether a point at `depth` is not behind what is drawn round `at`. With an
    /// infinite far plane, 1 - depth is proportional to 1 / distance.
    fn shows(&self, at: [f32; 2], depth: f64) -> bool {
        let nearest_allowed = self.farthest_round(at);
        1.0 - depth >= (1.0 - nearest_allowed) * (1.0 - BEHIND)
    }

    /// Greatest depth of the 3x3 pixels round a point: an edge of a caster lies
    /// on the rim of its own surface.
    fn farthest_round(&self, at: [f32; 2]) -> f64 {
        let mut farthest = 0.0f32;
        for dy in -1..=1 {
            for dx in -1..=1 {
                let (x, y) = (at[0].floor() as i64 + dx, at[1].floor() as i64 + dy);
                let [w, h] = self.size.map(i64::from);
                if (0..w).contains(&x) && (0..h).contains(&y) {
                    farthest = farthest.max(self.depth[(y * w + x) as usize]);
                }
            }
        }
        f64::from(farthest)
    }
}

/// Draws the parts of an edge that no surface hides.
fn draw_visible(canvas: &mut Canvas, depth: &DepthBuffer<'_>, side: &Side, ends: &[Pixel; 2]) {
    let stroke = Stroke {
        colour: colour(side),
        opacity: 1.0,
        width: 1.8,
    };
    let length = distance(ends[0].at, ends[1].at);
    let steps = (length / STEP).ceil().clamp(1.0, 4096.0) as u32;
    let at = |t: f32| {
        let mix = |i: usize| ends[0].at[i] + t * (ends[1].at[i] - ends[0].at[i]);
        let z = ends[0].depth + f64::from(t) * (ends[1].depth - ends[0].depth);
        ([mix(0), mix(1)], z)
    };
    let shown = |i: u32| {
        let (p, z) = at((i as f32 + 0.5) / steps as f32);
        depth.shows(p, z)
    };
    let mut start = None;
    for i in 0..=steps {
        let visible = i < steps && shown(i);
        match (visible, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                let [a, b] = [from, i].map(|k| at(k as f32 / steps as f32).0);
                canvas.line(&[a, b], false, stroke);
                start = None;
            }
            _ => {}
        }
    }
    if length >= ARROW_FROM && shown(steps / 2) {
        arrow(canvas, ends, length, stroke);
    }
}

fn arrow(canvas: &mut Canvas, ends: &[Pixel; 2], length: f32, stroke: Stroke) {
    let along = [0, 1].map(|i| (ends[1].at[i] - ends[0].at[i]) / length);
    let tip = [0, 1].map(|i| (ends[0].at[i] + ends[1].at[i]) / 2.0 + 4.0 * along[i]);
    let wing = |side: f32| {
        [
            tip[0] - 7.0 * along[0] - side * 4.0 * along[1],
            tip[1] - 7.0 * along[1] + side * 4.0 * along[0],
        ]
    };
    canvas.fill(&[tip, wing(1.0), wing(-1.0)], stroke.colour, 1.0);
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_behind_a_surface_are_hidden() {
        let buffer = DepthBuffer {
            size: [3, 3],
            depth: &[0.9; 9],
        };
        assert!(buffer.shows([1.5, 1.5], 0.9));
        assert!(buffer.shows([1.5, 1.5], 0.5));
        assert!(!buffer.shows([1.5, 1.5], 0.95));
        assert!(!buffer.shows([-9.0, 1.5], 0.5), "outside the picture");
    }
}
