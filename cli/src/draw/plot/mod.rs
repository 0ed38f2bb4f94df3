//! Plots, from one description to PNG and SVG: axes, linear or logarithmic, series,
//! a legend.
//!
//! A [`gnomon_claims::chart::Chart`] is laid out once, into lines, dots, bars and
//! text in pixels (`layout`); `raster` and `svg` only draw those. So both files
//! show the same.

mod axis;
mod cloud;
mod layout;
mod mark;
mod panels;
mod place;
mod raster;
mod svg;

use gnomon_claims::chart::Chart;

use super::Picture;
pub(crate) use cloud::{Cloud, Member, Spot};
pub(crate) use panels::{Panel, Panels};

/// The chart as a picture.
pub fn picture(chart: &Chart) -> Picture {
    raster::draw(&layout::Layout::new(chart))
}

/// The chart as an SVG document.
pub fn svg(chart: &Chart) -> String {
    svg::write(&layout::Layout::new(chart), svg::Place::File)
}

/// Labelled points as a picture.
pub(crate) fn cloud_picture(cloud: &Cloud) -> Picture {
    raster::draw(&cloud.lay_out())
}

/// Labelled points as an SVG document.
pub(crate) fn cloud_svg(cloud: &Cloud) -> String {
    svg::write(&cloud.lay_out(), svg::Place::File)
}

/// Labelled points as an SVG element of a page with the variables `--ink`, `--page` and
/// `--line`.
pub(crate) fn cloud_in_page(cloud: &Cloud) -> String {
    svg::write(&cloud.lay_out(), svg::Place::Page)
}

/// Small plots over the same axes as an SVG document.
pub(crate) fn panels_svg(panels: &Panels) -> String {
    svg::write(&panels.lay_out(), svg::Place::File)
}

#[cfg(test)]
mod tests;
