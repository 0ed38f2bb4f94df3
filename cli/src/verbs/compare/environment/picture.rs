//! The picture: the reference and each technique; below each technique its signed
//! error of luminance.

use gnomon_pipeline::measure::comparison::EnvironmentReference;

use super::MeasuredLight;
use crate::draw::diverging::{self, diverging, place};
use crate::draw::{Canvas, Cell, Grid, Legend, Picture, Swatch};
use crate::output::numbers::{self, error};
use crate::overlay;

/// Where nothing was compared.
const LEFT_OUT: [u8; 3] = [58, 60, 66];

pub(super) fn draw(reference: &EnvironmentReference, measured: &[MeasuredLight<'_>]) -> Picture {
    let truth = Cell {
        name: format!("reference ({} directions)", reference.directions),
        notes: Vec::new(),
        pictures: vec![Canvas::showing(&Picture {
            size: reference.size,
            pixels: reference.srgb.clone(),
        })],
    };
    let cells = std::iter::once(truth).chain(measured.iter().map(cell));
    let grid = Grid::new(cells.collect());
    let legend = Legend {
        title: "Luminance minus the reference: blue is too dark, orange too bright".to_owned(),
        scale: diverging::labels(),
        swatches: vec![Swatch::new(
            LEFT_OUT,
            "no surface, outlines and sharp edges: left out",
        )],
        text_scale: Some(grid.text_scale()),
        ..Legend::default()
    };
    legend.below(grid.draw(), diverging)
}

fn cell(m: &MeasuredLight<'_>) -> Cell {
    let colour = |v: &f64| {
        let [r, g, b] = if v.is_nan() {
            LEFT_OUT
        } else {
            diverging(place(*v))
        };
        [r, g, b, 255]
    };
    let difference = Picture {
        size: m.done.size,
        pixels: m.difference.iter().map(colour).collect(),
    };
    Cell {
        name: m.label.clone(),
        notes: vec![format!(
            "RMSE {}  FLIP {}  {}",
            error(m.score.rmse),
            error(m.score.flip),
            numbers::milliseconds(m.done.frame_ms)
        )],
        pictures: vec![
            Canvas::showing(&overlay::picture(&m.done)),
            Canvas::showing(&difference),
        ],
    }
}
