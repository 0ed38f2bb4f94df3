//! Where the sum of soft shadow volumes leaves 0..1 and is clamped.

use super::Source;
use super::sums::{Sums, each_pixel};
use crate::draw::{Canvas, Legend, Picture, diverging};

/// Less is rounding.
const LEAST: f64 = 1e-9;

pub(super) fn draw(source: &Source<'_>) -> Picture {
    let picture = source.picture();
    let sums = Sums::new(source.scene);
    let most = each_pixel(source.scene, picture.size, |p| {
        let of_lights = sums.seen_from(p).map(|light| light.saturation());
        of_lights.fold(
            0.0,
            |most: f64, s| if s.abs() > most.abs() { s } else { most },
        )
    });
    let mut canvas = Canvas::dimmed(&picture, 0.45);
    let width = picture.size[0] as usize;
    let mut found = Found::default();
    for (i, value) in most.iter().enumerate() {
        let Some(value) = value.filter(|v| v.abs() > LEAST) else {
            continue;
        };
        found.add(value);
        let at = [(i % width) as u32, (i / width) as u32];
        canvas.mix(at, diverging::diverging(diverging::place(value)), 0.9);
    }
    let mut notes = vec![found.text()];
    notes.extend(sums.notes());
    let legend = Legend {
        title: "Saturation: by how much the papers' sum leaves 0..1 before it is clamped"
            .to_owned(),
        scale: diverging::labels(),
        notes,
        ..Legend::default()
    };
    legend.below(canvas, diverging::diverging)
}

#[derive(Default)]
struct Found {
    below: usize,
    lowest: f64,
    above: usize,
    highest: f64,
}

impl Found {
    fn add(&mut self, value: f64) {
        if value < 0.0 {
            self.below += 1;
            self.lowest = self.lowest.min(value);
        } else {
            self.above += 1;
            self.highest = self.highest.max(value);
        }
    }

    fn text(&self) -> String {
        format!(
            "below 0 at {} pixels, down to {:.6}; above 1 at {}, by up to {:.6}",
            self.below, self.lowest, self.above, self.highest
        )
    }
}
