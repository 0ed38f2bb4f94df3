//! The JSON document; `docs/json.md` describes it. Keys are only ever added.

use serde::Serialize;

use super::job::TuneJob;
use super::search::{Found, Tried};
use crate::documents::{Object, worker_threads};
use crate::output::shell;

#[derive(Serialize)]
pub(super) struct TuneDocument {
    scene: String,
    light: usize,
    size: [u32; 2],
    frames: usize,
    threads: usize,
    budget: BudgetDocument,
    /// `null` where nothing keeps the budget.
    winner: Option<CandidateDocument>,
    /// Without a winner the nearest.
    runners_up: Vec<CandidateDocument>,
    tried: usize,
    refused: usize,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct BudgetDocument {
    max_error: Option<f64>,
    max_ms: Option<f64>,
    max_bytes: Option<f64>,
}

/// A candidate; over several frames the largest of each figure.
#[derive(Serialize)]
struct CandidateDocument {
    technique: &'static str,
    /// Those that are not at their defaults.
    params: Object<String>,
    rmse: f64,
    max: f64,
    time_ms: f64,
    bytes: u64,
    command: String,
}

impl TuneDocument {
    pub(super) fn new(job: &TuneJob, found: &Found) -> Self {
        let document = |t: &Tried| CandidateDocument::new(job, t);
        Self {
            scene: job.scene.clone(),
            light: job.light,
            size: job.size,
            frames: job.frames.len(),
            threads: worker_threads(job.gpu.threads),
            budget: BudgetDocument {
                max_error: job.budget.error,
                max_ms: job.budget.ms,
                max_bytes: job.budget.bytes,
            },
            winner: found.winner.as_ref().map(document),
            runners_up: found.others.iter().map(document).collect(),
            tried: found.tried,
            refused: found.refused,
            warnings: found.warnings.clone(),
        }
    }
}

impl CandidateDocument {
    fn new(job: &TuneJob, tried: &Tried) -> Self {
        Self {
            technique: tried.candidate.technique.name(),
            params: Object(tried.candidate.settings.clone()),
            rmse: tried.figures.rmse,
            max: tried.figures.max,
            time_ms: tried.figures.ms,
            bytes: tried.figures.bytes as u64,
            command: command(job, tried),
        }
    }
}

/// The line that renders so.
pub(super) fn command(job: &TuneJob, tried: &Tried) -> String {
    let candidate = &tried.candidate;
    let mut words = [
        "gnomon",
        "render",
        &job.scene,
        "--technique",
        candidate.technique.name(),
    ]
    .map(str::to_owned)
    .to_vec();
    let light =
        (job.frames[0].lights.len() > 1).then(|| ("light".to_owned(), job.light.to_string()));
    let has_light = |(key, _): &(String, String)| {
        let technique = candidate.technique;
        technique.params().iter().any(|p| p.name == *key)
    };
    let light = light.filter(has_light);
    for (key, value) in light.iter().chain(&candidate.settings) {
        words.extend(["--set".to_owned(), format!("{key}={value}")]);
    }
    let [width, height] = job.size;
    words.extend(["--size".to_owned(), format!("{width}x{height}")]);
    if job.time != 0.0 {
        words.extend(["--time".to_owned(), job.time.to_string()]);
    }
    words
        .iter()
        .map(|w| shell::quote(w))
        .collect::<Vec<_>>()
        .join(" ")
}
