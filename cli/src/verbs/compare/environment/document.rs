//! The JSON document: the keys of `compare`, of light instead of visibility, and
//! some of its own.

use serde::Serialize;

use super::{EnvironmentJob, MeasuredLight, residual_share};
use crate::documents::{
    FileDocument, Hashes, Object, WarningDocument, count_by_reason, worker_threads,
};
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
    results: Vec<EnvironmentResult>,
    files: &'a [FileDocument],
}

#[derive(Serialize)]
struct EnvironmentResult {
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
    pixels: EnvironmentPixels,
    hash: Hashes,
    warnings: Vec<WarningDocument>,
}

#[derive(Serialize)]
struct EnvironmentPixels {
    compared: usize,
    other_surface: usize,
    left_out: Object<usize>,
}

pub(super) fn of<'a>(
    job: &'a EnvironmentJob,
    reference_ms: f64,
    measured: &[MeasuredLight<'_>],
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

fn result(m: &MeasuredLight<'_>) -> EnvironmentResult {
    let (score, done) = (&m.score, &m.done);
    let params = m.entry.params.iter();
    let finite = |v: f64| Some(v).filter(|v| v.is_finite());
    EnvironmentResult {
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
        pixels: EnvironmentPixels {
            compared: score.pixels.compared,
            other_surface: score.pixels.left_out.other_surface(),
            left_out: count_by_reason(&score.pixels),
        },
        hash: Hashes::of(done),
        warnings: done.warnings.iter().map(WarningDocument::new).collect(),
    }
}
