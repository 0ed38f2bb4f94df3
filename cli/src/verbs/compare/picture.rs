//! The picture: the truth and each technique, shaded; below, the truth's
//! visibility and each technique's signed error.

use super::job::CompareJob;
use super::measure::{Comparison, Measured};
use crate::draw::diverging::{self, diverging, place};
use crate::draw::{Canvas, Cell, Grid, Legend, Picture, Swatch};
use crate::output::numbers::{self, error};
use crate::output::tables;
use crate::overlay;

/// Where no surface is seen.
pub(super) const NOTHING: [u8; 3] = [58, 60, 66];
/// Where truth and picture may see different surfaces, and were not compared.
pub(super) const OTHER: [u8; 3] = [165, 165, 165];

/// Draws the comparison.
pub(super) fn draw(job: &CompareJob, found: &Comparison) -> Picture {
    let mut cells = vec![truth(job, found)];
    cells.extend(found.measured.iter().map(technique));
    let grid = Grid::new(cells);
    let legend = Legend {
        text_scale: Some(grid.text_scale()),
        ..make_legend(found)
    };
    legend.below(grid.draw(), diverging)
}

fn truth(job: &CompareJob, found: &Comparison) -> Cell {
    let size = job.settings.size;
    let mut pictures = Vec::new();
    if let Some((_, shaded)) = found.shaded.first() {
        let pixels = shaded.iter().map(|&[r, g, b, _]| [r, g, b, 255]);
        pictures.push(Canvas::showing(&Picture {
            size,
            pixels: pixels.collect(),
        }));
    }
    let values = &found.reference.image.values;
    pictures.push(painted(size, values.iter().map(|v| grey(*v))));
    let kind = found.reference.kind.name();
    Cell {
        name: format!("truth ({kind})"),
        notes: vec!["below: visibility".to_owned()],
        pictures,
    }
}

fn technique(measured: &Measured) -> Cell {
    let Measured {
        label, done, under, ..
    } = measured;
    let figure = |f: fn(gnomon_pipeline::truth::metrics::visibility::ErrorSummary) -> f64| {
        measured
            .score
            .visibility
            .all
            .map_or("-".to_owned(), |e| error(f(e)))
    };
    let bytes = numbers::bytes(tables::frame_bytes(&done.report));
    let pixels = done.visibility.iter().zip(&under.truth.values);
    let colours = pixels.map(|(value, truth)| signed(f64::from(*value), *truth));
    Cell {
        name: label.clone(),
        notes: vec![format!(
            "RMSE {}  max {}  {bytes}",
            figure(|e| e.rmse),
            figure(|e| e.max)
        )],
        pictures: vec![
            Canvas::showing(&overlay::picture(done)),
            painted(done.size, colours),
        ],
    }
}

/// Colour of an error; `truth` is NaN where there is none.
pub(super) fn signed(value: f64, truth: f64) -> [u8; 3] {
    match (value.is_nan(), truth.is_nan()) {
        (true, true) => NOTHING,
        (false, false) => diverging(place(value - truth)),
        _ => OTHER,
    }
}

pub(super) fn grey(visibility: f64) -> [u8; 3] {
    if visibility.is_nan() {
        return NOTHING;
    }
    [(visibility * 255.0).round() as u8; 3]
}

pub(super) fn painted(size: [u32; 2], colours: impl Iterator<Item = [u8; 3]>) -> Canvas {
    Canvas::showing(&Picture {
        size,
        pixels: colours.map(|[r, g, b]| [r, g, b, 255]).collect(),
    })
}

fn make_legend(found: &Comparison) -> Legend {
    let other = |m: &Measured| m.score.pixels.left_out.other_surface();
    let largest = found.measured.iter().map(other).max();
    let left_out = largest.unwrap_or(0);
    Legend {
        title: "Visibility minus truth: blue is too dark, orange too bright".to_owned(),
        scale: diverging::labels(),
        swatches: vec![
            Swatch::new(NOTHING, "no surface"),
            Swatch::new(
                OTHER,
                format!("left out: {left_out} pixels, at edges or of another surface"),
            ),
        ],
        notes: vec![format!(
            "Logarithmic from {} on, which is neutral; the same scale in every comparison",
            diverging::LEAST
        )],
        ..Legend::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_errors_from_what_was_not_compared() {
        let nan = f64::NAN;
        assert_eq!(
            (signed(nan, nan), signed(0.4, nan), signed(nan, 0.4)),
            (NOTHING, OTHER, OTHER)
        );
        assert_eq!(signed(0.4, 0.4), diverging(0.5));
        let [dark, bright] = [signed(0.0, 0.9), signed(0.9, 0.0)];
        assert!(dark[2] > dark[0] && bright[0] > bright[2]);
        assert_eq!(
            (grey(0.0), grey(1.0), grey(nan)),
            ([0; 3], [255; 3], NOTHING)
        );
    }
}
