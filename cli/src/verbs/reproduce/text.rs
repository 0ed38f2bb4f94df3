//! Claims for people.

use std::time::Duration;

use gnomon_claims::{Finding, Judgement, LabSettings, Lines, Measure, Theirs, Unit, Verdict};

use super::run::Outcome;
use crate::documents::worker_threads;
use crate::output::numbers;
use crate::output::wrap::hanging;

/// Columns of a figure's name.
const NAME: usize = 38;
/// Columns of what was published, and of what was measured.
const FIGURE: usize = 12;

/// A claim with everything found of it.
pub(super) fn of(outcome: &Outcome, listed: bool) -> String {
    let claim = outcome.claim;
    let letter = claim.verdict.letter();
    let mut text = format!("{}  [{letter}]  {}", claim.id, claim.source);
    match &outcome.finding {
        Some(finding) => text += &format!("  -> {}\n", finding.judgement().name()),
        None if claim.verdict == Verdict::Quoted => text += "  -> quoted only\n",
        None => text.push('\n'),
    }
    text += &hanging("  ", 2, claim.statement);
    text += &read_from(claim.lines);
    text += &outcome.finding.as_ref().map_or(String::new(), measured);
    for file in &outcome.files {
        text += &format!("  wrote {}\n", file.path);
    }
    if !listed {
        text.push('\n');
    }
    text
}

/// The lines of the source that a claim was read from; nothing where they are unknown.
fn read_from(lines: &[Lines]) -> String {
    let ranges: Vec<String> = lines.iter().map(Lines::to_string).collect();
    match lines {
        [] => String::new(),
        [one] if one.first == one.last => format!("  read from: line {}\n", ranges[0]),
        _ => hanging("  read from: ", 6, &format!("lines {}", ranges.join(", "))),
    }
}

fn measured(finding: &Finding) -> String {
    let mut text = row("", "theirs", "ours", "");
    for measure in &finding.measures {
        text += &figure(measure);
    }
    text += &hanging("  on: ", 6, &finding.scene);
    text += &hanging("  counted: ", 6, &finding.counted);
    if let Some(reason) = finding.reason_if_needed() {
        text += &hanging("  why: ", 6, reason);
    }
    text
}

/// Name, theirs, ours and judgement; a long name takes more lines.
fn figure(measure: &Measure) -> String {
    let mut lines = vec![String::new()];
    for word in measure.what.split_whitespace() {
        let last = lines.len() - 1;
        let used = lines[last].chars().count();
        if used > 0 && used + 1 + word.chars().count() > NAME {
            lines.push(format!("  {word}"));
        } else {
            lines[last] += if used > 0 { " " } else { "" };
            lines[last] += word;
        }
    }
    let judged = match measure.judgement() {
        Judgement::NotJudged => "",
        other => other.name(),
    };
    let ours = shown(measure.ours, measure.unit);
    let mut text = row(&lines[0], &theirs(measure), &ours, judged);
    for line in &lines[1..] {
        text += &format!("    {line}\n");
    }
    text
}

fn row(name: &str, theirs: &str, ours: &str, judged: &str) -> String {
    let line = format!("    {name:NAME$} {theirs:>FIGURE$} {ours:>8}  {judged}");
    format!("{}\n", line.trim_end())
}

/// What was published, as a figure.
pub(super) fn theirs(measure: &Measure) -> String {
    let unit = measure.unit;
    let one = |value: f64| shown(value, unit);
    match measure.theirs {
        Theirs::Exactly(value) => one(value),
        Theirs::Effect { low, high, .. } if low == high => one(low),
        Theirs::Effect { low, high, .. } | Theirs::Within(low, high) => span(low, high, unit),
        Theirs::None { neutral, .. } => format!("about {}", one(neutral)),
        Theirs::AtLeast(least) => format!(">= {}", one(least)),
        Theirs::AtMost(most) => format!("<= {}", one(most)),
        Theirs::Beside(text) => text.to_owned(),
    }
}

/// Both ends, the unit once.
fn span(low: f64, high: f64, unit: Unit) -> String {
    let (low, high) = (shown(low, unit), shown(high, unit));
    let same = |suffix: &str| low.ends_with(suffix) && high.ends_with(suffix);
    match ["x", "%", " kB", " MB"].into_iter().find(|s| same(s)) {
        Some(suffix) => format!("{}-{high}", low.trim_end_matches(suffix)),
        None => format!("{low}-{high}"),
    }
}

