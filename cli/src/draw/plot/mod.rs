//! Plots, from one description to PNG and SVG: axes, linear or logarithmic, series,
//! a legend.
//!
//! A [`gnomon_claims::chart::Chart`] is laid out once, into lines, dots, bars and
//! text in pixels (`layout`); `raster` and `svg` only draw those. So both files
//! show the same.

mod axis;
mod layout;
mod raster;
mod svg;

use gnomon_claims::chart::Chart;

use super::Picture;

/// The chart as a picture.
pub fn picture(chart: &Chart) -> Picture {
    raster::draw(&layout::Layout::new(chart))
}

/// The chart as an SVG document.
pub fn svg(chart: &Chart) -> String {
    svg::write(&layout::Layout::new(chart))
}

#[cfg(test)]
mod tests;
