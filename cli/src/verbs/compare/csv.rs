//! The comparison as a table for other programs, a line for each technique.

use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;

use super::measure::Measured;
use crate::output::csv::line;
use crate::output::tables;

const HEAD: [&str; 17] = [
    "technique",
    "compared",
    "rmse",
    "rmse_umbra",
    "rmse_penumbra",
    "rmse_lit",
    "max",
    "p99",
    "mean",
    "psnr",
    "ssim",
    "flip",
    "build_ms",
    "frame_ms",
    "bytes",
    "color",
    "visibility",
];

/// All digits; empty where there is no such figure.
pub(super) fn write(measured: &[Measured]) -> String {
    let head = line(HEAD.iter().map(|h| (*h).to_owned()));
    measured.iter().fold(head, |text, m| text + &row(m))
}

fn row(m: &Measured) -> String {
    let of = |summary: Option<ErrorSummary>, figure: fn(ErrorSummary) -> f64| {
        summary.map_or(String::new(), |s| figure(s).to_string())
    };
    let errors = &m.score.visibility;
    let region = |r| of(errors.of_region(r), |e| e.rmse);
    let cells = [
        m.label.clone(),
        errors.all.map_or(0, |e| e.pixels).to_string(),
        of(errors.all, |e| e.rmse),
        region(LightRegion::Umbra),
        region(LightRegion::Penumbra),
        region(LightRegion::Lit),
        of(errors.all, |e| e.max),
        of(errors.all, |e| e.p99),
        of(errors.all, |e| e.mean),
        m.score.psnr.to_string(),
        m.score.ssim.map_or(String::new(), |s| s.to_string()),
        m.score.flip.to_string(),
        m.done.build_ms.to_string(),
        m.done.frame_ms.to_string(),
        tables::frame_bytes(&m.done.report).to_string(),
        m.done.color_hash(),
        m.done.visibility_hash(),
    ];
    line(cells.into_iter())
}
