//! All points, a line each (RFC 4180).

use gnomon_pipeline::measure::stress::{Curve, Outcome};

use crate::output::csv::cell;

const HEAD: &str = "axis,value,technique,status,reason,rmse,max,compared,insane,warnings\n";

pub(super) fn write(curves: &[Curve]) -> String {
    let mut text = HEAD.to_owned();
    for curve in curves {
        for point in &curve.points {
            for (k, name) in curve.candidates.iter().enumerate() {
                let [axis, value] = [curve.axis.name.to_owned(), format!("{:e}", point.value)];
                let start = [axis, value, quoted(name)];
                let cells = match &point.outcomes {
                    Ok(outcomes) => cells(&outcomes[k]),
                    Err(reason) => without("no scene", reason),
                };
                text += &start.into_iter().chain(cells).collect::<Vec<_>>().join(",");
                text.push('\n');
            }
        }
    }
    text
}

fn cells(outcome: &Outcome) -> Vec<String> {
    match outcome {
        Outcome::Measured(m) => vec![
            "measured".to_owned(),
            String::new(),
            format!("{:e}", m.rmse),
            format!("{:e}", m.max),
            format!("{:.4}", m.compared),
            m.insane.to_string(),
            m.warnings.join(" "),
        ],
        Outcome::Refused(reason) => without("refused", reason),
        Outcome::DoesNotApply => without("does not apply", ""),
    }
}

fn without(status: &str, reason: &str) -> Vec<String> {
    let mut cells = vec![status.to_owned(), quoted(reason)];
    cells.resize(7, String::new());
    cells
}

/// On one line.
fn quoted(text: &str) -> String {
    cell(&text.replace('\n', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_all_cells() {
        let count = HEAD.split(',').count();
        assert_eq!(3 + without("refused", "why").len(), count);
        assert_eq!(3 + cells(&Outcome::DoesNotApply).len(), count);
        assert_eq!(quoted("a, \"b\"\nc"), "\"a, \"\"b\"\" c\"");
    }
}
