//! Drawing for people: pictures with lines, areas, text and legends.

mod canvas;
mod font;
mod legend;
mod projection;
mod ramp;

pub(crate) use canvas::{Canvas, Picture, Stroke};
pub(crate) use legend::{Legend, Swatch};
pub(crate) use projection::{Pixel, Projection};
pub(crate) use ramp::heat;
