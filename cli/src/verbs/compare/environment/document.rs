//! The JSON document: the keys of `compare`, of light instead of visibility, and
//! some of its own.

use serde::Serialize;

use super::{Job, Measured, residual_share};
use crate::output::json::{FileDocument, Object, WarningDocument, worker_threads};
use crate::output::tables;

#[derive(Serialize)]
pub(super) struct EnvironmentDocument<'a> {
    scene: &'a str,
    environment: &'a str,
    size: [u32; 2],
    reference: &'static str,
    directions: usize,
    reference_ms: f64,
    threads: usize,
    tile: u32,
    simd: &'static str,
    skip: bool,
    repeat: u32,
    results: Vec<ResultDocument>,
    files: &'a [FileDocument],
}

#[derive(Serialize)]
struct ResultDocument {
    technique: &'static str,
    params: Object<String>,
    lights: usize,
    threshold: f64,
    /// Of the map's energy.
    residual_share: f64,
    rmse: f64,
    relative_rmse: f64,
    max: f64,
    p99: f64,
    mean: f64,
    /// There are no penumbrae of a single light.
    rmse_penumbra: Option<f64>,
    /// `null` for no error: it is infinite.
    linear_psnr: Option<f64>,
    psnr: Option<f64>,
    ssim: Option<f64>,
    flip: f64,
    time_ms: f64,
    bytes: u64,
    shaded_fragments: u64,
    pixels: PixelDocument,
    hash: HashDocument,
    warnings: Vec<WarningDocument>,
}

#[derive(Serialize)]
struct PixelDocument {
    compared: usize,
    other_surface: usize,
}

#[derive(Serialize)]
struct HashDocument {
    color: String,
    visibility: String,
}

pub(super) fn of<'a>(
    job: &'a Job,
    reference_ms: f64,
    measured: &[Measured<'_>],
    files: &'a [FileDocument],
) -> EnvironmentDocument<'a> {
    let settings = &job.settings;
    EnvironmentDocument {
        scene: &job.name,
        environment: &job.map,
        size: settings.size,
        reference: "directions",
        directions: job.directions.count,
        reference_ms,
        threads: worker_threads(settings.gpu.threads),
        tile: settings.gpu.tile,
        simd: settings.gpu.simd.name(),
        skip: settings.gpu.skip,
        repeat: settings.repeat,
        results: measured.iter().map(result).collect(),
        files,
    }
}

fn result(m: &Measured<'_>) -> ResultDocument {
    let (score, done) = (&m.score, &m.done);
    let params = m.entry.params.iter();
    let finite = |v: f64| Some(v).filter(|v| v.is_finite());
    ResultDocument {
        technique: m.entry.technique.name(),
        params: Object(params.map(|(k, v)| (k.to_owned(), v.to_owned())).collect()),
        lights: m.placed.fit.lights.len(),
        threshold: m.placed.fit.threshold,
        residual_share: residual_share(m.placed),
        rmse: score.rmse,
        relative_rmse: score.relative_rmse,
        max: score.max,
        p99: score.p99,
        mean: score.mean,
        rmse_penumbra: None,
        linear_psnr: finite(score.linear_psnr),
        psnr: finite(score.psnr),
        ssim: score.ssim,
        flip: score.flip,
        time_ms: done.frame_ms,
        bytes: tables::frame_bytes(&done.report),
        shaded_fragments: tables::frame_counters(&done.report).fragment_shader_invocations,
        pixels: PixelDocument {
            compared: score.pixels,
            other_surface: score.other_surface,
        },
        hash: HashDocument {
            color: done.color_hash(),
            visibility: done.visibility_hash(),
        },
        warnings: done.warnings.iter().map(WarningDocument::new).collect(),
    }
}
