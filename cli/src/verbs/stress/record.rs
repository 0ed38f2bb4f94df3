//! The record: a page in Markdown with plots and every verdict, so that the command alone
//! renews it.

use gnomon_pipeline::measure::stress::{Curve, End, Limit, Verdict};

use super::args::StressArgs;
use crate::output::numbers::error;

pub(super) fn write(args: &StressArgs, curves: &[Curve]) -> String {
    let [width, height] = args.size;
    let limit = Limit::default();
    let mut text = format!(
        "# What techniques bear: {}\n\n\
         `gnomon stress --scene {} --size {width}x{height}`, version {}. Light {}; RMSE of \
         visibility against the exact soft shadow of the same scene, rounded to f32 in the same \
         way. A technique holds as far as its RMSE is at most {} times that at rest plus {}, on at least \
         {:.0} % of the pixels that could be compared at rest. All numbers: [CSV](stress.csv), [JSON](stress.json).\n\n",
        args.scene,
        args.scene,
        env!("CARGO_PKG_VERSION"),
        args.light,
        limit.times,
        limit.plus,
        100.0 * limit.compared,
    );
    text += &overview(curves);
    for curve in curves {
        text += &section(curve);
    }
    text
}

/// A line for each technique: how many axes it holds on, and where it does not.
fn overview(curves: &[Curve]) -> String {
    let mut text = "| technique | holds on | not on | worse without a warning on |\n\
                    | --- | ---: | --- | --- |\n"
        .to_owned();
    let count = curves.first().map_or(0, |c| c.candidates.len());
    for k in 0..count {
        let verdicts: Vec<Verdict> = curves.iter().map(|c| Verdict::new(c, k)).collect();
        let broken = verdicts.iter().filter(|v| !v.holds_throughout());
        let silent = verdicts.iter().filter(|v| v.is_silent());
        let names = |all: &mut dyn Iterator<Item = &Verdict>| {
            all.map(|v| v.axis).collect::<Vec<_>>().join(", ")
        };
        text += &format!(
            "| `{}` | {} of {} | {} | {} |\n",
            curves[0].candidates[k],
            verdicts.iter().filter(|v| v.holds_throughout()).count(),
            verdicts.len(),
            names(&mut broken.into_iter()),
            names(&mut silent.into_iter()),
        );
    }
    text + "\n"
}

fn section(curve: &Curve) -> String {
    let axis = &curve.axis;
    let mut text = format!(
        "## {}\n\n{}; at rest {}.\n\n![{}](stress-{}.svg)\n\n",
        axis.name,
        capitalised(axis.label),
        axis.rest,
        axis.name,
        axis.name
    );
    for point in &curve.points {
        if let Err(reason) = &point.outcomes {
            text += &format!("No scene at {:e}: {reason}.\n\n", point.value);
        }
    }
    text +=
        "| technique | at rest | holds from | to | then |\n| --- | ---: | ---: | ---: | --- |\n";
    for k in 0..curve.candidates.len() {
        let verdict = Verdict::new(curve, k);
        let [from, to] = verdict.holds.map(|v| format!("{v:e}"));
        let (rest, from, to) = match verdict.rest {
            Some(rest) => (error(rest), from, to),
            None => ("no picture".to_owned(), String::new(), String::new()),
        };
        let ends = verdict.ends.iter().filter_map(then).collect::<Vec<_>>();
        text += &format!(
            "| `{}` | {rest} | {from} | {to} | {} |\n",
            verdict.candidate,
            ends.join("; ")
        );
    }
    text + "\n"
}

fn then(end: &End) -> Option<String> {
    match end {
        End::Throughout => None,
        End::Worse { at, rmse, warnings } => {
            Some(format!("{} at {at:e} ({})", error(*rmse), told(warnings)))
        }
        End::Apart {
            at,
            compared,
            warnings,
        } => {
            let share = 100.0 * compared;
            let told = told(warnings);
            Some(format!(
                "other surfaces at {at:e}, {share:.0} % compared ({told})"
            ))
        }
        End::Refused { at, reason } => {
            let reason = reason.replace('|', "/");
            Some(format!("refused at {at:e}: {reason}"))
        }
    }
}

fn told(warnings: &[&str]) -> String {
    match warnings.is_empty() {
        true => "no warning".to_owned(),
        false => warnings.join(", "),
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
