//! Successive halving: all candidates on small pictures, the better ones on larger ones,
//! the best measured anew.

use std::collections::BTreeSet;

use super::budget::{Budget, Figures};
use super::candidates::{Candidate, crosses, stars};
use super::job::TuneJob;
use super::trial::Stage;
use crate::error::CliError;
use crate::verbs::bench::Pace;

/// Fractions of width and height, and frames that are timed, stage after stage.
const STAGES: [(u32, u32); 3] = [(4, 1), (2, 3), (1, 5)];
/// One of so many goes on.
const KEPT: usize = 4;
/// But not fewer than these.
const FEWEST: usize = 6;
/// Of the best that go on so many are tried together, two and two.
const CROSSED: usize = 12;
/// By how much a limit may be missed on small pictures.
const SLACK: f64 = 1.3;
/// Frames that are timed when the winner is verified.
const VERIFY: u32 = 9;
/// Candidates that are listed behind the winner.
const RUNNERS_UP: usize = 5;

/// A candidate with what it gave.
#[derive(Clone)]
pub(super) struct Tried {
    pub(super) candidate: Candidate,
    pub(super) figures: Figures,
}

/// What came of a search.
pub(super) struct Found {
    /// Keeps the budget, measured anew.
    pub(super) winner: Option<Tried>,
    /// In order; those behind the winner keep the budget too. Without a winner the
    /// nearest.
    pub(super) others: Vec<Tried>,
    /// Candidates that were measured.
    pub(super) tried: usize,
    /// Candidates that refused the scene.
    pub(super) refused: usize,
    /// What went wrong with the folder that keeps truth and preparations.
    pub(super) warnings: Vec<String>,
}

/// Searches.
pub(super) fn search(job: &TuneJob) -> Result<Found, CliError> {
    let mut names = BTreeSet::new();
    let mut candidates = stars(&job.techniques);
    let (mut measured, mut refused) = (Vec::new(), 0);
    let mut warnings = Vec::new();
    let mut stage = Stage::new(job, STAGES[0].0)?;
    for (number, (share, repeat)) in STAGES.into_iter().enumerate() {
        if number > 0 {
            warnings.append(&mut stage.warnings);
            stage = Stage::new(job, share)?;
        }
        let mut pace = Pace::new(candidates.len());
        measured = Vec::new();
        for candidate in candidates {
            let label = candidate.label();
            pace.doing(&label);
            names.insert(label.clone());
            match stage.measure(&candidate, repeat)? {
                Some(figures) => {
                    measured.push(Tried { candidate, figures });
                    pace.done(&label);
                }
                None => {
                    refused += 1;
                    pace.done(&format!("{label}: refused"));
                }
            }
        }
        candidates = Vec::new();
        if number + 1 < STAGES.len() {
            candidates = survivors(&measured, &job.budget, stage.growth());
            let best = &candidates[..CROSSED.min(candidates.len())];
            candidates.extend(fresh(crosses(best), &names));
        }
    }
    measured.sort_by(|a, b| job.budget.order(&a.figures, &b.figures, 1.0));
    let (winner, others) = verify(job, &mut stage, measured)?;
    warnings.append(&mut stage.warnings);
    Ok(Found {
        winner,
        others,
        tried: names.len(),
        refused,
        warnings,
    })
}

/// Those that were not tried yet.
fn fresh(crosses: Vec<Candidate>, names: &BTreeSet<String>) -> Vec<Candidate> {
    let mut known = names.clone();
    let new = crosses.into_iter();
    new.filter(|c| known.insert(c.label())).collect()
}

/// The better quarter, should work grow with the pixels, and the better quarter, should it
/// not grow at all: what it does lies between. The best of both come first.
fn survivors(measured: &[Tried], budget: &Budget, growth: f64) -> Vec<Candidate> {
    let count = measured.len().div_ceil(KEPT).max(FEWEST);
    let best = |factor: f64| {
        let mut order: Vec<usize> = (0..measured.len()).collect();
        let figures = |k: usize| measured[k].figures.grown(factor);
        order.sort_by(|a, b| budget.order(&figures(*a), &figures(*b), SLACK));
        order.truncate(count);
        order
    };
    let mut kept: Vec<usize> = Vec::new();
    for (a, b) in best(1.0).into_iter().zip(best(growth)) {
        for k in [a, b] {
            if !kept.contains(&k) {
                kept.push(k);
            }
        }
    }
    kept.into_iter()
        .map(|k| measured[k].candidate.clone())
        .collect()
}

/// The first that keeps the budget when it is measured anew, and what follows it.
fn verify(
    job: &TuneJob,
    stage: &mut Stage<'_>,
    measured: Vec<Tried>,
) -> Result<(Option<Tried>, Vec<Tried>), CliError> {
    for (k, tried) in measured.iter().enumerate() {
        if !job.budget.is_kept(&tried.figures) {
            break;
        }
        let Some(figures) = stage.measure(&tried.candidate, VERIFY)? else {
            continue;
        };
        if job.budget.is_kept(&figures) {
            let winner = Tried {
                candidate: tried.candidate.clone(),
                figures,
            };
            let rest = measured[k + 1..].iter();
            let others = rest
                .filter(|t| job.budget.is_kept(&t.figures))
                .take(RUNNERS_UP);
            return Ok((Some(winner), others.cloned().collect()));
        }
    }
    Ok((None, measured.into_iter().take(RUNNERS_UP).collect()))
}

#[cfg(test)]
mod tests {
    use gnomon_pipeline::techniques;

    use super::*;

    fn tried(ms: &[f64]) -> Vec<Tried> {
        let one = |ms: &f64| Tried {
            candidate: Candidate {
                technique: techniques::all()[0],
                settings: vec![("ms".to_owned(), ms.to_string())],
            },
            figures: Figures {
                rmse: 1.0 / ms,
                ms: *ms,
                ..Figures::default()
            },
        };
        ms.iter().map(one).collect()
    }

    /// Whether work grows with the pixels is not known: both guesses keep their best.
    #[test]
    fn who_may_be_best_at_full_size_goes_on() {
        let budget = Budget {
            error: None,
            ms: Some(16.0),
            bytes: None,
        };
        let all: Vec<f64> = (1..=30).map(f64::from).collect();
        let kept = survivors(&tried(&all), &budget, 4.0);
        let ms: Vec<f64> = kept
            .iter()
            .map(|c| c.settings[0].1.parse().unwrap())
            .collect();
        assert!(ms.contains(&16.0) && ms.contains(&4.0), "{ms:?}");
        assert!(!ms.contains(&30.0) && ms.len() <= 16, "{ms:?}");
        assert_eq!(ms[0], 20.0, "the most exact of those that may fit: {ms:?}");
    }
}
