//! What is asked for, and who keeps it.

use std::cmp::Ordering;

/// Limits; at least one is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Budget {
    /// Of the RMSE.
    pub(super) error: Option<f64>,
    /// Of building and drawing, milliseconds.
    pub(super) ms: Option<f64>,
    pub(super) bytes: Option<f64>,
}

/// What a candidate gave: over several frames the largest of each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Figures {
    pub(super) rmse: f64,
    pub(super) max: f64,
    pub(super) ms: f64,
    pub(super) bytes: f64,
}

impl Figures {
    /// The larger of each.
    pub(super) fn or_larger(self, other: Self) -> Self {
        Self {
            rmse: self.rmse.max(other.rmse),
            max: self.max.max(other.max),
            ms: self.ms.max(other.ms),
            bytes: self.bytes.max(other.bytes),
        }
    }

    /// As they would be if all work grew with the pixels, which are `factor` times as many.
    pub(super) fn grown(self, factor: f64) -> Self {
        Self {
            ms: factor * self.ms,
            bytes: factor * self.bytes,
            ..self
        }
    }
}

impl Budget {
    /// By how much the limit that is kept least is missed: at most 1 where all are kept.
    pub(super) fn excess(&self, f: &Figures) -> f64 {
        let parts = [
            self.error.map(|limit| f.rmse / limit),
            self.ms.map(|limit| f.ms / limit),
            self.bytes.map(|limit| f.bytes / limit),
        ];
        parts.into_iter().flatten().fold(0.0, f64::max)
    }

    /// Whether all limits are kept.
    pub(super) fn is_kept(&self, f: &Figures) -> bool {
        self.excess(f) <= 1.0
    }

    /// The better first: those that keep the limits, within `slack`, by what is to be
    /// least; then those that do not, by how much they miss.
    pub(super) fn order(&self, a: &Figures, b: &Figures, slack: f64) -> Ordering {
        let missed = |f: &Figures| match self.excess(f) {
            excess if excess <= slack => 0.0,
            excess => excess,
        };
        let least = |f: &Figures| match self.error {
            Some(_) => f.ms,
            None => f.rmse,
        };
        missed(a)
            .total_cmp(&missed(b))
            .then(least(a).total_cmp(&least(b)))
            .then(a.ms.total_cmp(&b.ms))
    }

    /// For people.
    pub(super) fn describe(&self) -> String {
        let parts = [
            self.error.map(|e| format!("RMSE <= {e}")),
            self.ms.map(|t| format!("build and frame <= {t} ms")),
            self.bytes.map(|b| format!("bytes <= {b}")),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(rmse: f64, ms: f64, bytes: f64) -> Figures {
        Figures {
            rmse,
            max: 1.0,
            ms,
            bytes,
        }
    }

    #[test]
    fn the_fastest_within_the_error_wins_and_the_nearest_where_none_is() {
        let budget = Budget {
            error: Some(0.01),
            ms: None,
            bytes: None,
        };
        let [a, b, c] = [
            figures(0.009, 5.0, 1.0),
            figures(0.001, 9.0, 1.0),
            figures(0.02, 1.0, 1.0),
        ];
        assert_eq!(budget.order(&a, &b, 1.0), Ordering::Less);
        assert_eq!(budget.order(&b, &c, 1.0), Ordering::Less);
        assert_eq!(
            budget.order(&c, &figures(0.03, 0.1, 1.0), 1.0),
            Ordering::Less
        );
        assert_eq!(budget.order(&c, &a, 2.0), Ordering::Less, "with slack");
        assert!(budget.is_kept(&a) && !budget.is_kept(&c));
    }

    #[test]
    fn without_a_limit_of_error_the_most_exact_within_the_cost_wins() {
        let budget = Budget {
            error: None,
            ms: Some(10.0),
            bytes: Some(100.0),
        };
        let [a, b] = [figures(0.02, 1.0, 99.0), figures(0.01, 9.0, 50.0)];
        assert_eq!(budget.order(&b, &a, 1.0), Ordering::Less);
        assert!(!budget.is_kept(&figures(0.0, 1.0, 101.0)));
        assert_eq!(budget.excess(&figures(0.0, 20.0, 101.0)), 2.0);
        assert_eq!(a.grown(4.0), figures(0.02, 4.0, 396.0));
        assert_eq!(a.or_larger(b), figures(0.02, 9.0, 99.0));
    }
}
