//! What measuring a claim gives.

use super::judge::{Judgement, Theirs};
use crate::chart::Chart;

/// How a figure is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A ratio, `3.4x`.
    Ratio,
    /// A share, 0.25 as `25%`.
    Share,
    /// A whole number.
    Count,
    /// Bytes.
    Bytes,
    /// Milliseconds.
    Milliseconds,
    /// A plain number.
    Number,
}

/// One figure of a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// What it is, in a few words.
    pub what: String,
    /// What was published.
    pub theirs: Theirs,
    /// What was measured here.
    pub ours: f64,
    /// How both are shown.
    pub unit: Unit,
}

impl Measure {
    /// A figure.
    pub fn new(what: impl Into<String>, theirs: Theirs, ours: f64, unit: Unit) -> Self {
        Self {
            what: what.into(),
            theirs,
            ours,
            unit,
        }
    }

    /// A figure shown without judgement.
    pub fn beside(what: impl Into<String>, theirs: &'static str, ours: f64, unit: Unit) -> Self {
        Self::new(what, Theirs::Beside(theirs), ours, unit)
    }

    /// Whether it bears out what was published.
    pub fn judgement(&self) -> Judgement {
        self.theirs.judge(self.ours)
    }
}

/// Everything found of a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// On which scene and at what size.
    pub scene: String,
    /// What was counted or timed, and how many bytes an access has.
    pub counted: String,
    /// The figures.
    pub measures: Vec<Measure>,
    /// Why it does not hold, or not in size; shown where that is so.
    pub reason: String,
    /// Plots.
    pub charts: Vec<Chart>,
}

impl Finding {
    /// The worst judgement of its figures.
    pub fn judgement(&self) -> Judgement {
        let all = self.measures.iter().map(Measure::judgement);
        all.max().unwrap_or(Judgement::NotJudged)
    }

    /// The reason, where one is called for.
    pub fn reason_if_needed(&self) -> Option<&str> {
        (self.judgement() > Judgement::Holds).then_some(&*self.reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(ours: &[f64]) -> Finding {
        let measure = |v: &f64| Measure::new("a", Theirs::ratio(3.0, 4.0), *v, Unit::Ratio);
        Finding {
            scene: String::new(),
            counted: String::new(),
            measures: ours.iter().map(measure).collect(),
            reason: "made up".to_owned(),
            charts: Vec::new(),
        }
    }

    /// A claim is as good as its worst figure; the reason is for what fails.
    #[test]
    fn the_worst_figure_decides() {
        let good = finding(&[3.0, 4.0]);
        assert_eq!(
            (good.judgement(), good.reason_if_needed()),
            (Judgement::Holds, None)
        );
        let bad = finding(&[3.0, 0.9]);
        assert_eq!(bad.judgement(), Judgement::DoesNotHold);
        assert_eq!(bad.reason_if_needed(), Some("made up"));
        assert_eq!(finding(&[3.0, 1.1]).judgement(), Judgement::DirectionOnly);
        assert_eq!(finding(&[]).judgement(), Judgement::NotJudged);
    }
}
