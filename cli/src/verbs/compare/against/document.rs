//! What is said of a comparison, as JSON (`docs/json.md`) and in words.

use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use serde::Serialize;

use super::super::args::CompareArgs;
use super::super::job::CompareJob;
use super::read::Theirs;
use super::score::{Found, STEP, Worst};
use crate::documents::{FileDocument, Object, count_by_reason};
use crate::output::numbers::{count, error};

#[derive(Serialize)]
pub(super) struct Document<'a> {
    scene: &'a str,
    light: usize,
    size: [u32; 2],
    against: String,
    /// `visibility` or `picture`.
    content: &'static str,
    /// The file of the truth, or the oracle.
    truth: String,
    rmse: Option<f64>,
    max: Option<f64>,
    p99: Option<f64>,
    mean: Option<f64>,
    rmse_umbra: Option<f64>,
    rmse_penumbra: Option<f64>,
    rmse_lit: Option<f64>,
    psnr: Option<f64>,
    too_dark: usize,
    too_bright: usize,
    compared: usize,
    left_out: Object<usize>,
    worst: Vec<WorstDocument>,
    /// Of the scene, and of the truth that is kept.
    pub(super) warnings: &'a [String],
    files: &'a [FileDocument],
}

#[derive(Serialize)]
struct WorstDocument {
    x: u32,
    y: u32,
    theirs: f64,
    truth: f64,
    side: &'static str,
}

impl From<&Worst> for WorstDocument {
    fn from(w: &Worst) -> Self {
        Self {
            x: w.x,
            y: w.y,
            theirs: w.theirs,
            truth: w.truth,
            side: if w.theirs < w.truth {
                "too dark"
            } else {
                "too bright"
            },
        }
    }
}

impl<'a> Document<'a> {
    pub(super) fn new(
        args: &CompareArgs,
        job: &'a CompareJob,
        theirs: &Theirs,
        found: &Found,
        files: &'a [FileDocument],
    ) -> Self {
        let name = |p: &Option<std::path::PathBuf>| p.as_ref().map(|p| p.display().to_string());
        let all = |f: fn(ErrorSummary) -> f64| found.all.map(f);
        let [umbra, penumbra, lit] = found.regions.map(|r| r.map(|e| e.rmse));
        Self {
            scene: &job.scene.name,
            light: job.light,
            size: theirs.size,
            against: name(&args.against).unwrap_or_default(),
            content: theirs.content.name(),
            truth: name(&args.truth).unwrap_or_else(|| job.reference.name().to_owned()),
            rmse: all(|e| e.rmse),
            max: all(|e| e.max),
            p99: all(|e| e.p99),
            mean: all(|e| e.mean),
            rmse_umbra: umbra,
            rmse_penumbra: penumbra,
            rmse_lit: lit,
            psnr: found.psnr.filter(|p| p.is_finite()),
            too_dark: found.dark,
            too_bright: found.bright,
            compared: found.pixels.compared,
            left_out: count_by_reason(&found.pixels),
            worst: found.worst.iter().map(WorstDocument::from).collect(),
            warnings: &[],
            files,
        }
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "{}, light {}, {}x{}: {} of {} against the truth ({})\n\n",
            self.scene,
            self.light,
            self.size[0],
            self.size[1],
            self.content,
            self.against,
            self.truth
        );
        let figure = |v: Option<f64>| v.map_or("-".to_owned(), error);
        for (name, value) in [
            ("RMSE", self.rmse),
            ("  in the umbra", self.rmse_umbra),
            ("  in the penumbra", self.rmse_penumbra),
            ("  in the light", self.rmse_lit),
            ("largest error", self.max),
            ("99% are within", self.p99),
            ("mean, + too bright", self.mean),
        ] {
            if value.is_some() {
                text += &format!("{name:<20}{:>12}\n", figure(value));
            }
        }
        if let Some(psnr) = self.psnr {
            text += &format!("{:<20}{:>9.1} dB\n", "PSNR", psnr);
        }
        for (name, pixels) in [
            ("too dark", self.too_dark),
            ("too bright", self.too_bright),
            ("pixels compared", self.compared),
        ] {
            text += &format!("{name:<20}{:>12}\n", count(pixels as u64));
        }
        for (name, pixels) in self.left_out.0.iter().filter(|(_, n)| *n > 0) {
            text += &format!("  left out: {name} {}\n", count(*pixels as u64));
        }
        if self.worst.is_empty() {
            text += &format!("\nno pixel is off by {} or more\n", error(STEP));
        } else {
            text += "\nfarthest from the truth:\n";
        }
        for w in &self.worst {
            let off = format!("{:.4}, truth {:.4}", w.theirs, w.truth);
            text += &format!("  pixel {} {}: {off}, {}\n", w.x, w.y, w.side);
        }
        for file in self.files {
            text += &format!("wrote {} ({})\n", file.path, file.kind);
        }
        text
    }
}
