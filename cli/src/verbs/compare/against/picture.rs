//! The truth, the file, and the signed difference beside each other.

use super::super::picture::{NOTHING, OTHER, grey, painted, signed};
use super::read::{Content, Theirs};
use super::score::Found;
use crate::draw::diverging::{self, diverging};
use crate::draw::{Canvas, Cell, Grid, Legend, Picture, Swatch};
use crate::output::numbers::error;

/// Draws the comparison.
pub(super) fn draw(theirs: &Theirs, found: &Found) -> Picture {
    let size = theirs.size;
    let cell = |name: &str, notes: Vec<String>, picture: Canvas| Cell {
        name: name.to_owned(),
        notes,
        pictures: vec![picture],
    };
    let figure = found.all.map_or("-".to_owned(), |e| error(e.rmse));
    let truth = found.values.iter().map(|[t, _]| grey(*t));
    let errors = found.values.iter().map(|[t, v]| signed(*v, *t));
    let grid = Grid::new(vec![
        cell("truth", vec![what(theirs)], painted(size, truth)),
        cell("the file", Vec::new(), shown(theirs)),
        cell(
            "difference",
            vec![format!("RMSE {figure}")],
            painted(size, errors),
        ),
    ]);
    let legend = Legend {
        title: "The file minus the truth: blue is too dark, orange too bright".to_owned(),
        scale: diverging::labels(),
        swatches: vec![
            Swatch::new(NOTHING, "no surface, or left out at an edge"),
            Swatch::new(OTHER, "no value in the file"),
        ],
        text_scale: Some(grid.text_scale()),
        ..Legend::default()
    };
    legend.below(grid.draw(), diverging)
}

fn what(theirs: &Theirs) -> String {
    match theirs.content {
        Content::Visibility(_) => "visibility".to_owned(),
        Content::Picture(_) => "of each pixel the channel that differs most".to_owned(),
    }
}

fn shown(theirs: &Theirs) -> Canvas {
    match &theirs.content {
        Content::Visibility(values) => {
            let values = values.iter().map(|v| grey(f64::from(*v).clamp(0.0, 1.0)));
            painted(theirs.size, values)
        }
        Content::Picture(srgb) => painted(theirs.size, srgb.iter().copied()),
    }
}
