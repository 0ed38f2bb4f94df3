//! Values left in the stencil, signed around the wrap.

use super::Source;
use crate::draw::{Canvas, Legend, Picture, Swatch, heat};
use crate::output::numbers;

/// Most swatches of the legend.
const SHOWN: usize = 14;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let mut canvas = Canvas::dimmed(&picture, 0.55);
    let mut pixels = [0u64; 256];
    let width = picture.size[0] as usize;
    for (i, &value) in source.done.stencil.iter().enumerate() {
        pixels[usize::from(value)] += 1;
        if value != 0 {
            let at = [(i % width) as u32, (i / width) as u32];
            canvas.mix(at, colour(value as i8), 0.8);
        }
    }
    let legend = Legend {
        title: "Stencil at the end of the frame: 0 is lit, as rendered (dimmed)".to_owned(),
        swatches: swatches(&pixels),
        notes: notes(&pixels),
        ..Legend::default()
    };
    legend.below(canvas, heat)
}

fn colour(value: i8) -> [u8; 3] {
    const COUNTS: [[u8; 3]; 8] = [
        [230, 159, 0],
        [86, 180, 233],
        [0, 158, 115],
        [240, 228, 66],
        [0, 96, 190],
        [204, 121, 167],
        [160, 82, 30],
        [235, 235, 235],
    ];
    match value {
        // Eight colours over and over, a little paler each time.
        1.. => {
            let i = value as usize - 1;
            let pale = (i / COUNTS.len()) as f32 / 20.0;
            COUNTS[i % COUNTS.len()]
                .map(|c| (f32::from(c) * (1.0 - pale) + 255.0 * pale).round() as u8)
        }
        // Miscounts of z-pass: they should leap to the eye.
        _ => [255, (-(i16::from(value) + 1)).min(15) as u8 * 10, 90],
    }
}

/// Values that occur, in signed order, zero left out.
fn present(pixels: &[u64; 256]) -> Vec<i8> {
    (i8::MIN..=i8::MAX)
        .filter(|v| *v != 0 && pixels[usize::from(*v as u8)] > 0)
        .collect()
}

fn swatches(pixels: &[u64; 256]) -> Vec<Swatch> {
    let total = pixels.iter().sum();
    let count = |v: i8| pixels[usize::from(v as u8)];
    let mut shown = present(pixels);
    shown.sort_by_key(|v| std::cmp::Reverse(count(*v)));
    shown.truncate(SHOWN);
    shown.sort_unstable();
    let swatch = |v: i8| {
        Swatch::new(
            colour(v),
            format!("{v}: {}", numbers::percent(count(v), total)),
        )
    };
    shown.into_iter().map(swatch).collect()
}

fn notes(pixels: &[u64; 256]) -> Vec<String> {
    let values = present(pixels);
    let mut notes = Vec::new();
    if values.is_empty() {
        notes.push("every pixel is 0".to_owned());
    }
    if let [first, .., last] = values[..]
        && values.len() > SHOWN
    {
        let rarer = values.len() - SHOWN;
        notes.push(format!(
            "and {rarer} rarer values; all are between {first} and {last}"
        ));
    }
    if values.iter().any(|v| *v < 0) {
        notes.push("129 to 255 are shown as -127 to -1: counts wrap modulo 256".to_owned());
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_values_differ_in_colour() {
        for v in i8::MIN..i8::MAX {
            assert!(
                v == 0 || v + 1 == 0 || v < -16 || colour(v) != colour(v + 1),
                "{v}"
            );
        }
    }

    #[test]
    fn only_values_that_occur_are_named() {
        let mut pixels = [0; 256];
        (pixels[0], pixels[3], pixels[255]) = (2, 1, 1);
        let labels: Vec<String> = swatches(&pixels).into_iter().map(|s| s.label).collect();
        assert_eq!(labels, ["-1: 25%", "3: 25%"]);
        assert_eq!(notes(&pixels).len(), 1);
    }
}
