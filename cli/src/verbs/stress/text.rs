//! The summary for people: a verdict for each technique.

use gnomon_pipeline::measure::stress::{Curve, End, Verdict};

use super::args::StressArgs;
use crate::documents::FileDocument;
use crate::output::wrap::hanging;

/// By technique, what it bears, and where it ends.
pub(super) fn summarise(args: &StressArgs, curves: &[Curve], files: &[FileDocument]) -> String {
    let [width, height] = args.size;
    let mut text = format!(
        "{}, light {}, {width}x{height}: RMSE against the exact soft shadow\n",
        args.scene, args.light
    );
    for curve in curves {
        for point in &curve.points {
            if let Err(reason) = &point.outcomes {
                let line = format!("no scene at {:e}: {reason}", point.value);
                text += &hanging(&format!("{}: ", curve.axis.name), 4, &line);
            }
        }
    }
    let count = curves.first().map_or(0, |c| c.candidates.len());
    for candidate in 0..count {
        text += &of_candidate(curves, candidate);
    }
    text.push('\n');
    for file in files {
        text += &format!("{:<9}{}\n", file.kind, file.path);
    }
    text
}

fn of_candidate(curves: &[Curve], candidate: usize) -> String {
    let verdicts = curves.iter().map(|c| Verdict::new(c, candidate));
    let (whole, broken): (Vec<_>, Vec<_>) = verdicts.partition(Verdict::holds_throughout);
    let silent = broken.iter().filter(|v| v.is_silent()).count();
    let refused = |v: &&Verdict| v.ends.iter().any(|e| matches!(e, End::Refused { .. }));
    let refused = broken.iter().filter(refused).count();
    let mut text = format!(
        "\n{}: holds on {} of {}",
        curves[0].candidates[candidate],
        whole.len(),
        whole.len() + broken.len(),
    );
    if refused > 0 {
        text += &format!(", refuses on {refused}");
    }
    if silent > 0 {
        text += &format!(", worse in silence on {silent}");
    }
    text.push('\n');
    for verdict in &broken {
        text += &hanging(&format!("  {:<12}", verdict.axis), 14, &verdict.to_string());
    }
    text
}
