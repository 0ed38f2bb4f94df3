//! Drawing for people: pictures with lines, areas, text and legends.

mod canvas;
pub(crate) mod diverging;
mod font;
mod grid;
pub(crate) mod heat_scale;
mod legend;
pub mod plot;
mod projection;
mod ramp;

pub use canvas::Picture;
pub(crate) use canvas::{Canvas, Stroke};
pub(crate) use grid::{Cell, Grid};
pub(crate) use legend::{Legend, Swatch};
pub(crate) use projection::{Pixel, Projection};
pub(crate) use ramp::heat;
