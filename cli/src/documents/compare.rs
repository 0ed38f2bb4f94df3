//! Techniques beside the truth, as JSON.

use gnomon_pipeline::measure::comparison::{PixelCounts, Reference, Score};
use gnomon_pipeline::measure::render::{RenderSettings, Rendered};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::scene::Scene;
use serde::Serialize;

use super::object::Object;
use super::render::{FileDocument, Hashes, WarningDocument, WedgeWorkDocument, worker_threads};
use super::sums;

/// Techniques beside the truth about one light.
#[derive(Serialize)]
pub struct CompareDocument<'a> {
    scene: &'a str,
    light: usize,
    size: [u32; 2],
    reference: &'static str,
    /// Whether the light has an extent.
    soft: bool,
    /// Whether the truth was read from the cache.
    cached: bool,
    /// What the truth took, if it was computed.
    reference_ms: Option<f64>,
    threads: usize,
    tile: u32,
    simd: &'static str,
    skip: bool,
    repeat: u32,
    results: Vec<ResultDocument>,
    warnings: Vec<String>,
    files: Vec<FileDocument>,
}

/// What was compared, and how.
#[derive(Clone, Copy)]
pub struct CompareInputs<'a> {
    /// What was drawn.
    pub scene: &'a Scene,
    /// Size, and how it was executed.
    pub settings: RenderSettings,
    /// What the truth took in milliseconds; `None` where it was read.
    pub reference_ms: Option<f64>,
}

impl<'a> CompareDocument<'a> {
    /// The `results` of techniques beside `reference`, and the files that were written.
    pub fn new(
        inputs: CompareInputs<'a>,
        reference: &Reference,
        results: Vec<ResultDocument>,
        files: Vec<FileDocument>,
    ) -> Self {
        let settings = inputs.settings;
        Self {
            scene: &inputs.scene.name,
            light: reference.light,
            size: settings.size,
            reference: reference.kind.name(),
            soft: reference.is_soft,
            cached: inputs.reference_ms.is_none(),
            reference_ms: inputs.reference_ms,
            threads: worker_threads(settings.gpu.threads),
            tile: settings.gpu.tile,
            simd: settings.gpu.simd.name(),
            skip: settings.gpu.skip,
            repeat: settings.repeat,
            results,
            warnings: reference.warnings.iter().map(|w| w.to_string()).collect(),
            files,
        }
    }
}

/// How far a technique is from the truth; figures without pixels are `null`.
#[derive(Serialize)]
pub struct ResultDocument {
    technique: &'static str,
    params: Object<String>,
    rmse: Option<f64>,
    max: Option<f64>,
    p99: Option<f64>,
    mean: Option<f64>,
    rmse_umbra: Option<f64>,
    rmse_penumbra: Option<f64>,
    rmse_lit: Option<f64>,
    banding: BandingDocument,
    /// `null` for equal pictures: it is infinite.
    psnr: Option<f64>,
    ssim: Option<f64>,
    flip: f64,
    time_ms: f64,
    bytes: u64,
    shaded_fragments: u64,
    wedge_work: Option<WedgeWorkDocument>,
    pixels: PixelDocument,
    hash: Hashes,
    warnings: Vec<WarningDocument>,
}

#[derive(Serialize)]
struct BandingDocument {
    pairs: usize,
    mean: f64,
    p99: f64,
    max: f64,
    levels: usize,
}

/// What was compared, and what was left out.
#[derive(Serialize)]
struct PixelDocument {
    compared: usize,
    umbra: usize,
    penumbra: usize,
    lit: usize,
    other_surface: usize,
    out_of_range: usize,
    /// By reason; with `compared` all pixels of the picture.
    left_out: Object<usize>,
}

impl ResultDocument {
    /// What `technique` left, and how it was judged.
    pub fn new(technique: &dyn Technique, params: &Params, done: &Rendered, score: &Score) -> Self {
        let params = params.iter();
        let all = |figure: fn(ErrorSummary) -> f64| score.visibility.all.map(figure);
        let region = |r| score.visibility.of_region(r);
        let rmse = |r| region(r).map(|e: ErrorSummary| e.rmse);
        let pixels = |e: Option<ErrorSummary>| e.map_or(0, |e| e.pixels);
        let [umbra, penumbra, lit] = LightRegion::ALL;
        let b = &score.banding;
        Self {
            technique: technique.name(),
            params: Object(params.map(|(k, v)| (k.to_owned(), v.to_owned())).collect()),
            rmse: all(|e| e.rmse),
            max: all(|e| e.max),
            p99: all(|e| e.p99),
            mean: all(|e| e.mean),
            rmse_umbra: rmse(umbra),
            rmse_penumbra: rmse(penumbra),
            rmse_lit: rmse(lit),
            banding: BandingDocument {
                pairs: b.pairs,
                mean: b.mean,
                p99: b.p99,
                max: b.max,
                levels: b.levels,
            },
            psnr: Some(score.psnr).filter(|p| p.is_finite()),
            ssim: score.ssim,
            flip: score.flip,
            time_ms: done.frame_ms,
            bytes: sums::frame_bytes(&done.report),
            shaded_fragments: sums::frame_counters(&done.report).fragment_shader_invocations,
            wedge_work: WedgeWorkDocument::of(done),
            pixels: PixelDocument {
                compared: score.pixels.compared,
                umbra: pixels(region(umbra)),
                penumbra: pixels(region(penumbra)),
                lit: pixels(region(lit)),
                other_surface: score.pixels.left_out.other_surface(),
                out_of_range: score.visibility.mask.out_of_range,
                left_out: count_by_reason(&score.pixels),
            },
            hash: Hashes::of(done),
            warnings: done.warnings.iter().map(WarningDocument::new).collect(),
        }
    }
}

/// Keys and numbers of pixels.
pub(crate) fn count_by_reason(counts: &PixelCounts) -> Object<usize> {
    let reasons = counts.left_out.reasons();
    Object(reasons.map(|r| (r.key.to_owned(), r.pixels)).to_vec())
}
