//! The JSON document; `docs/json.md` describes it. Keys are only ever added.

use gnomon_pipeline::measure::stress::{Curve, End, Outcome, Verdict};
use serde::Serialize;
use serde_json::{Value, json};

use super::args::StressArgs;
use super::job::StressJob;
use crate::documents::FileDocument;

#[derive(Clone, Serialize)]
pub(super) struct StressDocument {
    version: &'static str,
    scene: String,
    light: usize,
    size: [u32; 2],
    axes: Vec<AxisDocument>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<Value>,
}

#[derive(Clone, Serialize)]
struct AxisDocument {
    axis: &'static str,
    label: &'static str,
    rest: f64,
    values: Vec<f64>,
    /// Where there is no scene, by value.
    gone: Vec<Value>,
    techniques: Vec<CandidateDocument>,
}

#[derive(Clone, Serialize)]
struct CandidateDocument {
    technique: String,
    verdict: VerdictDocument,
    /// One for each value.
    points: Vec<Value>,
}

#[derive(Clone, Serialize)]
struct VerdictDocument {
    rmse_at_rest: Option<f64>,
    holds: [f64; 2],
    holds_throughout: bool,
    silent: bool,
    insane: usize,
    ends: [Value; 2],
    text: String,
}

impl StressDocument {
    pub(super) fn new(job: &StressJob, args: &StressArgs, curves: &[Curve]) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: job.scene.name.clone(),
            light: args.light,
            size: args.size,
            axes: curves.iter().map(axis).collect(),
            files: Vec::new(),
        }
    }

    /// The same, with what was written.
    pub(super) fn with_files(&self, files: &[FileDocument]) -> Self {
        let file = |f: &FileDocument| json!({ "kind": f.kind, "path": f.path });
        Self {
            files: files.iter().map(file).collect(),
            ..self.clone()
        }
    }
}

fn axis(curve: &Curve) -> AxisDocument {
    let axis = &curve.axis;
    let gone = curve.points.iter().filter_map(|p| {
        let reason = p.outcomes.as_ref().err()?;
        Some(json!({ "value": p.value, "reason": reason }))
    });
    AxisDocument {
        axis: axis.name,
        label: axis.label,
        rest: axis.rest,
        values: axis.values.clone(),
        gone: gone.collect(),
        techniques: (0..curve.candidates.len())
            .map(|k| candidate(curve, k))
            .collect(),
    }
}

fn candidate(curve: &Curve, k: usize) -> CandidateDocument {
    let points = curve.points.iter().map(|p| match &p.outcomes {
        Ok(outcomes) => point(&outcomes[k]),
        Err(_) => Value::Null,
    });
    let found = Verdict::new(curve, k);
    CandidateDocument {
        technique: curve.candidates[k].clone(),
        points: points.collect(),
        verdict: VerdictDocument {
            rmse_at_rest: found.rest,
            holds: found.holds,
            holds_throughout: found.holds_throughout(),
            silent: found.is_silent(),
            insane: found.insane,
            text: found.to_string(),
            ends: found.ends.map(|e| end(&e)),
        },
    }
}

fn point(outcome: &Outcome) -> Value {
    match outcome {
        Outcome::Measured(m) => json!({
            "rmse": m.rmse,
            "max": m.max,
            "compared": m.compared,
            "insane": m.insane,
            "warnings": m.warnings,
        }),
        Outcome::Refused(reason) => json!({ "refused": reason }),
        Outcome::DoesNotApply => Value::Null,
    }
}

fn end(end: &End) -> Value {
    match end {
        End::Throughout => Value::Null,
        End::Worse { at, rmse, warnings } => {
            json!({ "worse_at": at, "rmse": rmse, "warnings": warnings })
        }
        End::Apart {
            at,
            compared,
            warnings,
        } => json!({ "apart_at": at, "compared": compared, "warnings": warnings }),
        End::Refused { at, reason } => json!({ "refused_at": at, "reason": reason }),
    }
}
