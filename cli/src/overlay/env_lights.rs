//! The environment's map as a cross of cube faces, with the fitted lights
//! outlined (Annen et al. 2008, figures 6 and 10).

use gnomon_pipeline::measure::render::SrgbEncoder;
use gnomon_pipeline::world::environment::PlacedEnvironment;
use gnomon_pipeline::world::environment::cube::{self, luminance};

use super::Source;
use crate::draw::{Canvas, Legend, Picture, Stroke, Swatch, heat};

const LIGHT: [u8; 3] = [60, 230, 90];
const BRIGHTEST: [u8; 3] = [255, 80, 60];
const NOTHING: [u8; 3] = [24, 26, 30];
/// Lights that are told apart.
const FIRST: usize = 4;
/// Least pixels along a face.
const FACE: usize = 192;
/// Column and row of each face: -x, +z, +x, -z round the middle, +y above and -y
/// below +z.
const PLACES: [[usize; 2]; 6] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
/// The median radiance is shown at this, of 1.
const MEDIAN: f64 = 0.22;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let Some(placed) = &source.scene.environment else {
        return source.picture(); // refused before
    };
    let side = placed.map.cube.side();
    let scale = FACE.div_ceil(side);
    let mut canvas = Canvas::showing(&cross(placed, scale));
    let place = |face: usize, k: [usize; 2]| {
        [0, 1].map(|a| ((PLACES[face][a] * side + k[a]) * scale) as f32)
    };
    for (number, light) in placed.fit.lights.iter().enumerate().rev() {
        let [low, high] = [light.low, light.high].map(|k| place(light.face, k));
        // Inside its texels, so that neighbours stay apart.
        let [low, high] = [low.map(|c| c + 1.0), high.map(|c| c - 1.0)];
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let colour = if number < FIRST { BRIGHTEST } else { LIGHT };
        let stroke = Stroke {
            colour,
            opacity: 1.0,
            width: 1.6,
        };
        canvas.line(&corners, true, stroke);
    }
    make_legend(placed).below(canvas, heat)
}

fn make_legend(placed: &PlacedEnvironment) -> Legend {
    let (map, fit) = (&placed.map, &placed.fit);
    let total = luminance(map.cube.total()) as f64;
    let share = |energy| 100.0 * luminance(energy) as f64 / total;
    let first: f64 = fit.lights.iter().take(FIRST).map(|l| share(l.energy)).sum();
    let few = FIRST.min(fit.lights.len());
    Legend {
        title: format!("{} area lights fitted to {}", fit.lights.len(), map.name),
        swatches: vec![
            Swatch::new(LIGHT, "light"),
            Swatch::new(
                BRIGHTEST,
                format!("the {few} brightest: {first:.1}% of the energy"),
            ),
        ],
        notes: vec![format!(
            "threshold {:.4}; ambient light (residual): {:.2}% of the energy; faces of {side}x{side} texels, -x +z +x -z from left to right, +y above, -y below",
            fit.threshold,
            share(fit.residual_energy()),
            side = map.cube.side(),
        )],
        ..Legend::default()
    }
}

/// All faces, each texel `scale` pixels wide.
fn cross(placed: &PlacedEnvironment, scale: usize) -> Picture {
    let map = &placed.map.cube;
    let side = map.side();
    let radiance: Vec<[f64; 3]> = map.radiance().collect();
    let exposure = MEDIAN / median(&radiance);
    let encoder = SrgbEncoder::new();
    // Bright texels keep their hue: the largest channel is rolled off.
    let shown = |rgb: [f64; 3]| {
        let scaled = rgb.map(|v| v * exposure);
        let most = scaled.iter().copied().fold(0.0, f64::max);
        let [r, g, b] = scaled.map(|v| (v * 1.25 / (1.0 + most)) as f32);
        encoder.encode([r, g, b, 1.0])
    };
    let (width, height) = (4 * side * scale, 3 * side * scale);
    let [r, g, b] = NOTHING;
    let mut pixels = vec![[r, g, b, 255]; width * height];
    for (i, rgb) in radiance.iter().enumerate() {
        let colour = shown(*rgb);
        let [column, row] = PLACES[i / (side * side)];
        let at = [column * side + i % side, row * side + i / side % side];
        for y in at[1] * scale..(at[1] + 1) * scale {
            let first = y * width + at[0] * scale;
            pixels[first..first + scale].fill(colour);
        }
    }
    Picture {
        size: [width as u32, height as u32],
        pixels,
    }
}

/// Median of the largest channels, above 0.
fn median(radiance: &[[f64; 3]]) -> f64 {
    let largest = radiance
        .iter()
        .map(|rgb| rgb.iter().copied().fold(0.0, f64::max));
    let mut largest: Vec<f64> = largest.filter(|v| *v > 0.0).collect();
    largest.sort_by(f64::total_cmp);
    largest.get(largest.len() / 2).copied().unwrap_or(1.0)
}

const _: () = assert!(cube::FACES == PLACES.len());
