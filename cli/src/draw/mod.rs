//! Drawing for people: pictures with lines, areas, text and legends.

mod canvas;
pub(crate) mod diverging;
mod font;
mod grid;
mod legend;
pub(crate) mod plot;
mod projection;
mod ramp;

pub(crate) use canvas::{Canvas, Picture, Stroke};
pub(crate) use grid::{Cell, Grid};
pub(crate) use legend::{Legend, Swatch};
pub(crate) use projection::{Pixel, Projection};
pub(crate) use ramp::heat;
