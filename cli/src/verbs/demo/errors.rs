//! How far the demo's pictures are from the exact soft shadow.

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind, Score, shaded};
use gnomon_pipeline::measure::render::RenderSettings;
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::scene::Scene;
use serde::Serialize;

use super::shots::{Shot, same_bits};
use crate::error::CliError;
use crate::output::numbers::error;
use crate::output::tables::Table;

/// Errors of all entries.
pub(super) struct Errors(Vec<(&'static str, Score)>);

/// One entry's, by the keys of `compare`.
#[derive(Serialize)]
pub(super) struct ErrorDocument {
    name: &'static str,
    rmse: Option<f64>,
    max: Option<f64>,
    mean: Option<f64>,
    rmse_umbra: Option<f64>,
    rmse_penumbra: Option<f64>,
    rmse_lit: Option<f64>,
    psnr: Option<f64>,
    ssim: Option<f64>,
    flip: f64,
}

impl Errors {
    /// Measures `shots`, pictures of a scene of one light; equal ones once.
    pub(super) fn measure(
        scene: &Scene,
        shots: &[Shot],
        settings: &RenderSettings,
    ) -> Result<Self, CliError> {
        let kind = ReferenceKind::Exact;
        let truth = Reference::new(scene, 0, settings.size, kind, None, &|| {})?;
        let mut scores: Vec<(&'static str, Score)> = Vec::new();
        for (number, shot) in shots.iter().enumerate() {
            let equal = shots[..number]
                .iter()
                .position(|s| same_bits(&s.done, &shot.done));
            let score = match equal {
                Some(known) => scores[known].1.clone(),
                None => {
                    let under = truth.under(&shot.done.depth)?;
                    let picture = shaded(scene, &truth, &under, &shot.params, settings)?;
                    Score::measure(&under, &shot.done, &picture)?
                }
            };
            scores.push((shot.entry.name, score));
        }
        Ok(Self(scores))
    }

    /// For the terminal and the report.
    pub(super) fn table(&self) -> Table {
        let header = [
            "frame", "RMSE", "umbra", "penumbra", "light", "largest", "mean", "PSNR", "SSIM",
            "FLIP",
        ];
        let title = "Errors of visibility against the exact soft shadow, and of the picture";
        let mut table = Table::new(title, &header);
        for (name, score) in &self.0 {
            let document = ErrorDocument::new(name, score);
            let shown = |value: Option<f64>| value.map_or("-".to_owned(), error);
            table.rows.push(vec![
                (*name).to_owned(),
                shown(document.rmse),
                shown(document.rmse_umbra),
                shown(document.rmse_penumbra),
                shown(document.rmse_lit),
                shown(document.max),
                shown(document.mean),
                document
                    .psnr
                    .map_or("equal".to_owned(), |p| format!("{p:.1} dB")),
                document.ssim.map_or("-".to_owned(), |s| format!("{s:.4}")),
                error(document.flip),
            ]);
        }
        table
    }

    /// For JSON.
    pub(super) fn documents(&self) -> Vec<ErrorDocument> {
        let of = |(name, score): &(&'static str, Score)| ErrorDocument::new(name, score);
        self.0.iter().map(of).collect()
    }
}

impl ErrorDocument {
    fn new(name: &'static str, score: &Score) -> Self {
        let all = |figure: fn(ErrorSummary) -> f64| score.visibility.all.map(figure);
        let rmse = |region| score.visibility.of_region(region).map(|e| e.rmse);
        Self {
            name,
            rmse: all(|e| e.rmse),
            max: all(|e| e.max),
            mean: all(|e| e.mean),
            rmse_umbra: rmse(LightRegion::Umbra),
            rmse_penumbra: rmse(LightRegion::Penumbra),
            rmse_lit: rmse(LightRegion::Lit),
            psnr: Some(score.psnr).filter(|p| p.is_finite()),
            ssim: score.ssim,
            flip: score.flip,
        }
    }
}

#[cfg(test)]
mod tests {
    /// Its pictures have all lights, the truth has one.
    #[test]
    fn the_demo_has_one_light() {
        let scene =
            gnomon_pipeline::world::scene::builtin::build(super::super::run::SCENE).unwrap();
        assert_eq!(scene.lights.len(), 1);
    }
}
