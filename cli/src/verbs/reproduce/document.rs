//! The JSON document; `docs/json.md` describes it. Keys are only ever added.

use gnomon_claims::{Finding, LabSettings, Measure, Unit};
use serde::Serialize;

use super::run::Outcome;
use super::text;
use crate::documents::{FileDocument, worker_threads};

#[derive(Serialize)]
pub(super) struct ReproduceDocument<'a> {
    size: [u32; 2],
    threads: usize,
    simd: &'static str,
    skip: bool,
    repeat: u32,
    full: bool,
    claims: Vec<ClaimDocument<'a>>,
}

#[derive(Serialize)]
struct ClaimDocument<'a> {
    id: &'static str,
    source: &'static str,
    statement: &'static str,
    /// A, B, C or D.
    verdict: char,
    /// First and last line of each part of the source that was read; empty where unknown.
    lines: Vec<[u32; 2]>,
    /// `null` for what is quoted or only listed.
    finding: Option<FindingDocument<'a>>,
    /// What measuring took.
    time_ms: f64,
    files: &'a [FileDocument],
}

#[derive(Serialize)]
struct FindingDocument<'a> {
    judgement: &'static str,
    /// Whether the direction holds, and the rough size.
    direction: Option<bool>,
    rough_size: Option<bool>,
    scene: &'a str,
    counted: &'a str,
    /// Why it does not hold; `null` where it does.
    reason: Option<&'a str>,
    measures: Vec<MeasureDocument<'a>>,
}

#[derive(Serialize)]
struct MeasureDocument<'a> {
    what: &'a str,
    unit: &'static str,
    /// What was published, for people.
    theirs: String,
    /// `null` where it is not a number.
    ours: Option<f64>,
    judgement: &'static str,
    direction: Option<bool>,
    rough_size: Option<bool>,
}

impl<'a> ReproduceDocument<'a> {
    pub(super) fn new(settings: &LabSettings, outcomes: &'a [Outcome]) -> Self {
        Self {
            size: settings.size,
            threads: worker_threads(settings.gpu.threads),
            simd: settings.gpu.simd.name(),
            skip: settings.gpu.skip,
            repeat: settings.repeat,
            full: settings.full,
            claims: outcomes.iter().map(ClaimDocument::new).collect(),
        }
    }
}

impl<'a> ClaimDocument<'a> {
    fn new(outcome: &'a Outcome) -> Self {
        let claim = outcome.claim;
        Self {
            id: claim.id,
            source: claim.source,
            statement: claim.statement,
            verdict: claim.verdict.letter(),
            lines: claim.lines.iter().map(|l| [l.first, l.last]).collect(),
            finding: outcome.finding.as_ref().map(FindingDocument::new),
            time_ms: outcome.time.as_secs_f64() * 1e3,
            files: &outcome.files,
        }
    }
}

impl<'a> FindingDocument<'a> {
    fn new(finding: &'a Finding) -> Self {
        let judgement = finding.judgement();
        Self {
            judgement: judgement.name(),
            direction: judgement.direction(),
            rough_size: judgement.size(),
            scene: &finding.scene,
            counted: &finding.counted,
            reason: finding.reason_if_needed(),
            measures: finding.measures.iter().map(MeasureDocument::new).collect(),
        }
    }
}

impl<'a> MeasureDocument<'a> {
    fn new(measure: &'a Measure) -> Self {
        let judgement = measure.judgement();
        Self {
            what: &measure.what,
            unit: match measure.unit {
                Unit::Ratio => "ratio",
                Unit::Share => "share",
                Unit::Count => "count",
                Unit::Bytes => "bytes",
                Unit::Milliseconds => "ms",
                Unit::Number => "number",
            },
            theirs: text::theirs(measure),
            ours: Some(measure.ours).filter(|v| v.is_finite()),
            judgement: judgement.name(),
            direction: judgement.direction(),
            rough_size: judgement.size(),
        }
    }
}
