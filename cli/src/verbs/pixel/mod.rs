//! `gnomon pixel`: everything that happened to one pixel of a recorded frame.

mod args;
mod run;
mod text;
mod words;

pub(crate) use args::{PixelArgs, PlaceArgs};
pub(crate) use run::{Shown, run};
pub(crate) use text::text;
pub(crate) use words::{float, stored};