/// A figure in its unit.
pub(super) fn shown(value: f64, unit: Unit) -> String {
    match unit {
        _ if !value.is_finite() => "none".to_owned(),
        Unit::Ratio => format!("{}x", three_digits(value)),
        Unit::Share => format!("{}%", three_digits(100.0 * value)),
        Unit::Count if value.fract() == 0.0 => format!("{value:.0}"),
        Unit::Count | Unit::Number => three_digits(value),
        Unit::Bytes if value < 1e6 => format!("{value:.0} B"),
        Unit::Bytes => numbers::bytes(value as u64),
        Unit::Milliseconds => numbers::milliseconds(value),
    }
}

fn three_digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        100.0.. => format!("{value:.0}"),
        10.0.. => trimmed(format!("{value:.1}")),
        0.1.. => trimmed(format!("{value:.2}")),
        0.001.. => trimmed(format!("{value:.4}")),
        _ => format!("{value:.1e}"),
    }
}

fn trimmed(text: String) -> String {
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// How many claims hold, and which do not.
pub(super) fn summarise(outcomes: &[Outcome], settings: &LabSettings, time: Duration) -> String {
    let judged = |j: Judgement| -> Vec<&str> {
        let has = |o: &&Outcome| o.finding.as_ref().is_some_and(|f| f.judgement() == j);
        outcomes.iter().filter(has).map(|o| o.claim.id).collect()
    };
    let quoted = outcomes.iter().filter(|o| o.finding.is_none()).count();
    let [width, height] = settings.size;
    let mut text = format!(
        "{} at {width}x{height}, {} threads, {}, in {}:\n",
        match outcomes.len() {
            1 => "One claim".to_owned(),
            n => format!("{n} claims"),
        },
        worker_threads(settings.gpu.threads),
        settings.gpu.simd,
        numbers::milliseconds(time.as_secs_f64() * 1e3),
    );
    for judgement in [
        Judgement::Holds,
        Judgement::DirectionOnly,
        Judgement::DoesNotHold,
        Judgement::NotJudged,
    ] {
        let ids = judged(judgement);
        if !ids.is_empty() {
            let first = format!("  {:>2} {}:", ids.len(), judgement.name());
            text += &hanging(&format!("{first} "), 6, &ids.join(", "));
        }
    }
    if quoted > 0 {
        text += &format!("  {quoted:>2} quoted only\n");
    }
    text + &hanging(
        "A claim ",
        0,
        "holds where all its figures have the published direction, and the published size \
         within a factor of two; what is called <=, >= or one number has to be so.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        let ratio = |v| shown(v, Unit::Ratio);
        assert_eq!(
            [ratio(3.0), ratio(0.25), ratio(97.5), ratio(123.4)],
            ["3x", "0.25x", "97.5x", "123x"]
        );
        assert_eq!(shown(0.015, Unit::Share), "1.5%");
        assert_eq!(shown(331_776.0, Unit::Bytes), "331776 B");
        assert_eq!(shown(585e6, Unit::Bytes), "585 MB");
        assert_eq!(shown(f64::NAN, Unit::Number), "none");
        assert_eq!(span(3.0, 4.0, Unit::Ratio), "3-4x");
        assert_eq!(span(0.3, 0.6, Unit::Share), "30-60%");
        assert_eq!(span(8.0, 32.0, Unit::Count), "8-32");
    }

    #[test]
    fn the_lines_of_the_source_are_named() {
        assert_eq!(read_from(&[]), "");
        assert_eq!(read_from(&[Lines::one(7)]), "  read from: line 7\n");
        let two = [Lines::to(1099, 1103), Lines::one(1180)];
        assert_eq!(read_from(&two), "  read from: lines 1099-1103, 1180\n");
    }

    #[test]
    fn long_names_take_more_lines_of_at_most_80_columns() {
        let name = "a figure with a name that is much longer than its column, and then some";
        let measure = Measure::new(name, Theirs::ratio(3.0, 4.0), 0.5, Unit::Ratio);
        let text = figure(&measure);
        assert!(text.lines().count() > 1);
        assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
        assert!(text.contains("does not hold") && text.contains("3-4x"));
    }
}
