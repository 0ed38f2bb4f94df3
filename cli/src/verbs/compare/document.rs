//! The JSON document; `docs/json.md` describes it. Keys are only ever added.

use gnomon_pipeline::truth::metrics::visibility::ErrorSummary;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use serde::Serialize;

use super::job::{CompareJob, Entry};
use super::measure::{Comparison, Measured};
use super::pixels::count_by_reason;
use crate::output::json::{
    FileDocument, Hashes, Object, WarningDocument, WedgeWorkDocument, worker_threads,
};
use crate::output::tables;

#[derive(Serialize)]
pub(super) struct CompareDocument<'a> {
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
    files: &'a [FileDocument],
}

/// One technique; figures without pixels are `null`.
#[derive(Serialize)]
struct ResultDocument {
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

impl<'a> CompareDocument<'a> {
    pub(super) fn new(job: &'a CompareJob, found: &Comparison, files: &'a [FileDocument]) -> Self {
        let (settings, reference) = (&job.settings, &found.reference);
        let results = job.entries.iter().zip(&found.measured);
        Self {
            scene: &job.scene.name,
            light: job.light,
            size: settings.size,
            reference: reference.kind.name(),
            soft: reference.is_soft,
            cached: found.reference_ms.is_none(),
            reference_ms: found.reference_ms,
            threads: worker_threads(settings.gpu.threads),
            tile: settings.gpu.tile,
            simd: settings.gpu.simd.name(),
            skip: settings.gpu.skip,
            repeat: settings.repeat,
            results: results.map(|(e, m)| ResultDocument::new(e, m)).collect(),
            warnings: reference.warnings.iter().map(|w| w.to_string()).collect(),
            files,
        }
    }
}

impl ResultDocument {
    fn new(entry: &Entry, Measured { done, score, .. }: &Measured) -> Self {
        let params = entry.params.iter();
        let all = |figure: fn(ErrorSummary) -> f64| score.visibility.all.map(figure);
        let region = |r| score.visibility.of_region(r);
        let rmse = |r| region(r).map(|e: ErrorSummary| e.rmse);
        let pixels = |e: Option<ErrorSummary>| e.map_or(0, |e| e.pixels);
        let [umbra, penumbra, lit] = LightRegion::ALL;
        let b = &score.banding;
        Self {
            technique: entry.technique.name(),
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
            bytes: tables::frame_bytes(&done.report),
            shaded_fragments: tables::frame_counters(&done.report).fragment_shader_invocations,
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
