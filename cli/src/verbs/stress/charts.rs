//! Plots: a panel for each candidate.

use gnomon_claims::chart::Axis as PlotAxis;
use gnomon_pipeline::measure::stress::{Curve, Limit, Outcome, Scale, Verdict};

use crate::draw::plot::{Panel, Panels};

/// Smaller errors are shown here: a logarithmic axis has no 0.
const FLOOR: f64 = 1e-6;

pub(super) fn of_curve(scene: &str, curve: &Curve) -> Panels {
    let axis = &curve.axis;
    let along = match axis.scale {
        Scale::Linear => PlotAxis::linear(axis.label),
        Scale::Log10 => PlotAxis::log10(axis.label),
    };
    let shown = (0..curve.candidates.len()).filter(|k| is_drawn(curve, *k));
    Panels {
        title: format!("{scene}: error over {}", axis.name),
        axes: [
            along,
            PlotAxis::log10("RMSE of visibility, 1e-6 where it is less; dashed: what it may be"),
        ],
        panels: shown.map(|k| panel(curve, k)).collect(),
    }
}

/// Whether there is anything to see.
fn is_drawn(curve: &Curve, candidate: usize) -> bool {
    let outcomes = curve.points.iter().filter_map(|p| p.outcomes.as_ref().ok());
    let mut own = outcomes.map(|o| &o[candidate]);
    own.any(|o| matches!(o, Outcome::Measured(_)))
}

fn panel(curve: &Curve, candidate: usize) -> Panel {
    let limit = Limit::default();
    let rest = Verdict::new(curve, candidate).rest;
    let error = |outcome: &Outcome| match outcome {
        // NaN stays: nothing was compared there.
        Outcome::Measured(m) if m.rmse < FLOOR => FLOOR,
        Outcome::Measured(m) => m.rmse,
        _ => f64::NAN,
    };
    let points = curve.points.iter().map(|p| match &p.outcomes {
        Ok(outcomes) => [p.value, error(&outcomes[candidate])],
        Err(_) => [p.value, f64::NAN],
    });
    Panel {
        name: curve.candidates[candidate].clone(),
        points: points.collect(),
        limit: rest.map(|rest| limit.most(rest)),
    }
}
